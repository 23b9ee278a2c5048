#include "report_fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "files/field_nodes.hpp"
#include "files/frames.hpp"
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
  explicit Tracers(std::size_t outputs) : most_(std::min(most_each, most_of_all / outputs)) {}
  /// Of one output; on at most so many blocks.
  void add(const ScalarField& u, const ScalarField& v) {
    fields_[0].push_back(u);
    fields_[1].push_back(v);
  }
  [[nodiscard]] std::size_t most() const { return most_; }
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
  static constexpr std::size_t most_each = 2048, most_of_all = 120000;  ///< blocks: 0.3 MB of page
  std::size_t most_;
  std::array<std::vector<ScalarField>, 2> fields_;
};

/// Velocities along x on the plane across x in the middle, for profiles: as field_data has them.
class AcrossFlow {
 public:
  AcrossFlow(const files::FieldNodes& grid, std::size_t outputs)
      : grid_(grid), most_(std::min(most_each, most_of_all / outputs)) {}
  void add(const hdf5::File& file, const std::string& dataset) {
    const std::vector<double> vectors = grid_.across(file, dataset);
    const std::size_t components = vectors.size() / (grid_.ny * grid_.nz);
    BlockMeans means(grid_.ny, grid_.nz, most_);
    for (std::size_t z = 0; z < grid_.nz; ++z)
      means.add_row([&](std::size_t y) { return vectors[components * (z * grid_.ny + y)]; });
    fields_.push_back(means.means());
  }
  [[nodiscard]] Json to_json() const {
    double largest = 0;
    for (const ScalarField& field : fields_)
      for (const double u : field.values)
        if (std::isfinite(u)) largest = std::max(largest, std::abs(u));
    const double quantum = largest > 0 ? largest / std::numeric_limits<std::int16_t>::max() : 1;
    Json values = Json::array();
    for (const ScalarField& field : fields_) {
      std::vector<unsigned char> bytes;
      for (const double u : field.values) append_place(bytes, u, quantum);
      values.push_back(base64(bytes));
    }
    const auto& [x, y, z] = grid_.first;
    const std::size_t middle = grid_.nx / 2;
    return {{"ny", fields_.front().nx},
            {"nz", fields_.front().ny},
            {"x_um", (x + static_cast<double>(middle) * grid_.spacing[0]) * micro},
            {"box_um",
             {(y - grid_.spacing[1] / 2) * micro, (z - grid_.spacing[2] / 2) * micro,
              grid_.spacing[1] * double(grid_.ny) * micro, grid_.spacing[2] * double(grid_.nz) * micro}},
            {"quantum_um_per_s", quantum * micro},
            {"values", values}};
  }

 private:
  static constexpr std::size_t most_each = 1600, most_of_all = 40000;  ///< blocks: 0.1 MB of page
  const files::FieldNodes& grid_;
  std::size_t most_;
  std::vector<ScalarField> fields_;
};

/// A field of a file, read some rows at a time.
class FieldRows {
 public:
  FieldRows(const hdf5::File& file, const files::FieldNodes& grid, std::string dataset)
      : file_(file), grid_(grid), dataset_(std::move(dataset)) {}

  /// Calls visit(y) for every row from below. at() then knows that row; `around`: also those that vorticity needs
  /// there.
  template <class Visit>
  void for_each(bool around, const Visit& visit) {
    const std::size_t beside = around ? 2 : 0;
    if (around && grid_.ny > 0) first_ = read(0, 1), last_ = read(grid_.ny - 1, grid_.ny);
    for (std::size_t y = 0; y < grid_.ny;) {
      const std::size_t end = std::min(grid_.ny, y + rows_at_once());
      begin_ = y - std::min(y, beside);
      end_ = std::min(grid_.ny, end + beside);
      rows_ = read(begin_, end_);
      for (; y < end; ++y) visit(y);
    }
  }
  [[nodiscard]] std::size_t components() const { return components_; }
  /// Of a node; of a scalar there is but one component.
  [[nodiscard]] double at(std::size_t x, std::size_t y, std::size_t component) const {
    const std::size_t place = components_ * x + std::min(component, components_ - 1);
    if (y >= begin_ && y < end_) return rows_[(y - begin_) * components_ * grid_.nx + place];
    return y == 0 ? first_[place] : last_[place];
  }

 private:
  static constexpr std::size_t bytes = std::size_t{8} << 20;  ///< of the rows that are read at once
  [[nodiscard]] std::size_t rows_at_once() const {
    return std::max<std::size_t>(1, bytes / (3 * sizeof(double) * std::max<std::size_t>(1, grid_.nx)));
  }
  std::vector<double> read(std::size_t begin, std::size_t end) {
    std::vector<double> values = grid_.rows(file_, dataset_, begin, end);
    if (values.empty()) return values;
    components_ = values.size() / ((end - begin) * grid_.nx);
    if (components_ != 1 && components_ != 3)
      throw Error(Cause::input_output, Place{file_.path().string()},
                  dataset_ + " has no vectors of three components: the file is damaged; repeat the run");
    return values;
  }

  const hdf5::File& file_;
  const files::FieldNodes& grid_;
  std::string dataset_;
  std::size_t components_ = 1;
  std::size_t begin_ = 0, end_ = 0;  ///< rows that rows_ has
  std::vector<double> rows_, first_, last_;
};

/// Means over blocks of what a field of vectors tells.
struct VelocityMeans {
  ScalarField speed, vorticity;  ///< the latter empty where it is not wanted
};
VelocityMeans add_velocity(const hdf5::File& file, const files::FieldNodes& grid, const std::string& dataset,
                           std::size_t most, bool with_vorticity, Tracers& tracers) {
  const auto blocks = [&](std::size_t at_most) { return BlockMeans(grid.nx, grid.ny, at_most); };
  BlockMeans speed = blocks(most), vorticity = blocks(most), u = blocks(tracers.most()), v = blocks(tracers.most());
  FieldRows rows(file, grid, dataset);
  const VelocityGrid differences{grid.nx, grid.ny, {grid.spacing[0], grid.spacing[1]}, grid.periodic};
  const auto component = [&rows](std::size_t k) {
    return [&rows, k](std::size_t x, std::size_t y) { return rows.at(x, y, k); };
  };
  rows.for_each(with_vorticity, [&](std::size_t y) {
    u.add_row([&](std::size_t x) { return rows.at(x, y, 0); });
    v.add_row([&](std::size_t x) { return rows.at(x, y, 1); });
    speed.add_row([&](std::size_t x) { return std::hypot(rows.at(x, y, 0), rows.at(x, y, 1)); });
    if (with_vorticity)
      vorticity.add_row([&](std::size_t x) { return differences.vorticity(x, y, component(0), component(1)); });
  });
  tracers.add(u.means(), v.means());
  return {speed.means(), with_vorticity ? vorticity.means() : ScalarField{}};
}

/// Along z, which in three dimensions is the last of three components.
ScalarField mean_vorticity(const hdf5::File& file, const files::FieldNodes& grid, const std::string& dataset,
                           std::size_t most) {
  BlockMeans means(grid.nx, grid.ny, most);
  FieldRows rows(file, grid, dataset);
  rows.for_each(false, [&](std::size_t y) {
    means.add_row([&](std::size_t x) { return rows.at(x, y, rows.components() - 1); });
  });
  return means.means();
}

}  // namespace

std::vector<std::size_t> field_outputs(const std::filesystem::path& frames, std::size_t most) {
  const hdf5::File file = files::open_frames(frames);
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
  const hdf5::File file = files::open_frames(frames);
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
  Tracers tracers(with_fields.size());
  std::optional<AcrossFlow> across;
  if (has_velocity && grid.nz > 1) across.emplace(grid, with_fields.size());
  const std::size_t quantities = has_velocity ? 2 : 1;
  const std::size_t most = std::min(most_blocks, most_values / (quantities * with_fields.size()));
  for (const std::size_t output : with_fields) {
    if (has_velocity) {
      VelocityMeans means = add_velocity(file, grid, group_of(output) + "velocity", most, !has_vorticity, tracers);
      if (across) across->add(file, group_of(output) + "velocity");
      speeds.fields.push_back(std::move(means.speed));
      if (!has_vorticity) vorticities.fields.push_back(std::move(means.vorticity));
    }
    if (has_vorticity) vorticities.fields.push_back(mean_vorticity(file, grid, group_of(output) + "vorticity", most));
  }
  Json result{{"nx", vorticities.fields.front().nx},
              {"ny", vorticities.fields.front().ny},
              {"box_um", box_um(grid)},
              {"outputs", outputs},
              {"derived", !has_vorticity},
              {"quantities", Json::array()}};
  result["velocity"] = has_velocity ? tracers.to_json() : Json();
  result["across"] = across ? across->to_json() : Json();
  const std::size_t middle = grid.nz / 2;
  if (grid.nz > 1) result["z_um"] = (grid.first[2] + static_cast<double>(middle) * grid.spacing[2]) * micro;
  if (has_velocity) result["quantities"].push_back(to_json(speeds));
  result["quantities"].push_back(to_json(vorticities));
  return result;
}

BlockMeans::BlockMeans(std::size_t nx, std::size_t ny, std::size_t most) : nx_(nx), ny_(ny), means_{nx, ny, {}} {
  most = std::max<std::size_t>(1, most);
  if (nx * ny <= most) return;
  // A domain that is one block high cannot be thinned along y: the blocks grow until there are few enough.
  for (double side = std::sqrt(double(nx * ny) / double(most));; side *= 1.02) {
    means_.nx = std::max<std::size_t>(1, static_cast<std::size_t>(double(nx) / side));
    means_.ny = std::max<std::size_t>(1, static_cast<std::size_t>(double(ny) / side));
    if (means_.nx * means_.ny <= most) break;
  }
  sums_.resize(means_.nx);
}

void BlockMeans::end_row() {
  const std::size_t j = means_.values.size() / means_.nx;  // of these blocks
  if (++rows_ < (j + 1) * ny_ / means_.ny) return;
  for (std::size_t i = 0; i < means_.nx; ++i) {
    const std::size_t columns = (i + 1) * nx_ / means_.nx - i * nx_ / means_.nx;
    means_.values.push_back(std::exchange(sums_[i], 0.0) / double(columns * (rows_ - rows_before_)));
  }
  rows_before_ = rows_;
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
