// Forces between cells in three dimensions: potentials integrated over facing surfaces, with the reaction on the other cell.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/surface/surfaces.hpp"
#include "interaction_forces.hpp"
#include "self_contacts.hpp"
#include "surface_contacts.hpp"
#include "surface_law.hpp"

namespace rouleau::core {

/// Node i with rest area A at distance r of its closest point on another cell: energy A/2 phi(r), force A/2 f(r) along the
/// connecting line, the reaction shared by the corners of the triangle that the point lies on. With rest areas this is the
/// exact gradient of the energy, with neither net force nor net torque (InteractionForces, in two dimensions). Within a cell the
/// closest point is one on the parts of its surface that the node may touch (SelfReach), for the largest cutoff of the cell's
/// type; these potentials depend on the distance alone (SelfContacts, in two dimensions).
class SurfaceInteractions {
 public:
  /// Adds what potentials remember to `surfaces.contacts`, as far as it is not there from an earlier stage. Throws
  /// std::invalid_argument for potentials that read a tangential velocity, and within a cell for those that remember or read a
  /// velocity.
  SurfaceInteractions(Surfaces& surfaces, std::vector<Interaction> interactions, const Domain<3>& domain,
                      std::vector<SelfInteraction> within_cells = {});

  /// Pass over cells: phases 0, 1, 2 with a barrier after each. Adds to the forces and advances the state of the contacts by
  /// one step; the sums do not depend on the workers.
  void run(Worker worker, int phase, Surfaces& surfaces);

  /// With other ranks: InteractionForces.
  [[nodiscard]] DisplacementWatch& watch() { return contacts_.watch(); }
  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Surfaces& surfaces, std::span<const Range> nodes);
  [[nodiscard]] bool needs_velocities() const { return needs_velocities_; }
  /// What one cell does to a node of another.
  struct Reaction {
    int cell, node;  ///< `node` of Surfaces belongs to `cell`
    Vec<3> force;
  };
  /// After phase 1: what a cell does to others; of another rank's cell that is to be put there before phase 2.
  [[nodiscard]] std::vector<Reaction>& reactions(int cell) { return reactions_[cell]; }

  /// After phase 1: over a cell's contacts the sum of the force along x on its nodes, times the periods along y by which the
  /// other's image is shifted.
  [[nodiscard]] double force_across_images(int cell) const { return across_images_[cell]; }

  /// Energy of the contacts at the present positions, for which run() has made the lists, in their present state, of all
  /// ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Surfaces& surfaces, const Ranks<3>& ranks = {}) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;
  [[nodiscard]] const SurfaceContacts& contacts() const { return contacts_; }

 private:
  struct Scratch {
    std::vector<SurfaceContact> contacts;
    std::vector<double> result;       // of each contact: sum over the potentials
    SurfaceLawInputs inputs;          // of one potential's contacts
    std::vector<double> law;          // of these
    std::vector<int> contact;         // which those are
    std::vector<ContactState> state;  // of the cell's contacts after the step
  };
  /// Sets scratch.result to the sum of the potentials' forces, or energies, at the contacts of a cell. `next`: as SurfaceLaw
  /// has it.
  void evaluate(int cell, const Surfaces& surfaces, bool energy, std::vector<ContactState>* next,
                Scratch& scratch) const;
  void act(int cell, Surfaces& surfaces, const Scratch& scratch);
  [[nodiscard]] bool acts_at(std::size_t interaction, const SurfaceContact& contact, int cell,
                             const Surfaces& surfaces) const;

  std::size_t between_cells_;  // so many are that; the others act within one
  std::vector<Interaction> interactions_;
  std::vector<SurfaceLaw> laws_;  // of these
  bool remembers_ = false, needs_velocities_ = false;
  SurfaceContacts contacts_;
  WorkerScratch<Scratch> scratch_;
  std::vector<std::vector<Reaction>> reactions_;  // of each cell's contacts, in their order
  std::vector<double> across_images_;             // of each cell
};

}  // namespace rouleau::core
