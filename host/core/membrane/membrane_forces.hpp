// Forces of the membrane laws on the nodes: minus the gradient of the laws' energies.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/model/model.hpp"
#include "membranes.hpp"
#include "node_mobility.hpp"
#include "semi_implicit_filter.hpp"
#include "tension_rate.hpp"

namespace rouleau::core {

/// Laws of one cell type; they add up.
using MembraneLaws = std::vector<MembraneLaw>;

/// Energies stored in the membranes, in lattice units.
struct MembraneEnergy {
  double tension = 0;  ///< laws of segments
  double bending = 0;  ///< laws of nodes
  double cell = 0;     ///< laws of whole cells
  /// Power that tensions by the rate of stretch take out of the motion, at the present velocities; and energy that laws
  /// with a state lose in a step without motion.
  double dissipation = 0;
  std::string unknown;  ///< a law that acts but tells no energy; empty: none
  [[nodiscard]] double total() const { return tension + bending + cell; }
};

/// How a step treats membranes.
struct MembraneForcesSetup {
  /// Of each cell type.
  std::vector<MembraneLaws> laws = {};
  /// What the slip correction adds, of each cell type; empty: no correction.
  std::vector<NodeMobility> mobility = {};
  /// The semi-implicit step of stiff membranes (SemiImplicitFilter), with the laws' own stiffness.
  bool semi_implicit = false;
  /// Kinematic, of the suspending fluid; lattice units. Only for the semi-implicit step.
  double viscosity = 1.0 / 6;
  /// SI size of the lattice unit of tension, for what is kept from one stage to the next.
  double tension_unit = 1;
};

/// Turns tensions, moments, pressures and perimeter tensions into nodal forces whose sum and torque vanish
/// (docs: physics, membranes). Only the inputs that some law of a type needs are computed.
class MembraneForces {
 public:
  /// Adds what the laws remember to `membranes.state`, as far as it is not there from an earlier stage.
  MembraneForces(Membranes& membranes, const MembraneForcesSetup& setup);

  /// Pass over cells: sets force_x and force_y and advances the state of the laws by one step. The stretch rate is that
  /// of velocity_x, velocity_y.
  void run(Worker worker, Membranes& membranes);

  /// Energies at the present positions and state. Not a pass: one thread, no other in run().
  [[nodiscard]] MembraneEnergy energies(const Membranes& membranes);
  [[nodiscard]] double energy(const Membranes& membranes) { return energies(membranes).total(); }

  /// Sets the tension of every segment, all laws together, at the present positions and state. Not a pass either.
  void tensions(const Membranes& membranes, std::vector<double>& tension);

 private:
  /// What the table of one law is asked for in every step; looked up in its manifest once.
  struct Law {
    MembraneLaw model;
    bool stretch, stretch_rate, curvature, rest_curvature, area, rest_area, perimeter, rest_perimeter;  // its inputs
    bool tension, moment, pressure, perimeter_tension, energy, tension_by_rate;                         // its outputs
    std::vector<std::size_t> state;  // in Membranes::state, once kept
  };
  static constexpr int pack_margin = 8;  ///< doubles in the widest pack
  /// Constants of cells that rest alike: from pack_margin on, with room on both sides for packs that run over the end.
  struct Rest {
    int cell;  ///< one of them
    std::vector<double> inverse_length, inverse_weight, curvature;
  };
  struct Type {
    std::vector<Law> laws;
    bool rate = false, tension = false, moment = false, cell = false;  // what the laws need or give, all together
    bool tension_by_rate = false;
    std::size_t rate_tension = 0;  // in Membranes::state, if there is a tension by rate
    NodeMobility mobility;
    std::optional<SemiImplicitFilter> filter;  // of a semi-implicit step
    std::size_t held_force[2] = {0, 0};        // of the filter, x and y: in Membranes::state
  };
  /// One cell's working arrays, with room for ghost nodes too. A worker uses those of its first cell for all its cells,
  /// one after the other, so that they stay in its cache: the room of all its cells is as large as any of them.
  struct Scratch {
    PagedArray<double> x, y, u, v;
    PagedArray<double> tangent_x, tangent_y, inverse_length, stretch, rate, curvature;
    PagedArray<double> tension, moment, law, energy;  // sums; one law's contribution and its energy
    PagedArray<double> segment_force_x, segment_force_y;
    PagedArray<double> by_rate, law_by_rate;  // d tension / d rate: sum, one law's; only if a law gives it
  };
  struct CellState {
    double area = 0, perimeter = 0, pressure = 0, perimeter_tension = 0;
  };

  static Law describe(const MembraneLaw& model);
  void allocate(const Membranes& membranes);
  void find_rests(const Membranes& membranes);
  void make_filters(const Membranes& membranes, double viscosity);
  void keep_state(Membranes& membranes, double tension_unit);
  [[nodiscard]] std::size_t offset(int cell) const { return offset_[cell]; }
  [[nodiscard]] const Rest& rest_of(int cell) const { return rests_[rest_of_[cell]]; }
  // `at`: where the working arrays begin.
  // `ahead`: where the nodes will be after another step like the last one.
  void measure(const Membranes& membranes, int cell, std::size_t at, bool ahead);
  // `next`: where the state after the step goes; null: someone looks, and there is no step.
  CellState apply_laws(const Membranes& membranes, int cell, std::size_t at, std::vector<ElementState>* next,
                       MembraneEnergy* energy);
  void apply_law(const Law& law, const Membranes& membranes, int cell, std::size_t at, std::vector<ElementState>* next,
                 CellState& sums, bool first_tension, bool first_moment, double* energy);
  void give_inputs(const Law& law, const CellRange& range, int cell, std::size_t at, const CellState& sums,
                   rouleau_membrane_block& block) const;
  void add_energy(const Law& law, const Membranes& membranes, int cell, std::size_t at, const CellState& sums,
                  const double* tension, MembraneEnergy& energy) const;
  // Of one law in one cell, from the values per rest length or per cell.
  static double integrated(const Law& law, const Membranes& membranes, const CellRange& range, const double* energy);
  // What a law's energy will be after a step in which nothing moves.
  double relaxed_energy(const Law& law, const Membranes& membranes, int cell, std::size_t at,
                        const CellState& sums) const;
  void add_rate_tension(const Membranes& membranes, int cell, std::size_t at, std::vector<ElementState>* next);
  void act(Membranes& membranes, int cell, std::size_t at, const CellState& state);
  void soften(Membranes& membranes, int cell) const;

  std::vector<Type> types_;
  std::vector<std::size_t> offset_;  // of each cell's node 0
  std::vector<Rest> rests_;
  std::vector<int> rest_of_;  // of each cell: which of these
  Scratch scratch_;
};

}  // namespace rouleau::core
