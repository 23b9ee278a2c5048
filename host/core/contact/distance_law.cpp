#include "distance_law.hpp"

namespace rouleau::core {

double cutoff_of(const Potential& potential) {
  return call_foreign(potential.id, "cutoff", [&] { return potential.table->cutoff(potential.self.get()); });
}

bool is_of_distance_alone(const Potential& potential) {
  return potential.state.empty() && !potential.reads("normal_velocity") && !reads_sliding(potential);
}

bool reads_sliding(const Potential& potential) {
  return potential.reads("tangential_velocity") || potential.reads("sliding_speed");
}

std::vector<std::size_t> keep_state(const Potential& potential, std::size_t place, ContactMemory& memory,
                                    std::size_t cells) {
  std::vector<std::size_t> variables;
  for (const StateVariable& declared : potential.state) {
    memory.of_cell.resize(cells);
    variables.push_back(
        memory.keep({static_cast<int>(place), potential.id, declared.name, declared.unit, declared.initial}));
  }
  return variables;
}

}  // namespace rouleau::core
