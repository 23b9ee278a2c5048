#include "distance_law.hpp"

namespace rouleau::core {

double cutoff_of(const Potential& potential) {
  return call_foreign(potential.id, "cutoff", [&] { return potential.table->cutoff(potential.self.get()); });
}

bool is_of_distance_alone(const Potential& potential) {
  return potential.state.empty() && !potential.reads("normal_velocity") && !potential.reads("tangential_velocity");
}

}  // namespace rouleau::core
