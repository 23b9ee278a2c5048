#include "report_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "files/field_nodes.hpp"
#include "files/frames.hpp"
#include "observe/vorticity.hpp"
#include "report_outlines.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_values = 600000;  ///< of all quantities and outputs: 0.8 MB of page
constexpr std::size_t most_blocks = 32768;   ///< of one field
constexpr unsigned char undefined = 255;

std::string group_of(std::size_t output) { return files::frame_path(output) + "/fields/"; }

/// One quantity at all shown outputs.
struct Quantity {
  const char* name;
  const char* unit;
  bool is_signed;
  std::vector<ScalarField> fields;
};

/// The largest magnitude, or what all but one value in 500 stay below where that is far less.
double colour_scale(const Quantity& quantity) {
  std::vector<double> sizes;
  for (const ScalarField& field : quantity.fields)
    for (const double value : field.values)
      if (std::isfinite(value)) sizes.push_back(std::abs(value));
  if (sizes.empty()) return 0;
  const double largest = *std::max_element(sizes.begin(), sizes.end());
  const auto rank = sizes.begin() + static_cast<long>(sizes.size() - 1 - sizes.size() / 500);
  std::nth_element(sizes.begin(), rank, sizes.end());
  return 2 * *rank < largest ? *rank : largest;
}

Json to_json(const Quantity& quantity) {
  const double scale = colour_scale(quantity);
  bool clipped = false;
  Json values = Json::array();
  for (const ScalarField& field : quantity.fields) {
    for (const double value : field.values) clipped = clipped || std::abs(value) > scale;
    values.push_back(base64(quantised(field.values, scale, quantity.is_signed)));
  }
  return {{"name", quantity.name},        {"unit", quantity.unit}, {"scale", scale},
          {"signed", quantity.is_signed}, {"clipped", clipped},    {"values", values}};
}

Json box_um(const files::FieldNodes& grid) {
  const auto [first, size] = grid.box();
  return {first[0] * micro, first[1] * micro, size[0] * micro, size[1] * micro};
}

/// The velocity for tracers, on a coarser grid: {nx, ny, scale, values}, of int8 pairs in base64.
class Tracers {
 public:
  Tracers(const files::FieldNodes& grid, std::size_t outputs)
      : grid_(grid), most_(std::min(most_each, most_in_all / outputs)) {}
  void add(const std::vector<double>& velocity) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      fields_[axis].push_back(block_means(component_of(velocity, grid_.nx, grid_.ny, axis), most_));
  }
  [[nodiscard]] Json to_json() const {
    double scale = 0;
    for (const auto& fields : fields_)
      for (const ScalarField& field : fields)
        for (const double value : field.values)
          if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
    Json values = Json::array();
    for (std::size_t k = 0; k < fields_[0].size(); ++k) {
      std::vector<unsigned char> bytes;
      for (std::size_t i = 0; i < fields_[0][k].values.size(); ++i)
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const double value = fields_[axis][k].values[i];
          const double share = scale > 0 && std::isfinite(value) ? value / scale : 0;
          bytes.push_back(static_cast<unsigned char>(std::lround(127 * share)));
        }
      values.push_back(base64(bytes));
    }
    const ScalarField& first = fields_[0].front();
    return {{"nx", first.nx}, {"ny", first.ny}, {"scale", scale}, {"values", values}};
  }

 private:
  static constexpr std::size_t most_each = 2048, most_in_all = 120000;  ///< blocks: 0.3 MB of page
  const files::FieldNodes& grid_;
  std::size_t most_;
  std::array<std::vector<ScalarField>, 2> fields_;
};

ScalarField speed(const std::vector<double>& velocity, std::size_t nx, std::size_t ny) {
  ScalarField field{nx, ny, std::vector<double>(nx * ny)};
  for (std::size_t i = 0; i < nx * ny; ++i) field.values[i] = std::hypot(velocity[3 * i], velocity[3 * i + 1]);
  return field;
}

}  // namespace

std::vector<std::size_t> field_outputs(const std::filesystem::path& frames, std::size_t most) {
  const files::Hdf5File file = files::open_frames(frames);
  std::vector<std::size_t> found;
  const auto count = static_cast<std::size_t>(file.members("/frames"));
  for (std::size_t output = 0; output < count; ++output)
    if (file.has(group_of(output) + "velocity") || file.has(group_of(output) + "vorticity")) found.push_back(output);
  if (found.size() <= most) return found;
  std::vector<std::size_t> thinned;
  for (std::size_t k = 0; k < most; ++k) thinned.push_back(found[k * (found.size() - 1) / (most - 1)]);
  return thinned;
}

Json field_data(const std::filesystem::path& frames, const std::vector<std::size_t>& selection) {
  const files::Hdf5File file = files::open_frames(frames);
  Json outputs = Json::array();
  bool has_velocity = true, has_vorticity = true;
  std::vector<std::size_t> with_fields;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const bool velocity = file.has(group_of(selection[k]) + "velocity");
    const bool written = file.has(group_of(selection[k]) + "vorticity");
    if (!velocity && !written) continue;
    has_velocity = has_velocity && velocity;
    has_vorticity = has_vorticity && written;
    with_fields.push_back(selection[k]);
    outputs.push_back(k);
  }
  if (with_fields.empty() || (!has_velocity && !has_vorticity)) return nullptr;

  Quantity speeds{"speed", "m/s", false, {}}, vorticities{"vorticity", "1/s", true, {}};
  const files::FieldNodes grid(file, group_of(with_fields.front()) + (has_velocity ? "velocity" : "vorticity"));
  Tracers tracers(grid, with_fields.size());
  const std::size_t quantities = has_velocity ? 2 : 1;
  const std::size_t most = std::min(most_blocks, most_values / (quantities * with_fields.size()));
  for (const std::size_t output : with_fields) {
    if (has_velocity) {
      const auto velocity = grid.section(file, group_of(output) + "velocity");
      tracers.add(velocity);
      speeds.fields.push_back(block_means(speed(velocity, grid.nx, grid.ny), most));
      if (!has_vorticity)
        vorticities.fields.push_back(
            block_means(vorticity(velocity, grid.nx, grid.ny, grid.spacing, grid.periodic), most));
    }
    if (has_vorticity) {
      const auto written = grid.section(file, group_of(output) + "vorticity");  // in three dimensions vectors
      vorticities.fields.push_back(block_means(written.size() == grid.nx * grid.ny
                                                   ? ScalarField{grid.nx, grid.ny, written}
                                                   : component_of(written, grid.nx, grid.ny, 2),
                                               most));
    }
  }
  Json result{{"nx", vorticities.fields.front().nx},
              {"ny", vorticities.fields.front().ny},
              {"box_um", box_um(grid)},
              {"outputs", outputs},
              {"derived", !has_vorticity},
              {"quantities", Json::array()}};
  result["velocity"] = has_velocity ? tracers.to_json() : Json();
  if (has_velocity) result["quantities"].push_back(to_json(speeds));
  result["quantities"].push_back(to_json(vorticities));
  return result;
}

ScalarField component_of(const std::vector<double>& vectors, std::size_t nx, std::size_t ny, std::size_t axis) {
  ScalarField field{nx, ny, std::vector<double>(nx * ny)};
  for (std::size_t i = 0; i < nx * ny; ++i) field.values[i] = vectors[3 * i + axis];
  return field;
}

ScalarField vorticity(const std::vector<double>& velocity, std::size_t nx, std::size_t ny,
                      const std::array<double, 2>& spacing, const std::array<bool, 2>& periodic) {
  ScalarField field{nx, ny, std::vector<double>(nx * ny)};
  const auto u = [&](std::size_t x, std::size_t y) { return velocity[3 * (y * nx + x)]; };
  const auto v = [&](std::size_t x, std::size_t y) { return velocity[3 * (y * nx + x) + 1]; };
  const observe::VelocityGrid grid{nx, ny, spacing, periodic};
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) field.values[y * nx + x] = grid.vorticity(x, y, u, v);
  return field;
}

ScalarField block_means(const ScalarField& field, std::size_t most) {
  most = std::max<std::size_t>(1, most);
  if (field.values.size() <= most) return field;
  ScalarField means;
  // A domain that is one block high cannot be thinned along y: the blocks grow until there are few enough.
  for (double side = std::sqrt(double(field.values.size()) / double(most));; side *= 1.02) {
    means.nx = std::max<std::size_t>(1, static_cast<std::size_t>(double(field.nx) / side));
    means.ny = std::max<std::size_t>(1, static_cast<std::size_t>(double(field.ny) / side));
    if (means.nx * means.ny <= most) break;
  }
  for (std::size_t j = 0; j < means.ny; ++j) {
    for (std::size_t i = 0; i < means.nx; ++i) {
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t y = j * field.ny / means.ny; y < (j + 1) * field.ny / means.ny; ++y)
        for (std::size_t x = i * field.nx / means.nx; x < (i + 1) * field.nx / means.nx; ++x, ++count)
          sum += field.values[y * field.nx + x];
      means.values.push_back(sum / double(count));
    }
  }
  return means;
}

std::vector<unsigned char> quantised(const std::vector<double>& values, double scale, bool is_signed) {
  std::vector<unsigned char> bytes;
  bytes.reserve(values.size());
  const double levels = is_signed ? 127 : 254, middle = is_signed ? 127 : 0;
  for (const double value : values) {
    const double share = scale > 0 ? std::clamp(value / scale, is_signed ? -1.0 : 0.0, 1.0) : 0;
    bytes.push_back(std::isfinite(value) ? static_cast<unsigned char>(std::lround(middle + levels * share))
                                         : undefined);
  }
  return bytes;
}

}  // namespace rouleau::report
