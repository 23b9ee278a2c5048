#include "field_nodes.hpp"

#include <cmath>

namespace rouleau::files {

FieldNodes::FieldNodes(const Hdf5File& file, const std::string& dataset) {
  const auto shape = file.shape(dataset);
  const std::size_t space = file.has_attribute("/", "periodic_z") ? 1 : 0;
  if (space == 1) nz = shape.at(0);
  ny = shape.at(space);
  nx = shape.at(space + 1);
  const bool part = file.has_attribute("/", "fields_first_m");
  const std::array<std::size_t, 2> nodes{nx, ny};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double length = file.read_attribute("/", "size_m", axis);
    spacing[axis] = part ? file.read_attribute("/", "fields_spacing_m", axis) : length / double(nodes[axis]);
    first[axis] = part ? file.read_attribute("/", "fields_first_m", axis) : spacing[axis] / 2;
    const bool whole = std::abs(spacing[axis] * double(nodes[axis]) - length) < 1e-6 * length;
    periodic[axis] = whole && (axis == 0 || file.read_attribute("/", "periodic_y") != 0);
  }
}

FieldNodes::Box FieldNodes::box() const {
  return {{first[0] - spacing[0] / 2, first[1] - spacing[1] / 2}, {spacing[0] * double(nx), spacing[1] * double(ny)}};
}

std::vector<double> FieldNodes::section(const Hdf5File& file, const std::string& dataset) const {
  std::vector<double> values = file.read(dataset);
  if (nz == 1) return values;
  const auto each = static_cast<std::ptrdiff_t>(values.size() / nz), begin = each * static_cast<std::ptrdiff_t>(nz / 2);
  return {values.begin() + begin, values.begin() + begin + each};
}

}  // namespace rouleau::files
