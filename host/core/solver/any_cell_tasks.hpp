// What a solver does with its cells, as who observes, stores or hands on its state sees it, whatever the precision of
// its populations.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/contact/interactions.hpp"
#include "core/contact/wall_contacts.hpp"
#include "core/fluid/walls.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/membrane/membrane_energy.hpp"
#include "external_forces.hpp"
#include "surroundings.hpp"

namespace rouleau::core {

/// Of one kind of interaction: between cells, with walls, of a cell with itself.
struct InteractionEnergy {
  double energy;               ///< lattice units, of all ranks' cells
  std::string without_energy;  ///< a potential that acts but tells no energy; empty: none
};

/// One worker, between steps or where the state may be observed; what is about all cells, all ranks together.
template <int D>
class AnyCellTasks {
 public:
  virtual ~AnyCellTasks() = default;

  /// Before ranks speak of something else than the next step does, which other workers may have begun: takes the
  /// messages of the last one.
  virtual void end_messages() = 0;
  /// On all ranks.
  [[nodiscard]] virtual Surroundings<D> surroundings() = 0;
  /// Which cells are whose; null without other ranks.
  [[nodiscard]] virtual const GhostCells<D>* ghosts() const = 0;
  /// The boxes of all cells, with which others can find their part in them.
  [[nodiscard]] virtual std::vector<BoundingBox<D>> boxes_of_all() = 0;
  /// Leaves the cells to a solver with another part in them, or of another setup, and what viscosities were made from.
  /// It is not to take another step.
  virtual DisplacementWatch::Memory pass_on(const GhostCells<D>& next) = 0;
  /// When viscosities were last renewed.
  [[nodiscard]] virtual const DisplacementWatch::Memory& viscosity_memory() const = 0;

  /// First node of this rank's that has left the domain; -1: none.
  [[nodiscard]] virtual int escaped_node() const = 0;
  /// Whether any rank's has.
  [[nodiscard]] virtual bool escaped() const = 0;
  /// Of this rank's cells the first one with a node beyond what closes the setup's region, which it looks for now.
  [[nodiscard]] virtual std::optional<BeyondWall> beyond_wall() const = 0;
  /// Of what is now spread, the share that acts on walls and not on the fluid.
  [[nodiscard]] virtual WallForces<D> wall_share() const = 0;
  /// Nodes move otherwise than the lattice's fluid at their places does.
  [[nodiscard]] virtual bool corrects_motion() const = 0;
  /// What it takes to stretch all membranes by 0.1 %: energies far below this are rounding.
  [[nodiscard]] virtual double slight_energy() const = 0;
  [[nodiscard]] virtual MembraneEnergy membrane_energy() = 0;
  /// Of the kinds of interactions that there are.
  [[nodiscard]] virtual std::vector<InteractionEnergy> interaction_energies() const = 0;
  /// Of this rank's cells, each with others; none without interactions between cells.
  [[nodiscard]] virtual std::vector<PairEnergy> pair_energies() const = 0;
  /// Of each segment, or triangle, of a cell of this rank's, all laws together.
  [[nodiscard]] virtual std::vector<double> tensions(int cell) = 0;
  /// What walls and the setup's external forces do to all cells; and of the latter alone their sum and power.
  [[nodiscard]] virtual std::array<double, 3> force_from_outside() const = 0;
  [[nodiscard]] virtual std::array<double, 4> external_sums() const = 0;
  /// Of a cell: InteractionForces::force_across_images.
  [[nodiscard]] virtual std::array<double, 4> force_across_images(int cell) const = 0;

 protected:
  /// Of these interactions, each null where there are none.
  template <class Cells, class... Interactions>
  static std::vector<InteractionEnergy> energies_of(const Cells& cells, const Ranks<D>& ranks,
                                                    const Interactions&... interactions) {
    std::vector<InteractionEnergy> energies;
    const auto add = [&](const auto& forces) {
      if (forces) energies.push_back({forces->energy(cells, ranks), forces->without_energy()});
    };
    (add(interactions), ...);
    return energies;
  }
};

}  // namespace rouleau::core
