#include "fluid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fluid_observers.hpp"
#include "periodic.hpp"

namespace rouleau::core {

template <class T, class Set>
Fluid<T, Set>::Fluid(const FluidSetting<dimension>& setting, CollisionOperator collision, const Ranks<dimension>& ranks)
    : Any(setting, ranks), collision_(std::move(collision)), state_(setting_) {
  if constexpr (std::is_same_v<T, double>)
    collide_ = collision_.table->collide_f64;
  else
    collide_ = collision_.table->collide_f32;
  if (driven()) fill_body_force_rows();
  if (ranks.several()) halo_ = std::make_unique<FluidHalo<T, Set>>(state_, ranks_);
}

template <class T, class Set>
inline bool Fluid<T, Set>::reaches_border(int i, const Row& row) const {
  constexpr int width = Field<T, dimension>::halo;
  if (state_.links) return state_.mask.marked(i);  // spans do not tell of solid nodes
  bool near = false;
  for (int k = 1; k < dimension; ++k) near = near || row[k - 1] < width || row[k - 1] >= state_.lattice.size(k) - width;
  return state_.mask.at_side(i) || (near && state_.mask.any(i));
}

template <class T, class Set>
void Fluid<T, Set>::fill_body_force_rows() {
  for (int k = 0; k < dimension; ++k)
    body_force_row_[k].assign(static_cast<std::size_t>(state_.nx()), static_cast<T>(setting_.body_force[k]));
}

template <class T, class Set>
void Fluid<T, Set>::set_drive(const WallVelocity& walls, double body_force_x) {
  setting_.walls = walls;
  if (body_force_x == setting_.body_force[0]) return;
  setting_.body_force[0] = body_force_x;
  fill_body_force_rows();
}

template <class T, class Set>
void Fluid<T, Set>::clear_force(Range rows) {
  const auto set = [](T* row, const MaskSpan& span, T value) {
    if (value == T(0))
      std::memset(row + span.begin, 0, sizeof(T) * static_cast<std::size_t>(span.end - span.begin));
    else
      std::fill(row + span.begin, row + span.end, value);
  };
  for (int i = rows.begin; i < rows.end; ++i) {
    state_.mask.for_spans(i, [&](const MaskSpan& span) {
      if (!span.active) return;
      const Row row = state_.lattice.row(i);
      for (int k = 0; k < dimension; ++k) set(state_.force[k].row(row), span, static_cast<T>(setting_.body_force[k]));
    });
  }
}

template <class T, class Set>
void Fluid<T, Set>::collide(const RowPiece& piece, const Row& row, Call& call) {
  const bool layer = state_.in_layer(row);
  int at = 0;  // where the pointers stand
  const auto move_to = [&](int x) {
    if (x == at) return;
    Set::for_each_velocity([&](auto q) { call.at.in[q] += x - at, call.at.out[q] += x - at; });
    at = x;
  };
  Block& block = call.block;
  state_.mask.for_spans(piece.row, [&](const MaskSpan& span) {
    if (span.begin < piece.begin || span.begin >= piece.end) return;
    move_to(span.begin);
    block.count = static_cast<std::uint32_t>(span.end - span.begin);
    const bool active = state_.has_force(span);
    if (active)
      for (int k = 0; k < dimension; ++k) call.force[k] = state_.force[k].row(row) + span.begin;
    block.force = active ? call.force : call.background;
    block.velocity = active ? call.force : nullptr;
    block.relaxation_rate =
        layer || (active && setting_.viscosity_contrast) ? state_.relaxation_rate.row(row) + span.begin : nullptr;
    call_foreign(collision_.id, "collide", [&] { collide_(collision_.self.get(), &block); });
  });
  move_to(0);
}

template <class T, class Set>
void Fluid<T, Set>::fetch_row(int i, const Call& call, const Row& from) const {
  const Row row = state_.lattice.row(i);
  state_.lattice.fetch_row(call.at.in, from, row);
  if (!setting_.membranes || !state_.mask.any(i)) return;
  for (const auto& component : state_.force) fetch(component.row(row), state_.nx());
}

template <class T, class Set>
void Fluid<T, Set>::rest_solid(int i, const Row& row) {
  if (!setting_.membranes || !state_.mask.marked(i)) return;
  state_.mask.for_solid(i, [&](int begin, int end) {
    for (auto& component : state_.force) std::fill(component.row(row) + begin, component.row(row) + end, T(0));
  });
}

template <class T, class Set>
void Fluid<T, Set>::step_piece(const RowPiece& piece, std::size_t number, const Row& row, Call& call) {
  const int i = piece.row;
  if (state_.openings) state_.openings->before_step(state_.parity, i);
  if (state_.links) state_.links->before_step(number, call.at.out);
  if (state_.openings) state_.openings->before_collision(i, call.at.in);
  collide(piece, row, call);
  if (state_.links) state_.links->after_step(number, call.at.out);
  if (state_.frame != std::array<double, dimension>{}) state_.add_moving_frame(piece, row, call.at.out);
  if (state_.openings) state_.openings->after_step(i, call.at.out);
}

template <class T, class Set>
void Fluid<T, Set>::step(Range rows) {
  const bool even = state_.parity == Parity::even;
  Call call;
  call.block = {};
  call.block.struct_size = sizeof(Block);
  call.block.in = call.at.in, call.block.out = call.at.out;
  for (int k = 0; k < dimension; ++k) call.body_force[k] = body_force_row_[k].data();
  call.background = body_force_row_[0].empty() ? nullptr : call.body_force;
  Row last{};
  const RowPieces<dimension>& pieces = state_.lattice.pieces();
  const bool fetches = state_.lattice.fetches_ahead();
  const int count = rows.end - rows.begin, first = even ? rows.begin : rows.end - 1, way = even ? 1 : -1;
  for (int k = 0; k < count; ++k) {
    const int i = first + way * k;
    if (state_.links && pieces.first_piece(i) == pieces.first_piece(i + 1) && !state_.mask.marked(i)) continue;
    const Row row = state_.lattice.row(i);
    if (even) receive_row(state_.lattice, row);
    state_.lattice.for_pieces(i, [&](const RowPiece& piece, std::size_t number) {
      if (k == 0 || state_.links)
        state_.lattice.row_pointers(state_.parity, row, piece.begin, call.at.in, call.at.out);
      else
        state_.lattice.next_row_pointers(state_.parity, last, row, call.at.in, call.at.out);
      if (fetches && state_.links) {  // the next piece lies beside this one
        const int size = piece.end - piece.begin;
        for (const T* const from : call.at.in) fetch(from + piece.begin + way * size, size);
      } else if (fetches && k + 1 < count) {
        fetch_row(i + way, call, row);
      }
      step_piece(piece, number, row, call);
    });
    last = row;
    if (state_.links) rest_solid(i, row);
    add_wall_momentum(state_.lattice, i, row, setting_.walls);
    if (even) send_row(state_.lattice, row);
    if (setting_.membranes && reaches_border(i, row))
      fill_velocity_halo<T, dimension>(state_.force, row, setting_.domain, setting_.walls);
  }
}

template <class T, class Set>
void Fluid<T, Set>::set_state(const StateOfNode<dimension>& state) {
  walls_have_acted_ = true;  // a state that is given is one that goes with these walls
  state_.set(state);
}

template <class T, class Set>
void Fluid<T, Set>::set_rest() {
  if (!driven()) return;
  set_profile([](double) { return 0.0; }, [](double) { return 0.0; });
  if (state_.links) state_.links->start_walls();
  walls_have_acted_ = false;
}

template <class T, class Set>
void Fluid<T, Set>::set_profile(const std::function<double(double)>& velocity,
                                const std::function<double(double)>& shear_rate) {
  const auto at = [&](int y) {
    State s{};
    s.velocity[0] = velocity(y);
    s.gradient[1] = shear_rate(y);
    return s;
  };
  if constexpr (dimension == 2)
    set_state([&](int, int y) { return at(y); });
  else
    set_state([&](int, int y, int) { return at(y); });
}

template <class T, class Set>
void Fluid<T, Set>::take_over(Fluid& other, double factor) {
  other.settle();
  state_.take_over(other.state_, factor);
}

template <class T, class Set>
void Fluid<T, Set>::restore(const std::function<std::vector<double>(int)>& populations, bool walls_have_acted) {
  walls_have_acted_ = walls_have_acted;
  last_walls_ = setting_.walls;
  state_.restore(populations);
}

template <class T, class Set>
double Fluid<T, Set>::population(int q, int x, const Row& row) const {
  if (!state_.lattice.holds(x, row)) return 0;
  Pointers at;
  state_.lattice.row_pointers(state_.parity, row, x, at.in, at.out);
  return static_cast<double>(at.in[q][x]);
}

template <class T, class Set>
void Fluid<T, Set>::moments(int i, std::vector<NodeMoments>& values) const {
  values.resize(static_cast<std::size_t>(state_.nx()));
  copy_moments(state_, i, values.data());
}

template <class T, class Set>
void Fluid<T, Set>::gather_moments(const Bands<dimension>& bands, const Take<NodeMoments>& take) const {
  gather_bands<NodeMoments>(
      ranks_, setting_.domain, bands, [&](int i, NodeMoments* to) { copy_moments(state_, i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::gather_relaxation_rates(const Bands<dimension>& bands, const Take<double>& take) const {
  gather_bands<double>(
      ranks_, setting_.domain, bands, [&](int i, double* to) { copy_relaxation_rates(state_, i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::gather_stresses(const Bands<dimension>& bands, const Take<Stress<dimension>>& take) const {
  gather_bands<Stress<dimension>>(
      ranks_, setting_.domain, bands, [&](int i, Stress<dimension>* to) { copy_stresses(state_, i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::gather_populations(int q, const Bands<dimension>& bands, const Take<double>& take) const {
  gather_bands<double>(
      ranks_, setting_.domain, bands, [&](int i, double* to) { copy_population(state_, q, i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::copy_populations(int q, std::vector<double>& values) const {
  const int nx = state_.nx(), rows = state_.lattice.rows();
  values.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(rows));
  for (int i = 0; i < rows; ++i) copy_population(state_, q, i, values.data() + static_cast<std::ptrdiff_t>(nx) * i);
}

template <class T, class Set>
auto Fluid<T, Set>::measure(WantedMeasures wanted) const -> FluidMeasures<dimension> {
  return core::measure(state_, ranks_, halo_.get(), last_walls_, wanted);
}

template <class T, class Set>
std::array<EndFlow, 2> Fluid<T, Set>::end_flows() const {
  return core::end_flows(state_, ranks_);
}

template <class T, class Set>
std::array<std::vector<double>, 2> Fluid<T, Set>::passed() const {
  return core::passed(state_, ranks_);
}

template <class T, class Set>
std::vector<double> Fluid<T, Set>::row_velocities_without_membranes() const {
  return core::row_velocities_without_membranes(state_, ranks_);
}

template <class T, class Set>
auto Fluid<T, Set>::wall_forces() const -> WallForces<dimension> {
  WallForces<dimension> forces = core::wall_forces(state_, ranks_, last_walls_);
  if (!walls_have_acted_)
    forces.lower.fill(std::nan("")), forces.upper.fill(std::nan("")), forces.other.fill(std::nan(""));
  return forces;
}

template class Fluid<float>;
template class Fluid<double>;
template class Fluid<float, D3Q19>;
template class Fluid<double, D3Q19>;

}  // namespace rouleau::core
