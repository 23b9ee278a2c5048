#include "field_nodes.hpp"

#include <cmath>

namespace rouleau::files {

FieldNodes::FieldNodes(const Hdf5File& file, const std::string& dataset) {
  const auto shape = file.shape(dataset);
  ny = shape.at(0);
  nx = shape.at(1);
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

}  // namespace rouleau::files
