#include "energetics.hpp"

#include <algorithm>
#include <rouleau/dispatch.hpp>
#include <rouleau/pack.hpp>

namespace rouleau::core {

namespace {

template <class T, class S>
ROULEAU_ALWAYS_INLINE S load_wide(const T* from) {
  return S(__builtin_convertvector(Pack<T, S::size>::load(from).vector, typename S::Vector));
}

/// Consecutive nodes of a row.
template <class T, class Set>
struct VelocityTask {
  const T* in[Set::velocity_count];
  const T* force[Set::dimension];  // null: body_force
  double body_force[Set::dimension];
  int count;
  double* velocity[Set::dimension];  // to be set
};

template <class T, class Set>
struct FindVelocity {
  using Task = VelocityTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Task* task) {
    using S = Pack<double, register_bytes / 8>;
    const Task t = *task;
    const int whole = t.count / S::size * S::size;
    for (int x = 0; x < whole; x += S::size) set<S>(t, x);
    for (int x = whole; x < t.count; ++x) set<Pack<double, 1>>(t, x);
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const Task& t, int x) {
    S u[Set::dimension];
    for (S& component : u) component = S(0.0);
    Set::for_each_velocity([&](auto q) {
      const S f = load_wide<T, S>(t.in[q] + x);
      for (int k = 0; k < Set::dimension; ++k)
        if (Set::velocity[q][k] != 0) u[k] = Set::velocity[q][k] > 0 ? u[k] + f : u[k] - f;
    });
    for (int k = 0; k < Set::dimension; ++k) {
      const S force = t.force[k] != nullptr ? load_wide<T, S>(t.force[k] + x) : S(t.body_force[k]);
      (u[k] + 0.5 * force).store(t.velocity[k] + x);
    }
  }
};

/// Rows beside a row, itself in the middle, are counted along y first: by -1, 0 or 1 along y and z.
template <class Set>
struct RowsAround {
  static constexpr int count = Set::dimension == 2 ? 3 : 9, middle = count / 2;
  /// The row that velocity q comes from.
  static constexpr int origin(int q) {
    int at = 0;
    for (int k = Set::dimension - 1; k > 0; --k) at = 3 * at + 1 - Set::velocity[q][k];
    return at;
  }
};

/// A row of nodes; its velocities and those of the rows around it, with a node more at both ends.
template <class T, class Set>
struct EnergyTask {
  const T* in[Set::velocity_count];
  const double* velocity[RowsAround<Set>::count][Set::dimension];  // null: there is a wall
  double wall_speed[3];                                            // by the place along y
  int count;
  ExactSum* sum[Set::dimension];
  ExactSum *kinetic, *dissipation;
};

template <class T, class Set>
struct SumEnergy {
  using Task = EnergyTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Task* task) {
    using S = Pack<double, register_bytes / 8>;
    const Task t = *task;
    double kinetic[stretch], lost[stretch];
    for (int begin = 0; begin < t.count; begin += stretch) {
      const int count = std::min(stretch, t.count - begin), whole = count / S::size * S::size;
      for (int i = 0; i < whole; i += S::size) set<S>(t, begin + i, kinetic + i, lost + i);
      for (int i = whole; i < count; ++i) set<Pack<double, 1>>(t, begin + i, kinetic + i, lost + i);
      const auto terms = static_cast<std::size_t>(count);
      for (int k = 0; k < Set::dimension; ++k) t.sum[k]->add(t.velocity[RowsAround<Set>::middle][k] + begin, terms);
      t.kinetic->add(kinetic, terms);
      t.dissipation->add(lost, terms);
    }
  }

 private:
  static constexpr int stretch = 256;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const Task& t, int x, double* kinetic, double* lost) {
    S u[Set::dimension];
    for (int k = 0; k < Set::dimension; ++k) u[k] = S::load(t.velocity[RowsAround<Set>::middle][k] + x);
    S sum = 0.0, square = u[0] * u[0];
    for (int k = 1; k < Set::dimension; ++k) square += u[k] * u[k];
    Set::for_each_velocity([&](auto q) {
      constexpr auto& c = Set::velocity[q];
      if constexpr (q == 0) return;
      const S f = load_wide<T, S>(t.in[q] + x);
      const double* const* origin = t.velocity[RowsAround<Set>::origin(q)];
      if (origin[0] != nullptr) {
        S change = c[0] * (u[0] - S::load(origin[0] + x - c[0]));
        for (int k = 1; k < Set::dimension; ++k) change += c[k] * (u[k] - S::load(origin[k] + x - c[0]));
        sum -= f * change;
      } else {
        const double speed = t.wall_speed[1 - c[1]], moved = 6 * Set::weight[q] * c[0] * speed;  // as in wall_stress()
        S change = c[0] * (u[0] - speed);
        for (int k = 1; k < Set::dimension; ++k) change += c[k] * u[k];
        sum -= (2.0 * f - moved) * change;
      }
    });
    (0.5 * square).store(kinetic);
    sum.store(lost);
  }
};

/// Velocities of row i of the block, x in [0, nx), and where the block wraps around in [-1, nx].
template <class T, class Set>
void find_velocities(const FluidState<T, Set>& state, int i, const std::array<double*, Set::dimension>& u) {
  using Task = VelocityTask<T, Set>;
  static const auto function = Dispatch<FindVelocity<T, Set>, const Task*>::pick();
  const auto row = state.lattice.row(i);
  state.mask.for_solid(i, [&](int begin, int end) {
    for (double* component : u) std::fill(component + begin, component + end, 0.0);
  });
  state.for_spans(i, [&](const MaskSpan& span, const auto& in) {
    Task task{};
    task.count = span.end - span.begin;
    for (int q = 0; q < Set::velocity_count; ++q) task.in[q] = in[q] + span.begin;
    for (int k = 0; k < Set::dimension; ++k) {
      task.body_force[k] = state.setting.body_force[k];
      task.velocity[k] = u[k] + span.begin;
      if (state.has_force(span)) task.force[k] = state.force[k].row(row) + span.begin;
    }
    function(&task);
  });
  const int nx = state.nx();
  for (double* component : u)
    if (state.setting.domain.wraps(0)) component[-1] = component[nx - 1], component[nx] = component[0];
}

/// The rows of velocities around a row.
template <class T, class Set>
EnergyTask<T, Set> energy_task(const FluidState<T, Set>& state, VelocityRows<Set::dimension>& rows,
                               const typename FluidState<T, Set>::Row& row) {
  constexpr int dimension = Set::dimension;
  EnergyTask<T, Set> task{};
  for (int place = 0; place < RowsAround<Set>::count; ++place) {
    auto beside = row;
    bool wall = false;
    for (int k = 1, rest = place; k < dimension; ++k, rest /= 3) {
      int& coordinate = beside[k - 1];
      coordinate += rest % 3 - 1;
      const Domain<dimension>& domain = state.setting.domain;
      if ((coordinate >= 0 || !domain.wall_below(k)) && (coordinate < state.lattice.size(k) || !domain.wall_above(k)))
        continue;
      if (domain.walled(k)) wall = true;
      coordinate = row[k - 1];  // beyond an opening
    }
    if (wall) continue;
    const std::array<double*, dimension> u = rows.row(beside);
    std::copy(u.begin(), u.end(), task.velocity[place]);
  }
  return task;
}

}  // namespace

// Every step, population q brings momentum c_q f_q from node x - c_q to node x. Summed by parts, the change of the
// kinetic energy is the forces' power, the walls' power, and
//
//     - D = sum over x and q of f_q(x) c_q . (u(x) - u(x - c_q)),
//
// for links that end in a wall the momentum exchanged with it times u(x) - u_wall. In a flow that varies slowly this is
// 2 mu S:S. Unlike that it is right on the scale of the lattice, too, on which the membranes' forces are spread.
template <class T, class Set>
EnergySum<T, Set>::EnergySum(const FluidState<T, Set>& state, const FluidHalo<T, Set>* halo, const WallVelocity& walls)
    : state_(state),
      halo_(halo),
      walls_(walls),
      rows_(state.setting.domain.block),
      sums_(sum_of_velocity + dimension),
      power_(static_cast<std::size_t>(state.nx())) {
  if (halo_ != nullptr) exchange_edges();
  find_layer(-1), find_layer(0);
}

template <class T, class Set>
void EnergySum<T, Set>::exchange_edges() {
  const EdgeNodes<dimension>& nodes = halo_->edges();
  const int nx = state_.nx();
  std::array<double*, dimension> values;
  for (int k = 0; k < dimension; ++k) {
    edge_[k].resize(nodes.count());
    values[k] = edge_[k].data();
  }
  for (int i = 0; i < state_.lattice.rows(); ++i) {
    const Row row = state_.lattice.row(i);
    const bool whole = nodes.whole(row);
    if (!whole && state_.setting.domain.wraps(0)) continue;
    const std::array<double*, dimension> u = rows_.row(row);  // for a moment
    find_velocities(state_, i, u);
    for (int k = 0; k < dimension; ++k) {
      double* const to = values[k];
      if (whole)
        std::copy_n(u[k], nx, to + nodes.place(0, row));
      else
        for (const int x : {0, nx - 1}) to[nodes.place(x, row)] = u[k][x];
    }
  }
  halo_->exchange_edges(values);
}

template <class T, class Set>
int EnergySum<T, Set>::inside(int axis, int place) const {
  const int n = state_.lattice.size(axis);
  return state_.setting.domain.wraps(axis) ? (place + n) % n : (place < n ? place : -1);
}

/// A row of this block or, `from` negative, of others. Beyond openings the flow goes on as it is.
template <class T, class Set>
void EnergySum<T, Set>::find_row(int from, const Row& row) {
  const int nx = state_.nx();
  const std::array<double*, dimension> u = rows_.row(row);
  if (from >= 0) find_velocities(state_, from, u);
  for (int k = 0; halo_ != nullptr && k < dimension; ++k) {
    const auto other = [&](int x) { return edge_[k][static_cast<std::size_t>(halo_->edges().place(x, row))]; };
    if (from < 0)
      for (int x = -1; x <= nx; ++x) u[k][x] = other(x);
    else if (!state_.setting.domain.wraps(0))
      u[k][-1] = other(-1), u[k][nx] = other(nx);
  }
  for (double* const component : u) {
    if (state_.setting.domain.wall_below(0)) component[-1] = component[0];
    if (state_.setting.domain.wall_above(0)) component[nx] = component[nx - 1];
  }
}

template <class T, class Set>
void EnergySum<T, Set>::find_layer(int layer) {
  const int from = inside(dimension - 1, layer);
  if constexpr (dimension == 2) {
    find_row(from, {layer});
  } else {
    for (int y = -1; y <= state_.lattice.size(1); ++y) {
      const int from_y = inside(1, y);
      find_row(from < 0 || from_y < 0 ? -1 : from_y + state_.lattice.size(1) * from, {y, layer});
    }
  }
}

template <class T, class Set>
void EnergySum<T, Set>::add(int i) {
  using Task = EnergyTask<T, Set>;
  static const auto function = Dispatch<SumEnergy<T, Set>, const Task*>::pick();
  constexpr int last = dimension - 1;
  const int rows_of_layer = state_.lattice.rows() / state_.lattice.size(last);
  const Row row = state_.lattice.row(i);
  if (i % rows_of_layer == 0) find_layer(row[last - 1] + 1);
  Task task = energy_task(state_, rows_, row);
  task.wall_speed[0] = walls_.lower, task.wall_speed[2] = walls_.upper;
  for (int k = 0; k < dimension; ++k) task.sum[k] = &sums_[sum_of_velocity + k];
  task.kinetic = &sums_[kinetic];
  task.dissipation = &sums_[dissipation];
  const std::array<double*, dimension> u = rows_.row(row);
  velocity_along_flow_ = u[state_.setting.domain.flow_axis()];
  state_.for_fluid(i, [&](int begin, int end, const auto& in) {
    Task part = task;
    part.count = end - begin;
    for (int q = 0; q < velocity_count; ++q) part.in[q] = in[q] + begin;
    for (auto& beside : part.velocity)
      for (const double*& component : beside) component += component != nullptr ? begin : 0;
    function(&part);
  });
  // A link into a wall counts with what left, too; beyond plane walls that has been taken for what came back, and for
  // what a wall that moves has given.
  state_.for_links(i, [&](std::size_t piece, const auto& at) {
    for (const auto& link : state_.links->of_piece(piece)) {
      const auto& c = Set::velocity[link.q];
      double change = 0;
      for (int k = 0; k < dimension; ++k) change += c[k] * u[k][link.x];
      const double f = static_cast<double>(at.in[link.q][link.x]), left = static_cast<double>(link.left);
      const double speed = link.plane ? c[0] * task.wall_speed[1 - c[1]] : 0;
      sums_[dissipation].add(-(link.plane ? left - f : left) * change);
      if (const double wall = state_.links->wall_velocity(link); wall != 0) {
        sums_[wall_power].add((left + f) * wall);
        sums_[dissipation].add((left + f) * wall);
      }
      if (speed != 0) sums_[dissipation].add(-(2 * f + 6 * Set::weight[link.q] * (change - speed)) * speed);
    }
  });
  if (state_.setting.membranes) add_membrane_power(i, u);
}

template <class T, class Set>
void EnergySum<T, Set>::add_membrane_power(int i, const std::array<double*, dimension>& u) {
  const Row row = state_.lattice.row(i);
  state_.mask.for_spans(i, [&](const MaskSpan& span) {
    if (!span.active) return;
    for (int x = span.begin; x < span.end; ++x) {
      power_[x] = 0;
      for (int k = 0; k < dimension; ++k)
        power_[x] += (static_cast<double>(state_.force[k].row(row)[x]) - state_.setting.body_force[k]) * u[k][x];
    }
    sums_[membrane_power].add(power_.data() + span.begin, static_cast<std::size_t>(span.end - span.begin));
  });
}

template <class T, class Set>
auto EnergySum<T, Set>::total(const Ranks<dimension>& ranks) -> Energetics<dimension> {
  add_up(ranks, sums_);
  Energetics<dimension> energetics{.kinetic = sums_[kinetic].value(),
                                   .dissipation = sums_[dissipation].value(),
                                   .velocity = {},
                                   .membrane_power = sums_[membrane_power].value(),
                                   .wall_power = sums_[wall_power].value()};
  for (int k = 0; k < dimension; ++k) energetics.velocity[k] = sums_[sum_of_velocity + k].value();
  return energetics;
}

template class EnergySum<float, D2Q9>;
template class EnergySum<double, D2Q9>;
template class EnergySum<float, D3Q19>;
template class EnergySum<double, D3Q19>;

}  // namespace rouleau::core
