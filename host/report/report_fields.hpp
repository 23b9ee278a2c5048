// The flow under the cells of report.html: speed and vorticity from frames.h5, thinned and quantised for a page.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "files/field_nodes.hpp"
#include "hdf5/hdf5_file.hpp"
#include "json/json.hpp"

namespace rouleau::report {

/// A scalar on a grid, row by row from below, x fastest.
struct ScalarField {
  std::size_t nx = 0, ny = 0;
  std::vector<double> values;
};

/// Outputs of a frames.h5 whose fields a report can draw (velocity or vorticity), at most `most`, evenly thinned.
std::vector<std::size_t> field_outputs(const std::filesystem::path& frames, std::size_t most);

/// {nx, ny, box_um, outputs, quantities, velocity, across, derived} of the shown outputs `selection` that have fields;
/// null when none has.
///   box_um       [x, y, width, height] of what the blocks cover: the domain, or the region that was written
///   outputs      positions in `selection`
///   quantities   [{name: speed | vorticity, unit, signed, scale, clipped, values: [base64 of nx x ny bytes]}]: byte b
///                stands for scale * b / 254, of a signed quantity for scale * (b - 127) / 127; 255 is undefined.
///                scale is the largest magnitude, or where few nodes (one in 500) lie far above the rest theirs; then
///                clipped is true
///   velocity     {nx, ny, scale, values: [base64 of nx x ny pairs of int8]} on a coarser grid of the same box: u and v
///                over scale (m/s) times 127; null where no velocity was written
///   across       in space, of velocities along x on a plane across x: {ny, nz, x_um, box_um [y, z, width, height],
///                quantum_um_per_s, values: [base64 of nz x ny int16, in quanta]}; null in the plane
///   z_um         in space, the layer of which quantities and velocity are
///   derived      vorticity was computed here, from the velocity
nlohmann::json field_data(const std::filesystem::path& frames, const std::vector<std::size_t>& selection);

/// Means over blocks of a field's nodes, of which there are at most `most`; the blocks have the shape of the domain's
/// nodes. The field is given row by row, from below, so that nobody holds all of it.
class BlockMeans {
 public:
  BlockMeans(std::size_t nx, std::size_t ny, std::size_t most);
  /// The next row: value(x) for x = 0..nx-1.
  template <class Value>
  void add_row(const Value& value) {
    if (whole()) {
      for (std::size_t x = 0; x < nx_; ++x) means_.values.push_back(value(x));
      return;
    }
    for (std::size_t i = 0; i < means_.nx; ++i)
      for (std::size_t x = i * nx_ / means_.nx; x < (i + 1) * nx_ / means_.nx; ++x) sums_[i] += value(x);
    end_row();
  }
  /// Of all rows, once they have been added.
  [[nodiscard]] const ScalarField& means() const { return means_; }

 private:
  [[nodiscard]] bool whole() const { return means_.nx == nx_ && means_.ny == ny_; }
  void end_row();
  std::size_t nx_, ny_;
  std::size_t rows_ = 0, rows_before_ = 0;  ///< there have been; below the blocks that are being summed
  ScalarField means_;
  std::vector<double> sums_;  ///< of a row of blocks
};

/// Bytes as described above.
std::vector<unsigned char> quantised(const std::vector<double>& values, double scale, bool is_signed);

/// Where velocities are known.
struct VelocityGrid {
  std::size_t nx, ny;
  std::array<double, 2> spacing;
  std::array<bool, 2> periodic;  ///< the last node's neighbour is the first

  /// dv/dx - du/dy at node (x, y) by central differences; at the ends of an axis that is not periodic, one-sided ones
  /// of second order. `u` and `v` are asked for the components at nodes, as u(x, y).
  template <class U, class V>
  double vorticity(std::size_t x, std::size_t y, const U& u, const V& v) const {
    return rise(x, nx, periodic[0], [&](std::size_t i) { return v(i, y); }) / (2 * spacing[0]) -
           rise(y, ny, periodic[1], [&](std::size_t j) { return u(x, j); }) / (2 * spacing[1]);
  }

 private:
  /// What a quantity rises over two spacings around node `i` of `n`.
  template <class Quantity>
  static double rise(std::size_t i, std::size_t n, bool is_periodic, const Quantity& value) {
    if (is_periodic || (i > 0 && i + 1 < n)) return value((i + 1) % n) - value((i + n - 1) % n);
    if (n < 3) return 0;
    return i == 0 ? 4 * value(1) - 3 * value(0) - value(2) : 3 * value(i) - 4 * value(i - 1) + value(i - 2);
  }
};

}  // namespace rouleau::report
