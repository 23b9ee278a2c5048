// The fluid of one stage: its lattice, what acts on it, and one step of collision and streaming.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "any_fluid.hpp"
#include "base/worker.hpp"
#include "core/domain/halo.hpp"
#include "core/model/model.hpp"
#include "edge_nodes.hpp"
#include "field.hpp"
#include "lattice.hpp"
#include "node_mask.hpp"
#include "periodic.hpp"
#include "solid_links.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// So many rows of a block, from its first one on and up to its last one.
struct EndRows {
  int below = 0, above = 0;
};

template <class T, class Set = D2Q9>
class Fluid final : public AnyFluid<Set::dimension> {
  using Any = AnyFluid<Set::dimension>;

 public:
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  using Row = typename Lattice<T, Set>::Row;
  using typename Any::NodeMoments, typename Any::MassAndSpeed, typename Any::Energetics;
  template <class V>
  using Take = typename Any::template Take<V>;

  /// `ranks`: who holds the other blocks, if the domain's block is not the whole lattice; used as long as the fluid lives.
  Fluid(const FluidSetting<dimension>& setting, CollisionOperator collision, const Ranks<dimension>& ranks = {});

  /// All rows of the block (Lattice::row).
  [[nodiscard]] Range rows() const { return {0, lattice_.rows()}; }
  [[nodiscard]] NodeMask& mask() { return mask_; }
  /// Force density: what the next step() acts with. It writes velocity() over it, in the same memory.
  [[nodiscard]] VectorField<T, dimension>& force() { return force_; }
  /// Velocity in active nodes, halo included: what the last step() has left.
  [[nodiscard]] const VectorField<T, dimension>& velocity() const { return force_; }
  [[nodiscard]] Field<T, dimension>& relaxation_rate() { return relaxation_rate_; }
  [[nodiscard]] std::size_t bytes() const;

  /// Sets velocity u(y) with shear rate du/dy along x everywhere, density 1 (equilibrium and first-order part).
  void set_profile(const std::function<double(double y)>& velocity, const std::function<double(double y)>& shear_rate);
  /// General initial state by node of the lattice: deviation of density, velocity and its gradient {du/dx, du/dy, ...,
  /// dv/dx, dv/dy, ...} at a node.
  struct State {
    double density, velocity[dimension], gradient[dimension * dimension];
  };
  using StateOfNode =
      std::conditional_t<dimension == 2, std::function<State(int x, int y)>, std::function<State(int x, int y, int z)>>;
  void set_state(const StateOfNode& state);
  /// Everything at rest, under the body force, half of which is still to act (Moments::velocity). Where there is none
  /// this is the state that a fluid is made in.
  void set_rest();
  /// Takes over another fluid's state with velocities and density deviation times `factor`: what a stage with another
  /// time step does. Without inertia this scales every population; with it, equilibrium and the rest scale each by its
  /// rule. Where the body force changes the velocity does not, and the half of it that populations lack does.
  void take_over(Fluid& other, double factor);

  /// Without inertia: the unsteady term is du/dt as seen from a frame that moves at this velocity (moving_frame.hpp). Of
  /// the next steps and of states that are set; 0 to begin with.
  void set_frame(double ux, double uy) requires(dimension == 2) { frame_[0] = ux, frame_[1] = uy; }
  /// What drives the next steps, where that changes with time: the speeds of the walls during a step, and the force
  /// along x at its beginning. One worker, between steps.
  void set_drive(const WallVelocity& walls, double body_force_x);

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
  /// Rows of which other blocks want something: when they have been stepped before the others, and none but them,
  /// begin_halo_of_ends() may be called. None without other blocks.
  [[nodiscard]] EndRows end_rows() const;
  /// One worker, before end_step(): sends to other blocks, of whose borders these rows have all, what they want of this step.
  void begin_halo_of_ends();
  /// One worker, after end_step(): sends what other blocks still want of it. Nothing without other blocks.
  void begin_halo();
  /// One worker, before the velocity is read or the next step is taken: takes what they have sent.
  void end_halo();

  // Observers (AnyFluid).
  void settle() override;
  /// Moments of row i of the block, x = 0..nx-1, of the state before the next step. The force of that step must have
  /// been spread.
  void moments(int i, std::vector<NodeMoments>& values) const;
  void gather_moments(const Bands<dimension>& bands, const Take<NodeMoments>& take) const override;
  void gather_relaxation_rates(const Bands<dimension>& bands, const Take<double>& take) const override;
  void gather_populations(int q, const Bands<dimension>& bands, const Take<double>& take) const override;
  void copy_populations(int q, std::vector<double>& values) const override;
  [[nodiscard]] int populations() const override { return velocity_count; }
  [[nodiscard]] bool single_precision() const override { return std::is_same_v<T, float>; }
  [[nodiscard]] std::vector<double> row_velocities() const override;
  /// The same without the half step that the membranes' forces have still to act, and so before these are known; after
  /// settle(). All of them together have no share in the mean, but for what walls take of it.
  [[nodiscard]] std::vector<double> row_velocities_without_membranes() const;
  [[nodiscard]] MassAndSpeed mass_and_speed() const override;
  [[nodiscard]] WallForces<dimension> wall_forces() const override;
  [[nodiscard]] Energetics energetics() const override;
  /// Populations before the next collision, for tests.
  [[nodiscard]] double population(int q, int x, const Row& row) const;
  [[nodiscard]] double population(int q, int x, int y) const requires(dimension == 2) {
    return population(q, x, Row{y});
  }
  /// Goes on from what copy_populations() or gather_populations() gave: `populations(q)` returns the block's for every q.
  void restore(const std::function<std::vector<double>(int q)>& populations, bool walls_have_acted);

 private:
  /// Moments, 1/tau and populations of row i of the block, x = 0..nx-1.
  void copy_moments(int i, NodeMoments* to) const;
  void copy_relaxation_rates(int i, double* to) const;
  void copy_population(int q, int i, double* to) const;
  /// Velocities of row i, x in [0, nx), and where the block wraps around in [-1, nx].
  void velocities(int i, const std::array<double*, dimension>& u) const;
  /// Nodes of the block along x.
  [[nodiscard]] int nx() const { return setting_.domain.block.size(0); }
  /// 1/tau of the fluid at a height of the block, cells aside.
  [[nodiscard]] double rate_of_row(const Row& row) const {
    return setting_.viscosity_of_rows.empty() ? setting_.relaxation_rate : rate_of_row_[row[0]];
  }
  [[nodiscard]] bool in_layer(const Row& row) const { return rate_of_row(row) != setting_.relaxation_rate; }
  [[nodiscard]] double equilibrium(int q, double density, const std::array<double, dimension>& u) const;
  [[nodiscard]] bool driven() const { return setting_.body_force != std::array<double, dimension>{}; }
  void fill_body_force_rows();
  /// Sums over all ranks, row by row of the lattice, of what `add(i, sum)` adds of row i of the block.
  template <class Function>
  [[nodiscard]] std::vector<double> means_of_rows(Function add) const;
  /// Whether membranes may reach the halo that belongs to row i.
  [[nodiscard]] bool reaches_border(int i, const Row& row) const;
  using Block = std::conditional_t<std::is_same_v<T, double>, rouleau_collision_block_f64, rouleau_collision_block_f32>;
  /// What the collision operator is called with, row after row.
  struct Call {
    const T* in[velocity_count];  ///< of a row, as Lattice::row_pointers gives them
    T* out[velocity_count];
    T* force[dimension];  ///< where nodes are active; the velocity is written over it
    const T* body_force[dimension];
    const T* const* background;  ///< the force elsewhere: `body_force`, or null
    Block block;
  };
  /// `in` and `out` are those of row i, and come back unchanged.
  void collide_row(int i, const Row& row, Call& call);
  /// Asks for what collide_row() will read of row i, when the call has the pointers of another one.
  void fetch_row(int i, const Call& call, const Row& from) const;
  /// Sets what membranes have spread to the solid nodes of row i to 0: their velocity.
  void rest_solid(int i, const Row& row);
  /// The populations have been set.
  void restart_links();
  void add_moving_frame(int i, const Row& row, T* (&out)[velocity_count]);

  void make_halos();
  [[nodiscard]] bool in_end_rows(int layer) const;
  template <class Function>
  void with_arrays(Parity parity, Function function);
  void send_halo(Parity parity, bool early);

  using Any::setting_, Any::ranks_, Any::walls_have_acted_, Any::last_walls_;
  CollisionOperator collision_;
  void (*collide_)(const void* self, const Block* block);  ///< of the collision model
  Lattice<T, Set> lattice_;
  Parity parity_ = Parity::even;
  std::array<double, dimension> frame_ = {};
  NodeMask mask_;
  std::unique_ptr<SolidLinks<T, Set>> links_;  ///< null without solid nodes
  VectorField<T, dimension> force_;
  Field<T, dimension> relaxation_rate_;
  std::vector<double> rate_of_row_;  ///< by height in the block; empty without layers
  std::unique_ptr<Halo<T, dimension>> population_halo_, velocity_halo_;  ///< null without other blocks
  std::unique_ptr<const EdgeNodes<dimension>> edge_nodes_;               ///< null without other blocks
  std::unique_ptr<Halo<double, dimension>> energetics_halo_;             ///< of velocities, between edge_nodes_
  bool ends_sent_ = false;                                               ///< of this step
  std::array<std::vector<T>, dimension> body_force_row_;                 ///< constant; empty without a body force
};

extern template class Fluid<float>;
extern template class Fluid<double>;
extern template class Fluid<float, D3Q19>;
extern template class Fluid<double, D3Q19>;

}  // namespace rouleau::core
