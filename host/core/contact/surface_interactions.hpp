// Forces between cells in three dimensions: potentials integrated over facing surfaces, with the reaction on the other cell.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/surface/surfaces.hpp"
#include "interaction_forces.hpp"
#include "surface_contacts.hpp"

namespace rouleau::core {

/// Node i with rest area A at distance r of its closest point on another cell: energy A/2 phi(r), force A/2 f(r) along the
/// connecting line, the reaction shared by the corners of the triangle that the point lies on. With rest areas this is the
/// exact gradient of the energy, with neither net force nor net torque (InteractionForces, in two dimensions).
class SurfaceInteractions {
 public:
  /// Throws std::invalid_argument for potentials that remember or want velocities, which surfaces do not have.
  SurfaceInteractions(const Surfaces& surfaces, std::vector<Interaction> interactions, const Domain<3>& domain);

  /// Pass over cells: phases 0, 1, 2 with a barrier after each. Adds to the forces; the sums do not depend on the workers.
  void run(Worker worker, int phase, Surfaces& surfaces);

  /// With other ranks: InteractionForces.
  [[nodiscard]] DisplacementWatch& watch() { return contacts_.watch(); }
  [[nodiscard]] double reach() const { return list_reach(contacts_.cutoffs()); }
  [[nodiscard]] bool needs_velocities() const { return false; }
  /// What one cell does to a node of another.
  struct Reaction {
    int cell, node;  ///< `node` of Surfaces belongs to `cell`
    Vec<3> force;
  };
  /// After phase 1: what a cell does to others; of another rank's cell that is to be put there before phase 2.
  [[nodiscard]] std::vector<Reaction>& reactions(int cell) { return reactions_[cell]; }

  /// Energy of the contacts at the present positions, for which run() has made the lists, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Surfaces& surfaces, const Ranks<3>& ranks = {}) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;
  [[nodiscard]] const SurfaceContacts& contacts() const { return contacts_; }

 private:
  struct Scratch {
    std::vector<SurfaceContact> contacts;
    std::vector<double> result;         // of each contact: sum over the potentials
    std::vector<double> distance, law;  // of one potential's contacts
    std::vector<int> contact;           // which those are
  };
  /// Sets scratch.result to the sum of the potentials' forces, or energies, at the contacts of a cell.
  void evaluate(int cell, const Surfaces& surfaces, bool energy, Scratch& scratch) const;
  void act(int cell, Surfaces& surfaces, const Scratch& scratch);

  std::vector<Interaction> interactions_;
  std::vector<double> cutoffs_;
  SurfaceContacts contacts_;
  std::vector<Scratch> scratch_;                  // of the workers, each at the place of its first cell
  std::vector<std::vector<Reaction>> reactions_;  // of each cell's contacts, in their order
};

}  // namespace rouleau::core
