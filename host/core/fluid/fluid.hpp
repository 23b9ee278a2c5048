// The fluid of one stage: its lattice, what acts on it, and one step of collision and streaming.
#pragma once

#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/domain/halo.hpp"
#include "core/model/model.hpp"
#include "field.hpp"
#include "lattice.hpp"
#include "node_mask.hpp"
#include "periodic.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// What a fluid is made of. Lattice units.
struct FluidSetting {
  Domain<2> domain;        ///< periodic along x
  double relaxation_rate;  ///< 1/tau of the suspending fluid
  /// Viscosity of each row of the lattice over that of `relaxation_rate` (layers.hpp); empty: 1 everywhere.
  std::vector<double> viscosity_of_rows = {};
  bool inertia = false;  ///< initial states include the quadratic terms of the equilibrium
  WallVelocity walls = {};
  double body_force_x = 0, body_force_y = 0;  ///< force density everywhere
  bool membranes = false;                     ///< keep force and velocity where nodes are active
  bool viscosity_contrast = false;            ///< keep a relaxation rate where nodes are active
};

/// Moments of one node before collision.
struct Moments {
  double density;  ///< deviation from 1
  double ux, uy;   ///< with half the force
};

template <class T>
class Fluid {
 public:
  /// `ranks`: who holds the other blocks, if the domain's block is not the whole lattice; used as long as the fluid lives.
  Fluid(const FluidSetting& setting, CollisionOperator collision, const Ranks<2>& ranks = {});

  [[nodiscard]] const FluidSetting& setting() const { return setting_; }
  [[nodiscard]] const Ranks<2>& ranks() const { return ranks_; }
  /// All rows of the block.
  [[nodiscard]] Range rows() const { return {0, ny()}; }
  [[nodiscard]] NodeMask& mask() { return mask_; }
  /// Force density: what the next step() acts with. It writes velocity() over it, in the same memory.
  [[nodiscard]] VectorField<T, 2>& force() { return force_; }
  /// Velocity in active nodes, halo included: what the last step() has left.
  [[nodiscard]] const VectorField<T, 2>& velocity() const { return force_; }
  [[nodiscard]] Field<T, 2>& relaxation_rate() { return relaxation_rate_; }
  [[nodiscard]] std::size_t bytes() const;

  /// Sets velocity u(y) with shear rate du/dy along x everywhere, density 1 (equilibrium and first-order part).
  void set_profile(const std::function<double(double y)>& velocity, const std::function<double(double y)>& shear_rate);
  /// General initial state by node of the lattice: deviation of density, velocity and its gradient {du/dx, du/dy, dv/dx, dv/dy} at a node.
  struct State {
    double density, ux, uy, gradient[4];
  };
  void set_state(const std::function<State(int x, int y)>& state);
  /// Takes over another fluid's state with velocities and density deviation times `factor`: what a stage with another
  /// time step does. Without inertia this scales every population; with it, equilibrium and the rest scale each by its
  /// rule.
  void take_over(Fluid& other, double factor);

  /// Without inertia: the unsteady term is du/dt as seen from a frame that moves at this velocity (moving_frame.hpp). Of
  /// the next steps and of states that are set; 0 to begin with.
  void set_frame(double ux, double uy) { frame_[0] = ux, frame_[1] = uy; }
  /// What drives the next steps, where that changes with time: the speeds of the walls during a step, and the force
  /// along x at its beginning. One worker, between steps.
  void set_drive(const WallVelocity& walls, double body_force_x);
  /// Speeds of the walls during the last step, and now; setting() has those of the next step.
  [[nodiscard]] const WallVelocity& last_walls() const { return last_walls_; }
  [[nodiscard]] WallVelocity walls_now() const {
    return {(last_walls_.lower + setting_.walls.lower) / 2, (last_walls_.upper + setting_.walls.upper) / 2};
  }

  // Passes over rows of the block, in the order of a step.
  /// Sets the force in active nodes to the body force.
  void clear_force(Range rows);
  /// Collision and streaming; leaves the velocity of active nodes in force(), halo included.
  void step(Range rows);
  /// In which order step() takes rows, and bands of rows are best taken: what the last step has touched last is still
  /// in the cache.
  [[nodiscard]] bool sweeps_up() const { return parity_ == Parity::even; }
  /// Ends the step, once all rows have been stepped.
  void end_step() {
    parity_ = next(parity_);
    walls_have_acted_ = true;
    last_walls_ = setting_.walls;
  }
  /// One worker, after end_step(): sends what other blocks want of this step. Nothing without other blocks.
  void begin_halo();
  /// One worker, before the velocity is read or the next step is taken: takes what they have sent.
  void end_halo();

  // Observers; between steps, one thread. What is said of the whole lattice is the same on all ranks, and all must ask
  // for it together.
  /// Completes the halo so that moments() may be called.
  void settle();
  /// Moments of row y of the block, x = 0..nx-1, of the state before the next step. The force of that step must have
  /// been spread.
  void moments(int y, std::vector<Moments>& row) const;
  /// Of all nodes of the lattice, row after row, on the first rank; empty on the others.
  [[nodiscard]] std::vector<Moments> all_moments() const;
  [[nodiscard]] std::vector<double> all_relaxation_rates();
  /// Mean velocity along x of each row of the lattice.
  [[nodiscard]] std::vector<double> row_velocities() const;
  /// The same without the half step that the membranes' forces have still to act, and so before these are known; after
  /// settle(). All of them together have no share in the mean.
  [[nodiscard]] std::vector<double> row_velocities_without_membranes() const;
  /// Sum of density deviations over all nodes.
  [[nodiscard]] double mass() const;
  /// Mass and largest speed, as moments() would give them, in one sweep.
  struct MassAndSpeed {
    double mass, speed;  ///< not a number if any density or velocity is none
  };
  [[nodiscard]] MassAndSpeed mass_and_speed() const;
  /// Mean shear stress that the fluid has exerted on the lower and the upper wall in the last step, along +x, by momentum
  /// exchange. NaN
  /// between the start of a fluid at rest (or taken over) and its first step: walls that have just begun to move have
  /// exchanged nothing yet.
  struct WallStress {
    double lower, upper;
  };
  [[nodiscard]] WallStress wall_stress() const;
  /// What of the fluid's energy there is and what becomes of it, summed over all nodes; state as in moments().
  struct Energetics {
    double kinetic;                 ///< u^2/2, density 1
    double dissipation;             ///< what viscosity takes in a step, see energetics.cpp
    double velocity_x, velocity_y;  ///< sums of u
    double membrane_power;          ///< of the forces beside the body force, f . u
  };
  [[nodiscard]] Energetics energetics() const;
  /// Populations before the next collision, for tests.
  [[nodiscard]] double population(int q, int x, int y) const;
  /// The block's populations of one velocity before the next collision, row after row, for checkpoints. After settle().
  void copy_populations(int q, std::vector<T>& values) const;
  /// Whether the walls have exchanged momentum with this state of the fluid (WallStress).
  [[nodiscard]] bool walls_have_acted() const { return walls_have_acted_; }
  /// Goes on from what copy_populations() gave: `populations(q)` returns it for every q.
  void restore(const std::function<std::vector<T>(int q)>& populations, bool walls_have_acted);

 private:
  /// Velocities of row y, x in [0, nx), and where the block wraps around in [-1, nx].
  void velocities(int y, double* ux, double* uy) const;
  /// Nodes of the block along x, and its rows.
  [[nodiscard]] int nx() const { return setting_.domain.block.size(0); }
  [[nodiscard]] int ny() const { return setting_.domain.block.size(1); }
  /// 1/tau of the fluid in a row of the block, cells aside.
  [[nodiscard]] double rate_of_row(int y) const {
    return setting_.viscosity_of_rows.empty() ? setting_.relaxation_rate : rate_of_row_[y];
  }
  [[nodiscard]] bool in_layer(int y) const { return rate_of_row(y) != setting_.relaxation_rate; }
  [[nodiscard]] double equilibrium(int q, double density, double ux, double uy) const;
  /// Whether membranes may reach the halo that belongs to row y.
  [[nodiscard]] bool reaches_border(int y) const;
  /// Pointers to the populations of row y, as Lattice::row_pointers gives them; they come back unchanged.
  void collide_row(int y, const T* (&in)[9], T* (&out)[9]);
  void add_moving_frame(int y, T* (&out)[9]);

  void make_halos();
  template <class Function>
  void with_arrays(Function function);

  using Block = std::conditional_t<std::is_same_v<T, double>, rouleau_collision_block_f64, rouleau_collision_block_f32>;
  FluidSetting setting_;
  Ranks<2> ranks_;
  CollisionOperator collision_;
  void (*collide_)(const void* self, const Block* block);  ///< of the collision model
  Lattice<T, D2Q9> lattice_;
  Parity parity_ = Parity::even;
  bool walls_have_acted_ = false;
  WallVelocity last_walls_;
  double frame_[2] = {0, 0};
  NodeMask mask_;
  VectorField<T, 2> force_;
  Field<T, 2> relaxation_rate_;
  std::vector<double> rate_of_row_;                              ///< of the block; empty without layers
  std::unique_ptr<Halo<T, 2>> population_halo_, velocity_halo_;  ///< null without other blocks
  std::unique_ptr<Halo<double, 2>> energetics_halo_;             ///< of velocities, one node deep
  std::vector<T> body_force_row_[2];                             ///< constant; empty without a body force
};

extern template class Fluid<float>;
extern template class Fluid<double>;

}  // namespace rouleau::core
