// A potential at the contacts of one cell in three dimensions: with velocities, and with what it remembers of them.
#pragma once

#include <vector>

#include "core/membrane/cell_nodes.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// Contacts of one cell that a potential is asked about: of its nodes, each with another cell's image or a wall.
struct SurfaceLawInputs {
  /// What a contact is found by from step to step.
  struct Key {
    int node;   ///< of the cell, from its first on
    int other;  ///< as in ContactState
    ImageShift shift;
  };
  std::vector<Key> key;
  std::vector<double> distance;  ///< positive
  // Each is empty where the potential does not read it.
  std::vector<double> normal_velocity;  ///< d distance / dt
  std::vector<double> sliding_speed;    ///< of the velocity against the other surface what is not along the distance

  void clear() { key.clear(), distance.clear(), normal_velocity.clear(), sliding_speed.clear(); }
};

/// A potential and the place of what it remembers.
class SurfaceLaw {
 public:
  /// Adds what the potential, the `place`-th of those that share the memory, remembers of so many cells. Throws
  /// std::invalid_argument if it reads a tangential velocity, which has no sign here.
  SurfaceLaw(Potential potential, std::size_t place, ContactMemory& memory, std::size_t cells);

  [[nodiscard]] const Potential& potential() const { return potential_; }
  [[nodiscard]] double cutoff() const { return cutoff_; }
  [[nodiscard]] bool remembers() const { return !variables_.empty(); }
  [[nodiscard]] bool reads_normal_velocity() const { return reads_normal_velocity_; }
  [[nodiscard]] bool reads_sliding_speed() const { return reads_sliding_speed_; }
  [[nodiscard]] bool has_energy() const { return has_energy_; }

  /// Sets `law` to the force, or the energy, at each contact of a cell. `next`: takes the state after one step of those
  /// contacts; null: somebody looks, and there is no step.
  void evaluate(const CellRange& cell, const std::vector<ContactState>& known, const SurfaceLawInputs& inputs,
                bool energy, std::vector<ContactState>* next, std::vector<double>& law) const;

 private:
  Potential potential_;
  double cutoff_;
  bool reads_normal_velocity_, reads_sliding_speed_, has_energy_;
  struct Variable {
    std::size_t place;  ///< in ContactMemory::variables
    double initial;
  };
  std::vector<Variable> variables_;
};

/// What a cell's interactions remember; nothing where none does.
inline const std::vector<ContactState>& states_of(const ContactMemory& memory, int cell) {
  static const std::vector<ContactState> none;
  return memory.of_cell.empty() ? none : memory.of_cell[cell];
}

}  // namespace rouleau::core
