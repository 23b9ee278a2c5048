// Forces between cells, and within one: potentials integrated over facing membranes, with the reaction on the other
// side.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "contacts_of.hpp"
#include "core/domain/ranks.hpp"
#include "cutoffs.hpp"

namespace rouleau::core {

/// Node i with rest measure w (in two dimensions a length, in three an area) at distance r of its closest point on
/// another cell: energy w/2 phi(r), force w/2 f(r) along the connecting line, the reaction shared by the ends of the
/// segment, or the corners of the triangle, that the point lies on. With measures at rest this is the exact gradient of
/// the energy, with neither net force nor net torque (Derjaguin; docs: physics, interaction). Within a cell the closest
/// point is one on those parts of its membrane that the node may touch (SelfContacts, SelfReach), for the largest
/// cutoff of the cell's type; these potentials depend on the distance alone.
template <int D>
class Interactions {
 public:
  using Cells = typename ContactsOf<D>::Cells;
  using Reactions = typename ContactsOf<D>::Reactions;

  /// Adds what potentials remember to `cells.contacts`, as far as it is not there from an earlier stage. Throws
  /// std::invalid_argument within a cell for potentials that remember or read a velocity, and in three dimensions for
  /// those that read a tangential velocity, which has no sign there.
  Interactions(Cells& cells, std::vector<Interaction> between_cells, const Domain<D>& domain,
               const std::vector<SelfInteraction>& within_cells = {});

  static constexpr int phases = 3;
  /// Pass over cells: phases 0, 1, 2 with a barrier after each. Adds to the forces and advances the state of the
  /// contacts by one step; the sums do not depend on the workers.
  void run(Worker worker, int phase, Cells& cells);
  /// Between steps, with other ranks: whether lists of cells that are near each other are out of date
  /// (DisplacementWatch).
  [[nodiscard]] DisplacementWatch& watch() { return contacts_.watch(); }
  /// Before a step: so many after the setup's start.
  void set_time(double time) {
    for (ContactLaw& law : laws_) law.set_time(time);
  }
  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Cells& cells, std::span<const Range> nodes);
  /// Whether potentials want to know velocities.
  [[nodiscard]] bool needs_velocities() const { return needs_velocities_; }

  /// In two dimensions after phase 1, calls function(other, x, y, count) for each pair of a cell: where the reactions
  /// of its contacts on consecutive nodes of `other` stand, of another rank's cell those that are to be put there
  /// before phase 2.
  template <class Function>
  void for_reactions(int cell, Function function) {
    for (const NeighbourList::Pair& pair : contacts_.neighbours().list(cell).pairs) {
      const auto count = static_cast<std::size_t>(pair.touched.end - pair.touched.begin);
      function(pair.other, reactions_[cell].x.data() + pair.reaction, reactions_[cell].y.data() + pair.reaction, count);
    }
  }
  /// After phase 1: what a cell does to others; of another rank's cell that is to be put there before phase 2.
  [[nodiscard]] Reactions& reactions(int cell) { return reactions_[cell]; }

  /// After phase 1: over a cell's contacts the sum of the force on its nodes times the periods by which the other's
  /// image is shifted: along x times those along y, then along x, y and z each times its own.
  [[nodiscard]] const std::array<double, 4>& force_across_images(int cell) const { return across_images_[cell]; }

  /// Energy of the contacts at the present positions, for which run() has made the lists, in their present state, of
  /// all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Cells& cells, const Ranks<D>& ranks = {}) const;
  /// The same of each pair of different cells, or of a cell and its image, from each side: of this rank's cells.
  [[nodiscard]] std::vector<PairEnergy> pair_energies(const Cells& cells) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;
  [[nodiscard]] const typename ContactsOf<D>::Finder& contacts() const { return contacts_; }

 private:
  using List = typename ContactsOf<D>::List;
  /// The contacts of the cell that a worker is at, and what is computed of them.
  struct Scratch {
    List contacts;
    std::vector<double> result;       // of each contact: sum over the potentials
    std::vector<int> chosen;          // contacts that a potential acts at
    ContactValues values;             // at these
    std::vector<double> law;          // of one potential at these
    std::vector<ContactState> state;  // of the cell's contacts after the step
  };
  /// Finds a cell's contacts, and measures what potentials need of them besides the distance; returns how many.
  int find(int cell, const Cells& cells, Scratch& scratch) const;
  /// The contacts that a potential acts at: where they stand in one piece and need no key, or chosen with their keys.
  Range choose(std::size_t law, int cell, const Cells& cells, Scratch& scratch) const;
  /// Sets scratch.result to the sum of the potentials' forces, or energies, at the contacts of a cell. `next`: as
  /// ContactLaw has it.
  void evaluate(int cell, const Cells& cells, bool energy, std::vector<ContactState>* next, Scratch& scratch) const;
  void make_room_for_reactions(int cell);
  /// Forces on the cell's own nodes; those on others are left for their workers.
  void act(int cell, Cells& cells, const Scratch& scratch);
  void take_reactions(Worker worker, Cells& cells);

  std::size_t between_cells_;  // so many are that; the others act within one
  std::vector<Interaction> interactions_;
  std::vector<ContactLaw> laws_;  // of these
  bool remembers_ = false, needs_velocities_ = false;
  typename ContactsOf<D>::Finder contacts_;
  WorkerScratch<Scratch> scratch_;
  std::vector<Reactions> reactions_;                  // of each cell's contacts
  std::vector<std::array<double, 4>> across_images_;  // of each cell
};

}  // namespace rouleau::core
