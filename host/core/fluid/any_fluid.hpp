// The fluid of a stage as who observes it sees it, whatever the precision of its populations.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/domain/bands.hpp"
#include "core/domain/domain.hpp"
#include "core/domain/ranks.hpp"
#include "openings/opening.hpp"
#include "solid_nodes.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// What a fluid is made of. Lattice units.
template <int D>
struct FluidSetting {
  Domain<D> domain;
  double relaxation_rate;  ///< 1/tau of the suspending fluid
  /// Viscosity at each height y of the lattice over that of `relaxation_rate` (viscosity_of_rows); empty: 1 all over.
  std::vector<double> viscosity_of_rows = {};
  bool inertia = false;  ///< initial states include the quadratic terms of the equilibrium
  WallVelocity walls = {};
  std::array<double, D> body_force = {};  ///< force density everywhere
  bool membranes = false;                 ///< keep force and velocity where nodes are active
  int stencil_above = 2;  ///< how far above the node below a membrane's own a stencil reaches; one less below it
  bool viscosity_contrast = false;  ///< keep a relaxation rate where nodes are active
  /// Walls of any shape; null: none. `wall_time`: of a step, in the unit of their velocities; 0: they rest.
  std::shared_ptr<const SolidNodes<D>> solid = {};
  double wall_time = 0;
  Openings openings = {};  ///< of a domain with an open axis
};

/// Numbers of each link to a solid node, by its place: of the node in the whole lattice, times the number of
/// velocities, plus the link's; and of each link through an opening, by -1 less that. Places rise.
struct LinkMemory {
  std::vector<double> place, left, away;  ///< SolidLinks::Link; of an opening's, `left` is OpenLinks::Link::passed
};

/// Moments of one node before collision.
template <int D>
struct Moments {
  double density;                  ///< deviation from 1
  std::array<double, D> velocity;  ///< with half the force
};

/// Viscous stress: xx, xy, yy; in three dimensions xx, xy, xz, yy, yz, zz.
template <int D>
using Stress = std::array<double, static_cast<std::size_t>(D*(D + 1) / 2)>;

/// What of the fluid's energy there is and what becomes of it, summed over all nodes; state as moments have it.
template <int D>
struct Energetics {
  double kinetic;                  ///< u^2/2, density 1
  double dissipation;              ///< what viscosity takes in a step, see energetics.cpp
  std::array<double, D> velocity;  ///< sums of u
  double membrane_power;           ///< of the forces beside the body force, f . u
  double wall_power;               ///< of walls of any shape
};

/// What is measured of the whole lattice in one sweep over the populations, and what of it is wanted.
struct WantedMeasures {
  bool energetics = false, row_velocities = false;
};
template <int D>
struct FluidMeasures {
  /// Sum of density deviations and largest speed, as moments would give them; not numbers if any density or velocity is
  /// none.
  double mass, speed;
  std::optional<Energetics<D>> energetics;  ///< if it was wanted
  /// Mean velocity along Domain::flow_axis of each row, as flow_rate() takes it, solid nodes counted as fluid at rest;
  /// empty if it was not wanted.
  std::vector<double> row_velocities;
};

/// Of D dimensions. One thread, between steps. What is said of the whole lattice is the same on all ranks, and all must
/// ask for it together.
template <int D>
class AnyFluid {
 public:
  using NodeMoments = Moments<D>;
  /// Called on the first rank with the values of one band of the lattice's nodes after another (gather_bands).
  template <class V>
  using Take = std::function<void(int b, const std::vector<V>& values)>;
  /// Mean shear stresses on the lower and the upper wall across y, along Domain::flow_axis; NaN with solid nodes.
  struct WallStress {
    double lower, upper;
  };

  virtual ~AnyFluid() = default;

  [[nodiscard]] const FluidSetting<D>& setting() const { return setting_; }
  [[nodiscard]] const Ranks<D>& ranks() const { return ranks_; }
  /// Speeds of the walls during the last step, and now; setting() has those of the next step.
  [[nodiscard]] const WallVelocity& last_walls() const { return last_walls_; }
  [[nodiscard]] WallVelocity walls_now() const {
    return {(last_walls_.lower + setting_.walls.lower) / 2, (last_walls_.upper + setting_.walls.upper) / 2};
  }
  /// What the last step left along the links to solid nodes, of all blocks: all ranks together, and all get the same.
  /// What comes back does not tell it, and walls of any shape get both.
  [[nodiscard]] virtual LinkMemory link_memory() const = 0;
  virtual void recall_links(const LinkMemory& memory) = 0;
  /// Whether the walls have exchanged momentum with this state of the fluid (wall_forces).
  [[nodiscard]] bool walls_have_acted() const { return walls_have_acted_; }

  /// Completes the halo so that what follows may be called.
  virtual void settle() = 0;
  /// Moments before the next step, whose force must have been spread; and 1/tau.
  virtual void gather_moments(const Bands<D>& bands, const Take<NodeMoments>& take) const = 0;
  virtual void gather_relaxation_rates(const Bands<D>& bands, const Take<double>& take) const = 0;
  /// Of a settled fluid; 0 in the solid.
  virtual void gather_stresses(const Bands<D>& bands, const Take<Stress<D>>& take) const = 0;
  /// Populations of one velocity before the next collision, exact, 0 in the solid.
  virtual void gather_populations(int q, const Bands<D>& bands, const Take<double>& take) const = 0;
  /// The same of the block, row after row.
  virtual void copy_populations(int q, std::vector<double>& values) const = 0;
  /// How many velocities there are; whether populations are of single precision.
  [[nodiscard]] virtual int populations() const = 0;
  [[nodiscard]] virtual bool single_precision() const = 0;
  /// Moments of all nodes of the lattice, row after row, on the first rank, which must have room for them; empty on the
  /// others.
  [[nodiscard]] std::vector<NodeMoments> all_moments() const {
    std::vector<NodeMoments> all;
    if (ranks_.first()) all.reserve(static_cast<std::size_t>(setting_.domain.nodes()));
    gather_moments(bands_of_all<D>(setting_.domain.size, sizeof(NodeMoments)),
                   [&](int, const std::vector<NodeMoments>& band) { all.insert(all.end(), band.begin(), band.end()); });
    return all;
  }
  /// Settled, with the next step's force spread.
  [[nodiscard]] virtual FluidMeasures<D> measure(WantedMeasures wanted) const = 0;
  [[nodiscard]] FluidMeasures<D> mass_and_speed() const { return measure(WantedMeasures{}); }
  /// Of the lower and the upper end of the open axis; settled, with the next step's force spread.
  [[nodiscard]] virtual std::array<EndFlow, 2> end_flows() const = 0;
  /// What all steps since this fluid began, on whatever blocks, have brought in through each opening of both ends
  /// (parts_of_section), less what left there: sums of populations, which are volumes at density 1. Where walls keep
  /// the mass, both ends together are what mass() has gained, but for rounding.
  [[nodiscard]] virtual std::array<std::vector<double>, 2> passed() const = 0;
  [[nodiscard]] double mass() const { return mass_and_speed().mass; }
  [[nodiscard]] Energetics<D> energetics() const { return *measure({.energetics = true}).energetics; }
  [[nodiscard]] std::vector<double> row_velocities() const { return measure({.row_velocities = true}).row_velocities; }
  /// What the fluid has done to the walls in the last step, by momentum exchange. What membranes beside a wall do to it
  /// is not in it: AnySolver::wall_forces(). NaN between the start of a fluid at rest (or taken over) and its first
  /// step: walls that have just begun to move have exchanged nothing yet.
  [[nodiscard]] virtual WallForces<D> wall_forces() const = 0;
  [[nodiscard]] WallStress wall_stress() const { return mean_wall_stress(wall_forces()); }
  [[nodiscard]] WallStress mean_wall_stress(const WallForces<D>& forces) const {
    if (setting_.solid) return {std::nan(""), std::nan("")};
    const double nodes = static_cast<double>(setting_.domain.nodes()) / setting_.domain.size[1];
    const int axis = setting_.domain.flow_axis();
    return {forces.lower[axis] / nodes, forces.upper[axis] / nodes};
  }

 protected:
  AnyFluid(const FluidSetting<D>& setting, const Ranks<D>& ranks)
      : setting_(setting), ranks_(ranks), last_walls_(setting.walls) {}

  FluidSetting<D> setting_;
  Ranks<D> ranks_;
  bool walls_have_acted_ = false;
  WallVelocity last_walls_;
};

}  // namespace rouleau::core
