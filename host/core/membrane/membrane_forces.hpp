// Forces of the membrane laws on the nodes: minus the gradient of the laws' energies.
#pragma once

#include <optional>
#include <vector>

#include "base/worker.hpp"
#include "core/model/model.hpp"
#include "membrane_energy.hpp"
#include "membranes.hpp"
#include "node_mobility.hpp"
#include "semi_implicit_filter.hpp"
#include "tension_rate.hpp"

namespace rouleau::core {

/// Laws of one cell type; they add up.
using MembraneLaws = std::vector<MembraneLaw>;

/// How a step treats membranes.
struct MembraneForcesSetup {
  /// Of each cell type.
  std::vector<MembraneLaws> laws = {};
  /// What the slip correction adds, of each cell type; empty: no correction.
  std::vector<NodeMobility> mobility = {};
  KernelResponse response = {};
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

  /// Energies at the present positions and state, of all ranks' cells. Not a pass: one thread, no other in run().
  [[nodiscard]] MembraneEnergy energies(const Membranes& membranes, const Ranks<2>& ranks = {});
  [[nodiscard]] double energy(const Membranes& membranes) { return energies(membranes).total(); }

  /// The tension of every segment of a cell, all laws together, at the present positions and state. Not a pass either.
  [[nodiscard]] std::vector<double> tensions(const Membranes& membranes, int cell);

 private:
  /// What the table of one law is asked for in every step; looked up in its manifest once.
  struct Law {
    MembraneLaw model;
    bool stretch, stretch_rate, curvature, rest_curvature, area, rest_area, perimeter, rest_perimeter;  // its inputs
    bool tension, moment, pressure, perimeter_tension, energy, tension_by_rate;                         // its outputs
    std::vector<std::size_t> state;  // in Membranes::state, once kept
  };
  /// Values of the nodes or segments of one cell, with room on both sides for ghost nodes and packs that run over the
  /// end.
  class Padded {
   public:
    explicit Padded(int count = 0) : count_(count), values_(static_cast<std::size_t>(count + 3 * margin), 0.0) {}
    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] double* data() { return values_.data() + margin; }
    [[nodiscard]] const double* data() const { return values_.data() + margin; }
    double& operator[](int k) { return data()[k]; }
    double operator[](int k) const { return data()[k]; }

   private:
    static constexpr int margin = 8;  ///< doubles in the widest pack
    int count_;
    std::vector<double> values_;
  };
  struct Type {
    std::vector<Law> laws;
    Padded inverse_length, inverse_weight, curvature;                  // at rest
    bool rate = false, tension = false, moment = false, cell = false;  // what the laws need or give, all together
    bool tension_by_rate = false;
    std::size_t rate_tension = 0;  // in Membranes::state, if there is a tension by rate
    NodeMobility mobility;
    KernelResponse response;
    std::optional<SemiImplicitFilter> filter;  // of a semi-implicit step
    std::size_t held_force[2] = {0, 0};        // of the filter, x and y: in Membranes::state
  };
  /// One worker's arrays, for one cell after another.
  struct Scratch {
    explicit Scratch(int count = 0);
    Padded x, y, u, v;
    Padded tangent_x, tangent_y, inverse_length, stretch, rate, curvature;
    Padded tension, moment, law, energy;  // sums; one law's contribution and its energy
    Padded segment_force_x, segment_force_y;
    Padded by_rate, law_by_rate;  // d tension / d rate: sum, one law's
  };
  struct CellState {
    double area = 0, perimeter = 0, pressure = 0, perimeter_tension = 0;
  };

  static Law describe(const MembraneLaw& model);
  void make_filters(const Membranes& membranes, double viscosity);
  void keep_state(Membranes& membranes, double tension_unit);
  /// The arrays of the worker whose first cell this is.
  Scratch& scratch_of(int first_cell);
  // `ahead`: where the nodes will be after another step like the last one.
  void measure(const Membranes& membranes, int cell, Scratch& scratch, bool ahead) const;
  // `next`: where the state after the step goes; null: someone looks, and there is no step.
  CellState apply_laws(const Membranes& membranes, int cell, Scratch& scratch, std::vector<ElementState>* next,
                       MembraneEnergy* energy) const;
  void apply_law(const Law& law, const Membranes& membranes, int cell, Scratch& scratch,
                 std::vector<ElementState>* next, CellState& sums, bool first_tension, bool first_moment,
                 double* energy) const;
  void give_inputs(const Law& law, const CellRange& range, const Scratch& scratch, const CellState& sums,
                   rouleau_membrane_block& block) const;
  void add_energy(const Law& law, const Membranes& membranes, int cell, const Scratch& scratch, const CellState& sums,
                  const double* tension, MembraneEnergy& energy) const;
  // Of one law in one cell, from the values per rest length or per cell.
  static double integrated(const Law& law, const RestShape& rest, const double* energy);
  // What a law's energy will be after a step in which nothing moves.
  double relaxed_energy(const Law& law, const Membranes& membranes, int cell, const Scratch& scratch,
                        const CellState& sums) const;
  void add_rate_tension(const Membranes& membranes, int cell, Scratch& scratch, std::vector<ElementState>* next) const;
  void act(Membranes& membranes, int cell, Scratch& scratch, const CellState& state) const;
  void soften(Membranes& membranes, int cell) const;

  std::vector<Type> types_;
  int most_nodes_ = 0;  // of a cell
  WorkerScratch<Scratch> scratch_;
};

}  // namespace rouleau::core
