// The flow under the cells of report.html: speed and vorticity from frames.h5, thinned and quantised for a page.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rouleau::report {

/// A scalar on a grid, row by row from below, x fastest.
struct ScalarField {
  std::size_t nx = 0, ny = 0;
  std::vector<double> values;
};

/// Outputs of a frames.h5 whose fields a report can draw (velocity or vorticity), at most `most`, evenly thinned.
std::vector<std::size_t> field_outputs(const std::filesystem::path& frames, std::size_t most);

/// {nx, ny, box_um, outputs, quantities, velocity, derived} of the shown outputs `selection` that have fields; null when none
/// has.
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

/// dv/dx - du/dy by central differences; where the grid ends without going on periodically, one-sided ones of second
/// order. `velocity` holds three components per node.
ScalarField vorticity(const std::vector<double>& velocity, std::size_t nx, std::size_t ny,
                      const std::array<double, 2>& spacing, const std::array<bool, 2>& periodic);

/// One component of vectors that have three for each node.
ScalarField component_of(const std::vector<double>& vectors, std::size_t nx, std::size_t ny, std::size_t axis);

/// Means over blocks of nodes, of which there are at most `most`; the blocks have the shape of the domain's nodes.
ScalarField block_means(const ScalarField& field, std::size_t most);

/// Bytes as described above.
std::vector<unsigned char> quantised(const std::vector<double>& values, double scale, bool is_signed);

}  // namespace rouleau::report
