// Cells at random: what the scene asks for.
#include "base/text.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

/// The region as written; the whole domain without one.
void read_region(const SceneFields& fields, const std::string& pointer, const Domain& domain, RandomPacking& packing) {
  packing.lower = Eigen::Vector2d::Zero();
  packing.upper = domain.size;
  if (!fields.has(pointer)) return;
  packing.lower = fields.quantities(pointer + "/lower", "m", range::place);
  packing.upper = fields.quantities(pointer + "/upper", "m", range::place);
  if (!fields.settled(pointer) || !is_known(domain)) return;
  for (int axis = 0; axis < 2; ++axis) {
    const std::string along = axis == 0 ? "x" : "y", name = axis == 0 ? "/0" : "/1";
    if (packing.lower[axis] < 0) fields.refuse(pointer + "/lower" + name, "the region begins outside of the domain");
    // A size that was written in other units may differ by rounding.
    if (packing.upper[axis] > domain.size[axis] * (1 + 1e-9)) {
      fields.refuse(pointer + "/upper" + name, "the region ends outside of the domain, whose size along " + along +
                                                   " is " + number(domain.size[axis] * 1e6) + " um");
    }
    if (!(packing.upper[axis] > packing.lower[axis])) {
      fields.refuse(pointer + "/upper" + name,
                    "the region's upper corner must lie above its lower corner along " + along);
    }
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
