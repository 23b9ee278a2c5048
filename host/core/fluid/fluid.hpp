// The fluid of one stage: its lattice, what acts on it, and one step of collision and streaming.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "any_fluid.hpp"
#include "base/worker.hpp"
#include "core/model/model.hpp"
#include "fluid_halo.hpp"
#include "fluid_state.hpp"
#include "walls.hpp"

namespace rouleau::core {

template <class T, class Set = D2Q9>
class Fluid final : public AnyFluid<Set::dimension> {
  using Any = AnyFluid<Set::dimension>;

 public:
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  using Row = typename Lattice<T, Set>::Row;
  using typename Any::NodeMoments;
  template <class V>
  using Take = typename Any::template Take<V>;

  /// `ranks`: who holds the other blocks, if the domain's block is not the whole lattice; used as long as the fluid
  /// lives.
  Fluid(const FluidSetting<dimension>& setting, CollisionOperator collision, const Ranks<dimension>& ranks = {});

  /// All rows of the block (Lattice::row).
  [[nodiscard]] Range rows() const { return {0, state_.lattice.rows()}; }
  [[nodiscard]] NodeMask& mask() { return state_.mask; }
  /// Force density: what the next step() acts with. It writes velocity() over it, in the same memory.
  [[nodiscard]] VectorField<T, dimension>& force() { return state_.force; }
  /// Velocity in active nodes, halo included: what the last step() has left.
  [[nodiscard]] const VectorField<T, dimension>& velocity() const { return state_.force; }
  [[nodiscard]] Field<T, dimension>& relaxation_rate() { return state_.relaxation_rate; }
  [[nodiscard]] std::size_t bytes() const { return state_.bytes(); }

  /// Sets velocity u(y) with shear rate du/dy along x everywhere, density 1 (equilibrium and first-order part).
  void set_profile(const std::function<double(double y)>& velocity, const std::function<double(double y)>& shear_rate);
  /// General initial state.
  using State = NodeState<dimension>;
  void set_state(const StateOfNode<dimension>& state);
  /// Everything at rest, under the body force, half of which is still to act (Moments::velocity). Where there is none
  /// this is the state that a fluid is made in.
  void set_rest();
  /// Takes over another fluid's state with velocities and density deviation times `factor`: what a stage with another
  /// time step does. Without inertia this scales every population; with it, equilibrium and the rest scale each by its
  /// rule. Where the body force changes the velocity does not, and the half of it that populations lack does.
  void take_over(Fluid& other, double factor);

  /// Without inertia: the unsteady term is du/dt as seen from a frame that moves at this velocity (moving_frame.hpp).
  /// Of the next steps and of states that are set; 0 to begin with.
  void set_frame(double ux, double uy) requires(dimension == 2) { state_.frame = {ux, uy}; }
  /// What drives the next steps, where that changes with time: the speeds of the walls during a step, and the force
  /// along x at its beginning. One worker, between steps.
  void set_drive(const WallVelocity& walls, double body_force_x);

  // Passes over rows of the block, in the order of a step.
  /// Sets the force in active nodes to the body force.
  void clear_force(Range rows);
  /// Between two steps: there are no cells, until what they do to the fluid is set again.
  void forget_cells() {
    state_.set_plain_rates();
    state_.mask.renew(0, state_.lattice.rows(), [](auto) {});
  }
  /// Collision and streaming; leaves the velocity of active nodes in force(), halo included.
  void step(Range rows);
  /// In which order step() takes rows, and bands of rows are best taken: what the last step has touched last is still
  /// in the cache.
  [[nodiscard]] bool sweeps_up() const { return state_.parity == Parity::even; }
  /// FluidState::fluid_below.
  [[nodiscard]] const std::vector<long>& fluid_below() const { return state_.fluid_below; }
  /// Ends the step, once all rows have been stepped.
  void end_step() {
    state_.parity = next(state_.parity);
    walls_have_acted_ = true;
    last_walls_ = setting_.walls;
  }
  /// Rows of which other blocks want something: when they have been stepped before the others, and none but them,
  /// begin_halo_of_ends() may be called. None without other blocks.
  [[nodiscard]] EndRows end_rows() const { return core::end_rows(setting_.domain, ranks_); }
  /// One worker, before end_step(): sends to other blocks, of whose borders these rows have all, what they want of this
  /// step.
  void begin_halo_of_ends() {
    if (halo_) halo_->begin_ends();
  }
  /// One worker, after end_step(): sends what other blocks still want of it. Nothing without other blocks.
  void begin_halo() {
    if (halo_) halo_->begin();
  }
  /// One worker, before the velocity is read or the next step is taken: takes what they have sent.
  void end_halo() {
    if (halo_) halo_->end();
  }

  // Observers (AnyFluid).
  void settle() override { state_.settle(); }
  /// Moments of row i of the block, x = 0..nx-1, of the state before the next step. The force of that step must have
  /// been spread.
  void moments(int i, std::vector<NodeMoments>& values) const;
  void gather_moments(const Bands<dimension>& bands, const Take<NodeMoments>& take) const override;
  void gather_relaxation_rates(const Bands<dimension>& bands, const Take<double>& take) const override;
  void gather_stresses(const Bands<dimension>& bands, const Take<Stress<dimension>>& take) const override;
  void gather_populations(int q, const Bands<dimension>& bands, const Take<double>& take) const override;
  void copy_populations(int q, std::vector<double>& values) const override;
  [[nodiscard]] int populations() const override { return velocity_count; }
  [[nodiscard]] bool single_precision() const override { return std::is_same_v<T, float>; }
  [[nodiscard]] FluidMeasures<dimension> measure(WantedMeasures wanted) const override;
  [[nodiscard]] std::array<EndFlow, 2> end_flows() const override;
  [[nodiscard]] std::array<std::vector<double>, 2> passed() const override;
  [[nodiscard]] LinkMemory link_memory() const override { return state_.link_memory(ranks_); }
  void recall_links(const LinkMemory& memory) override { state_.recall_links(memory); }
  /// Mean velocities of rows without the half step that the membranes' forces have still to act, and so before these
  /// are known; after settle(). All of them together have no share in the mean, but for what walls take of it.
  [[nodiscard]] std::vector<double> row_velocities_without_membranes() const;
  [[nodiscard]] WallForces<dimension> wall_forces() const override;
  /// Populations before the next collision, for tests.
  [[nodiscard]] double population(int q, int x, const Row& row) const;
  [[nodiscard]] double population(int q, int x, int y) const requires(dimension == 2) {
    return population(q, x, Row{y});
  }
  /// Goes on from what copy_populations() or gather_populations() gave: `populations(q)` returns the block's for every
  /// q.
  void restore(const std::function<std::vector<double>(int q)>& populations, bool walls_have_acted);

 private:
  [[nodiscard]] bool driven() const { return setting_.body_force != std::array<double, dimension>{}; }
  void fill_body_force_rows();
  /// Whether membranes may reach the halo that belongs to row i.
  [[nodiscard]] bool reaches_border(int i, const Row& row) const;
  using Block = std::conditional_t<std::is_same_v<T, double>, rouleau_collision_block_f64, rouleau_collision_block_f32>;
  using Pointers = typename FluidState<T, Set>::Pointers;
  /// What the collision operator is called with, piece after piece.
  struct Call {
    Pointers at;
    T* force[dimension];  ///< where nodes are active; the velocity is written over it
    const T* body_force[dimension];
    const T* const* background;  ///< the force elsewhere: `body_force`, or null
    Block block;
  };
  /// One of the pieces of `row`; `number`: among the lattice's, where these are not whole rows.
  void step_piece(const RowPiece& piece, std::size_t number, const Row& row, Call& call);
  /// The pointers come back unchanged.
  void collide(const RowPiece& piece, const Row& row, Call& call);
  /// Asks for what collide() will read of row i, when the call has the pointers of another one.
  void fetch_row(int i, const Call& call, const Row& from) const;
  /// Sets what membranes have spread to the solid nodes of row i to 0: their velocity.
  void rest_solid(int i, const Row& row);

  using Any::setting_, Any::ranks_, Any::walls_have_acted_, Any::last_walls_;
  CollisionOperator collision_;
  void (*collide_)(const void* self, const Block* block);  ///< of the collision model
  FluidState<T, Set> state_;
  std::unique_ptr<FluidHalo<T, Set>> halo_;               ///< null without other blocks
  std::array<std::vector<T>, dimension> body_force_row_;  ///< constant; empty without a body force
};

extern template class Fluid<float>;
extern template class Fluid<double>;
extern template class Fluid<float, D3Q19>;
extern template class Fluid<double, D3Q19>;

}  // namespace rouleau::core
