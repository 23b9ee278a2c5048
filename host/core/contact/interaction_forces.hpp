// Forces between cells: potentials integrated over facing membranes, with the reaction on the other cell.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/worker.hpp"
#include "contact.hpp"
#include "contact_velocity.hpp"
#include "core/domain/images.hpp"
#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// A potential between cells of two types (unordered; equal: between different cells of one type and own images).
struct Interaction {
  std::array<int, 2> between;
  Potential potential;
};

/// Of the potentials, as their plugins say.
std::vector<double> cutoffs_of(const std::vector<Interaction>& interactions);
/// Cells do not act on each other from further away, with lists that are as old as they may be; 0: they do not at all.
double contact_reach(const std::vector<Interaction>& interactions);
/// The largest of them for each pair of types.
Cutoffs pair_cutoffs(const CellNodes& cells, const std::vector<Interaction>& interactions,
                     const std::vector<double>& cutoffs);
bool acts_between(const Interaction& interaction, int type, int other_type);

/// Node i with rest weight Lb at distance r of its closest point on another cell: energy Lb/2 phi(r), force Lb/2 f(r)
/// along the connecting line, the reaction shared by the ends of the other segment. With rest weights this is the exact
/// gradient of the energy, with neither net force nor net torque (Derjaguin; docs: physics, interaction).
class InteractionForces {
 public:
  /// Adds what potentials remember to `membranes.contacts`, as far as it is not there from an earlier stage.
  InteractionForces(Membranes& membranes, std::vector<Interaction> interactions, Domain<2> domain);

  static constexpr int phases = 3;
  /// Pass over cells: phases 0, 1, 2 with a barrier after each. Adds to force_x and force_y and advances the state of
  /// the contacts by one step.
  void run(Worker worker, int phase, Membranes& membranes);
  /// Between steps, with other ranks: whether lists of cells that are near each other are out of date (DisplacementWatch).
  [[nodiscard]] DisplacementWatch& watch() { return contacts_.neighbours().watch(); }
  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Membranes& membranes, std::span<const Range> nodes);
  /// Whether potentials want to know velocities.
  [[nodiscard]] bool needs_velocities() const { return needs_velocities_; }
  /// True if there is nothing to do: run() may be left out.
  [[nodiscard]] bool empty() const { return interactions_.empty(); }

  /// After phase 1, calls function(other, x, y, count) for each pair of a cell: where the reactions of its contacts on
  /// consecutive nodes of `other` stand, of another rank's cell those that are to be put there before phase 2.
  template <class Function>
  void for_reactions(int cell, Function function) {
    for (const NeighbourList::Pair& pair : contacts_.neighbours().list(cell).pairs) {
      const auto count = static_cast<std::size_t>(pair.touched.end - pair.touched.begin);
      function(pair.other, reactions_[cell].x.data() + pair.reaction, reactions_[cell].y.data() + pair.reaction, count);
    }
  }

  /// After phase 1: over a cell's contacts the sum of the force along x on its nodes, times the periods along y by which the
  /// other's image is shifted.
  [[nodiscard]] double force_across_images(int cell) const { return across_images_[cell]; }

  /// Energy of the contacts found by the last run() in their present state, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Membranes& membranes, const Ranks<2>& ranks = {}) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;
  [[nodiscard]] const Contacts& contacts() const { return contacts_; }

 private:
  /// The contacts of the cell that a worker is at, and what is computed of them.
  struct Scratch {
    ContactList contacts;
    std::vector<double> force;                        // sum of f over the potentials
    std::vector<double> law;                          // of one potential
    ContactVelocities velocities;                     // only if a potential needs them
    std::vector<double> distance;                     // those within a cutoff shorter than that of the pair
    std::vector<double> normal, tangential, sliding;  // velocities there
    std::vector<int> contact;                         // to which these belong
    std::vector<double> state, fresh;                 // of one pair's contacts, all variables; of the cell's nodes
  };
  /// On the nodes of other cells that a cell's pairs touch.
  struct Reactions {
    std::vector<double> x, y;
  };
  /// Consecutive contacts of a cell with all cells of one type.
  struct TypeRange {
    int type;
    Range contacts;
  };
  [[nodiscard]] TypeRange next_range(int cell, const std::vector<Range>& ranges, const Membranes& membranes,
                                     std::size_t& pair) const;
  /// Finds a cell's contacts and measures what the potentials need of them besides the distance.
  void find_contacts(int cell, const Membranes& membranes, Scratch& scratch) const;
  void compute_forces(int cell, Membranes& membranes, Scratch& scratch);
  void make_room_for_reactions(int cell);
  void apply(std::size_t potential, Range contacts, double* result, bool energy, bool first, Scratch& scratch) const;
  /// The same for a potential that remembers, at the contacts of one pair. `next`: takes the state after the step, and
  /// keeps the arrays of the pairs that still touch at its front; null: someone looks, and there is no step.
  struct NextState {
    std::vector<ContactState>& states;
    std::size_t kept = 0;
  };
  void apply_with_state(std::size_t potential, int cell, std::size_t pair, const Membranes& membranes, double* result,
                        bool energy, NextState* next, Scratch& scratch) const;
  /// Forces on the cell's own nodes; those on others are left for their workers.
  void act(int cell, Membranes& membranes, const Scratch& scratch);
  void take_reactions(int cell, Membranes& membranes) const;

  /// What a potential is given besides distances, and whether it has an energy; looked up in its manifest once.
  struct Traits {
    bool normal_velocity, tangential_velocity, sliding_speed, energy;
  };
  /// Sets the block's inputs to those of the contacts scratch.contact[0, count), at scratch.distance; `all`: to those
  /// of all contacts from `first` on.
  void give_velocities(std::size_t potential, int first, int count, bool all, Scratch& scratch,
                       rouleau_interaction_block& block) const;

  std::vector<Interaction> interactions_;
  std::vector<double> cutoffs_;  // of the potentials
  std::vector<Traits> traits_;   // of the potentials
  Contacts contacts_;
  WorkerScratch<Scratch> scratch_;
  std::vector<Reactions> reactions_;                 // of the cells
  std::vector<double> across_images_;                // of the cells
  std::vector<std::vector<std::size_t>> variables_;  // of the potentials, in ContactMemory::variables
  bool has_state_ = false, needs_velocities_ = false;
};

}  // namespace rouleau::core
