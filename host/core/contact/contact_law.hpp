// A potential at the contacts of one cell: what it reads of them, and what it remembers from step to step.
#pragma once

#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/element_state.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// What a potential is multiplied by in the course of a setup: 1, one value, two with a ramp between them or, with
/// `steps`, some that last equally long.
struct Course {
  std::vector<double> values = {};
  bool steps = false;
  double length = 0;  ///< time steps, after which the last value stays

  [[nodiscard]] bool changes() const { return values.size() > 1; }
  [[nodiscard]] double at(double time) const;
};

/// A potential between cells of two types (unordered; equal: between different cells of one type and own images).
struct Interaction {
  std::array<int, 2> between;
  Potential potential;
  Course strength = {};
};

/// A potential between the cells of a type and the walls.
struct WallInteraction {
  int type;
  Potential potential;
  Course strength = {};
};

/// A potential between the parts of each cell of a type.
struct SelfInteraction {
  int type;
  Potential potential;
  Course strength = {};
};

/// Beyond it the potential does nothing, spacings.
double cutoff_of(const Potential& potential);
/// Whether it reads how facing surfaces slide along each other, with a sign or without.
bool reads_sliding(const Potential& potential);
/// Potentials are promised a positive distance: this one at least.
constexpr double least_distance = 1e-12;

/// What a contact is found by from step to step.
struct ContactKey {
  int node;   ///< of the cell, from its first on
  int other;  ///< as in ContactState
  ImageShift shift;
};

/// What potentials are told of a cell's contacts, each of a node with another cell's image, with the cell itself or
/// with a wall. Arrays that no potential reads may be empty, others longer than there are contacts.
struct ContactValues {
  std::vector<double> distance;             ///< positive
  std::vector<double> normal_velocity;      ///< d distance / dt
  std::vector<double> tangential_velocity;  ///< positive where the node runs counter-clockwise along its own cell
  std::vector<double> sliding_speed;  ///< of the velocity against the other surface what is not along the distance
  std::vector<ContactKey> key;

  void clear();
};

/// A potential and the place of what it remembers.
class ContactLaw {
 public:
  /// Adds what the potential, the `place`-th of those that share the memory, remembers of so many cells, as far as it
  /// is not there from an earlier stage.
  ContactLaw(Potential potential, std::size_t place, ContactMemory& memory, std::size_t cells, Course strength = {});

  /// So many time steps after the setup's start.
  void set_time(double time) { strength_ = course_.at(time); }

  [[nodiscard]] const Potential& potential() const { return potential_; }
  [[nodiscard]] double cutoff() const { return cutoff_; }
  [[nodiscard]] bool remembers() const { return !variables_.empty(); }
  [[nodiscard]] bool reads_normal_velocity() const { return reads_normal_velocity_; }
  [[nodiscard]] bool reads_velocities() const {
    return reads_normal_velocity_ || reads_tangential_velocity_ || reads_sliding_speed_;
  }
  [[nodiscard]] bool has_energy() const { return has_energy_; }

  /// Sets what the law reads, but the key, to the values of the contacts with these numbers.
  void choose(const ContactValues& from, const std::vector<int>& contacts, ContactValues& chosen) const;
  /// Sets law[0], law[1] ... to the force, or the energy, at contacts of a cell with so many nodes, which remembers the
  /// `known` states. `next`: takes the state after one step of those contacts; null: somebody looks, and there is no
  /// step.
  void evaluate(int nodes, const std::vector<ContactState>& known, const ContactValues& values, Range contacts,
                bool energy, std::vector<ContactState>* next, double* law) const;

 private:
  Potential potential_;
  Course course_;
  double strength_, cutoff_;
  bool reads_normal_velocity_, reads_tangential_velocity_, reads_sliding_speed_, has_energy_;
  struct Variable {
    std::size_t place;  ///< in ContactMemory::variables
    double initial;
  };
  std::vector<Variable> variables_;
};

/// What a cell's contacts remember; nothing where no potential does.
const std::vector<ContactState>& states_of(const ContactMemory& memory, int cell);

}  // namespace rouleau::core
