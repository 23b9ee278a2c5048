// Cells at random: what the scene asks for.
#include "base/text.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

/// From where to where the region reaches along an axis.
void check_side(const SceneFields& fields, const std::string& pointer, int axis, double size, double lower,
                double upper) {
  const std::string along(1, "xyz"[axis]), name = "/" + std::to_string(axis);
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

}  // namespace

void require_corners(const SceneFields& fields, const std::string& region, const std::array<const char*, 2>& corners,
                     const Domain& domain) {
  for (const char* const corner : corners) {
    if (static_cast<int>(fields.count(region + corner)) == domain.dimension()) continue;
    fields.refuse(region + corner, domain.depth ? "in three dimensions a corner has three lengths"
                                                : "there is no z in two dimensions\ngive two lengths");
  }
}

namespace {

/// The region as written; the whole domain without one.
void read_region(const SceneFields& fields, const std::string& pointer, const Domain& domain, RandomPacking& packing) {
  packing.lower = Eigen::Vector2d::Zero();
  packing.upper = domain.size;
  packing.upper_z = domain.depth ? domain.depth->size : 0;
  if (!fields.has(pointer)) return;
  if (fields.settled(pointer) && is_known(domain)) {
    require_corners(fields, pointer, {"/lower", "/upper"}, domain);
  }
  packing.lower = fields.quantities(pointer + "/lower", "m", range::place);
  packing.upper = fields.quantities(pointer + "/upper", "m", range::place);
  if (domain.depth) {
    packing.lower_z = fields.quantity(pointer + "/lower/2", "m", range::place);
    packing.upper_z = fields.quantity(pointer + "/upper/2", "m", range::place);
  }
  if (!fields.settled(pointer) || !is_known(domain)) return;
  for (int axis = 0; axis < 2; ++axis)
    check_side(fields, pointer, axis, domain.size[axis], packing.lower[axis], packing.upper[axis]);
  if (!domain.depth) return;
  check_side(fields, pointer, 2, domain.depth->size, packing.lower_z, packing.upper_z);
  if (!domain.tube_radius) return;
  const double radius = *domain.tube_radius * (1 - 1e-9);
  const double y = 0.5 * domain.size.y(), z = 0.5 * domain.depth->size;
  if (packing.lower.y() > y - radius || packing.upper.y() < y + radius || packing.lower_z > z - radius ||
      packing.upper_z < z + radius) {
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
