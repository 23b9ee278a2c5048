// The flow under the cells of report.html: speed and vorticity from frames.h5, thinned and quantised for a page.
#pragma once

#include <array>
#include <filesystem>
#include <string>
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

/// {nx, ny, box_um, outputs, quantities, velocity, derived} of the shown outputs `selection` that have fields; null
/// when none has.
///   box_um       [x, y, width, height] of what the blocks cover: the domain, or the region that was written
///   outputs      positions in `selection`
///   quantities   [{name: speed | vorticity, unit, signed, scale, clipped, values: [base64 of nx x ny bytes]}]: byte b
///                stands for scale * b / 254, of a signed quantity for scale * (b - 127) / 127; 255 is undefined.
///                scale is the largest magnitude, or where few nodes (one in 500) lie far above the rest theirs; then
///                clipped is true
///   velocity     {nx, ny, scale, values: [base64 of nx x ny pairs of int8]} on a coarser grid of the same box: u and v
///                over scale (m/s) times 127; null where no velocity was written
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

}  // namespace rouleau::report
