#include "field_nodes.hpp"

#include <cmath>

#include "base/error.hpp"
#include "frames.hpp"

namespace rouleau::files {

FieldNodes::FieldNodes(const hdf5::File& file, const std::string& dataset) {
  const auto shape = file.shape(dataset);
  const std::size_t space = file.has_attribute("/", "periodic_z") ? 1 : 0;
  if (space == 1) nz = shape.at(0);
  ny = shape.at(space);
  nx = shape.at(space + 1);
  const bool part = file.has_attribute("/", "fields_first_m");
  const std::array<std::size_t, 3> nodes{nx, ny, nz};
  for (std::size_t axis = 0; axis < 2 + space; ++axis) {
    const double length = file.read_attribute("/", "size_m", axis);
    spacing[axis] = part ? file.read_attribute("/", "fields_spacing_m", axis) : length / double(nodes[axis]);
    first[axis] = part ? file.read_attribute("/", "fields_first_m", axis) : spacing[axis] / 2;
    const bool whole = std::abs(spacing[axis] * double(nodes[axis]) - length) < 1e-6 * length;
    const bool comes_again =
        axis == 0 ? !file.has_attribute("/", "periodic_x") : file.read_attribute("/", "periodic_y") != 0;
    if (axis < periodic.size()) periodic[axis] = whole && comes_again;
  }
}

FieldNodes::Box FieldNodes::box() const {
  return {{first[0] - spacing[0] / 2, first[1] - spacing[1] / 2}, {spacing[0] * double(nx), spacing[1] * double(ny)}};
}

std::vector<double> FieldNodes::rows(const hdf5::File& file, const std::string& dataset, std::size_t begin,
                                     std::size_t end) const {
  return values(file, dataset, {nz / 2, nz / 2 + 1}, {begin, end}, {0, nx});
}

std::vector<double> FieldNodes::values(const hdf5::File& file, const std::string& dataset, Range layers, Range rows,
                                       Range columns) const {
  static_cast<void>(file.elements(dataset));  // refuses more than the file can hold
  const auto shape = file.shape(dataset);
  const std::size_t space = file.has_attribute("/", "periodic_z") ? 1 : 0;
  const bool fits = shape.size() >= space + 2 && shape.size() <= space + 3 && shape[space] == ny &&
                    shape[space + 1] == nx && (space == 0 || shape[0] == nz);
  if (!fits)
    throw Error(Cause::input_output, Place{file.path().string()},
                dataset + " does not fit the nodes of other fields: the file is damaged; repeat the run");
  std::vector<hsize_t> from(shape.size(), 0), to(shape.begin(), shape.end());
  if (space == 1) from[0] = layers[0], to[0] = layers[1];
  from[space] = rows[0], to[space] = rows[1];
  from[space + 1] = columns[0], to[space + 1] = columns[1];
  std::vector<double> values((layers[1] - layers[0]) * (rows[1] - rows[0]) * (columns[1] - columns[0]) *
                             (shape.size() > space + 2 ? shape.back() : 1));
  if (!values.empty()) file.read(dataset, H5T_NATIVE_DOUBLE, from, to, values.data());
  return values;
}

std::optional<VelocityField> last_velocity(const std::filesystem::path& frames) {
  const hdf5::File file = open_frames(frames);
  auto frame = static_cast<std::size_t>(file.members("/frames"));
  while (frame > 0 && !file.has(frame_path(frame - 1) + "/fields/velocity")) --frame;
  if (frame == 0) return std::nullopt;
  const std::string group = frame_path(frame - 1), dataset = group + "/fields/velocity";
  const FieldNodes nodes(file, dataset);
  VelocityField field{file.read_attribute(group, "time_s"),
                      static_cast<std::size_t>(file.read_attribute(group, "stage")),
                      nodes.nx,
                      {},
                      {},
                      nodes.all(file, dataset)};
  for (std::size_t j = 0; j < nodes.ny; ++j) field.y.push_back(nodes.first[1] + double(j) * nodes.spacing[1]);
  for (std::size_t k = 0; k < nodes.nz; ++k) field.z.push_back(nodes.first[2] + double(k) * nodes.spacing[2]);
  return field;
}

}  // namespace rouleau::files
