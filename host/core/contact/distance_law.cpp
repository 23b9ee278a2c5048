#include "distance_law.hpp"

#include <cstdint>

namespace rouleau::core {

double cutoff_of(const Potential& potential) {
  return call_foreign(potential.id, "cutoff", [&] { return potential.table->cutoff(potential.self.get()); });
}

bool is_of_distance_alone(const Potential& potential) {
  return potential.state.empty() && !potential.reads("normal_velocity") && !potential.reads("tangential_velocity");
}

void evaluate(const Potential& potential, const std::vector<double>& distance, bool energy, std::vector<double>& law) {
  law.resize(distance.size());
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(distance.size());
  block.time_step = 1;
  block.distance = distance.data();
  (energy ? block.energy : block.force) = law.data();
  potential.compute(&block);
}

}  // namespace rouleau::core
