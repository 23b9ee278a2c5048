// Cells at random: what the scene asks for.
#include "base/text.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

/// From where to where the region reaches along an axis.
void check_side(const SceneFields& fields, const std::string& pointer, int axis, double size, double lower,
                double upper) {
  const std::string along(1, axis_names[axis]), name = "/" + std::to_string(axis);
  if (lower < 0) fields.refuse(pointer + "/lower" + name, "the region begins outside of the domain");
  // A size that was written in other units may differ by rounding.
  if (upper > size * (1 + 1e-9)) {
    fields.refuse(pointer + "/upper" + name, "the region ends outside of the domain, whose size along " + along +
                                                 " is " + number(size * 1e6) + " um");
  }
  if (!(upper > lower)) {
    fields.refuse(pointer + "/upper" + name,
                  "the region's upper corner must lie above its lower corner along " + along);
  }
}

/// The region as written; the whole domain without one.
void read_region(const SceneFields& fields, const std::string& pointer, const Domain& domain, RandomPacking& packing) {
  packing.lower = Vector::filled(domain.dimension(), 0);
  packing.upper = domain.size;
  if (!fields.has(pointer)) return;
  packing.lower = fields.place(pointer + "/lower", domain, "corner");
  packing.upper = fields.place(pointer + "/upper", domain, "corner");
  if (!fields.settled(pointer) || !is_known(domain)) return;
  for (int axis = 0; axis < domain.dimension(); ++axis)
    check_side(fields, pointer, axis, domain.size[axis], packing.lower[axis], packing.upper[axis]);
  if (!domain.tube_radius) return;
  const double radius = *domain.tube_radius * (1 - 1e-9);
  for (const int axis : {1, 2}) {
    const double middle = 0.5 * domain.size[axis];
    if (packing.lower[axis] <= middle - radius && packing.upper[axis] >= middle + radius) continue;
    fields.refuse(pointer,
                  "the region of a tube is a piece of it along x\nlet it reach from wall to wall along y and z");
  }
}

}  // namespace

RandomPacking read_packing(const SceneFields& fields, const std::string& entry, int type, const Domain& domain) {
  const auto pointer = entry + "/random";
  RandomPacking packing{};
  packing.type = type;
  packing.pointer = entry;
  packing.seed = fields.value<std::uint32_t>(pointer + "/seed");
  packing.gap = fields.quantity_or(pointer + "/gap", "m", range::length, domain.size.x() / domain.nodes[0]);
  fields.attempt([&] { read_region(fields, pointer + "/region", domain, packing); });

  const bool by_share = fields.has(pointer + "/hematocrit"), by_count = fields.has(pointer + "/count");
  if (by_share == by_count && fields.settled(pointer)) {
    fields.refuse(pointer, by_share ? "give hematocrit or count, not both"
                                    : "give hematocrit (such as 0.3) or count (such as 20)");
  }
  if (by_share) packing.hematocrit = fields.value<double>(pointer + "/hematocrit");
  if (by_count) packing.count = fields.value<int>(pointer + "/count");
  return packing;
}

}  // namespace rouleau::scene
