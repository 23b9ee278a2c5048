// Which part of the fluid's fields a scene wants written, and how.
#include <array>
#include <cmath>
#include <vector>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::scene {

namespace {

std::string micrometres(double length) { return number(length * 1e6, 6) + " um"; }

/// The nodes of a region along one axis; node i lies at (i + 1/2) spacings.
std::array<int, 2> nodes_within(const SceneFields& fields, const Domain& domain, int axis, double from, double to) {
  const std::string pointer = "/output/fields/region", along = std::string(" along ") + axis_names[axis];
  const std::string end = json::child_pointer(pointer + "/to", static_cast<std::size_t>(axis));
  const double size = domain.size[axis], spacing = size / domain.nodes[axis];
  constexpr double rounding = 1e-9;  // a border that is meant to lie on a node shall include it
  if (from < -rounding * size)
    fields.refuse(json::child_pointer(pointer + "/from", static_cast<std::size_t>(axis)),
                  "the region begins at " + micrometres(from) + along + ", outside the domain, which begins at 0");
  if (to > size * (1 + rounding))
    fields.refuse(end, "the region ends at " + micrometres(to) + along + ", outside the domain, which ends at " +
                           micrometres(size));
  if (!(from < to))
    fields.refuse(end, "the region ends at " + micrometres(to) + along + " and begins at " + micrometres(from) +
                           "; \"from\" is the lower corner and \"to\" the upper one");
  const int first = static_cast<int>(std::ceil(units::place_on_lattice(from, spacing) - rounding));
  const int last = static_cast<int>(std::floor(units::place_on_lattice(to, spacing) + rounding));
  if (first > last)
    fields.refuse(pointer, "no lattice node lies between " + micrometres(from) + " and " + micrometres(to) + along +
                               ": they lie " + micrometres(spacing) + " apart, the nearest at " +
                               micrometres(units::coordinate(last, spacing)) + "; make the region larger");
  return {first, last};
}

}  // namespace

int FieldStorage::count(int axis, int nodes) const {
  const auto a = static_cast<std::size_t>(axis);
  return ((last ? (*last)[a] : nodes - 1) - first[a]) / stride + 1;
}

FieldStorage read_field_storage(const SceneFields& fields, const Domain& domain) {
  FieldStorage storage;
  fields.attempt([&] {
    const std::string region = "/output/fields/region";
    if (!fields.has(region)) return;
    const Vector from = fields.place(region + "/from", domain, "corner"),
                 to = fields.place(region + "/to", domain, "corner");
    if (!fields.settled(region) || !is_known(domain)) return;
    storage.last.emplace();
    for (int axis = 0; axis < domain.dimension(); ++axis) {
      const auto [first, last] = nodes_within(fields, domain, axis, from[axis], to[axis]);
      storage.first[axis] = first;
      (*storage.last)[axis] = last;
    }
  });
  storage.stride = fields.value_or("/output/fields/stride", storage.stride);
  storage.compression = fields.value_or("/output/fields/compression", storage.compression);
  if (fields.value_or("/output/fields/precision", std::string("f32")) == "f64") storage.precision = Precision::f64;
  return storage;
}

}  // namespace rouleau::scene
