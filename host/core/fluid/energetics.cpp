// Kinetic energy and viscous dissipation of the fluid, for the energy ledger.
#include <rouleau/d2q9.hpp>
#include <rouleau/dispatch.hpp>
#include <rouleau/pack.hpp>

#include "core/domain/exact_sum.hpp"
#include "fluid.hpp"

namespace rouleau::core {

namespace {

template <class T, class S>
ROULEAU_ALWAYS_INLINE S load_wide(const T* from) {
  return S(__builtin_convertvector(Pack<T, S::size>::load(from).vector, typename S::Vector));
}

/// Consecutive nodes of a row.
template <class T>
struct VelocityTask {
  const T* in[9];
  const T* force[2];  // null: body_force
  double body_force[2];
  int count;
  double* velocity[2];  // to be set
};

template <class T>
struct FindVelocity {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const VelocityTask<T>* task) {
    using S = Pack<double, register_bytes / 8>;
    const VelocityTask<T> t = *task;
    const int whole = t.count / S::size * S::size;
    for (int x = 0; x < whole; x += S::size) set<S>(t, x);
    for (int x = whole; x < t.count; ++x) set<Pack<double, 1>>(t, x);
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const VelocityTask<T>& t, int x) {
    S u[2] = {S(0.0), S(0.0)};
    d2q9::for_each_velocity([&](auto q) {
      const S f = load_wide<T, S>(t.in[q] + x);
      for (int k = 0; k < 2; ++k) {
        if (d2q9::velocity[q][k] != 0) u[k] = d2q9::velocity[q][k] > 0 ? u[k] + f : u[k] - f;
      }
    });
    for (int k = 0; k < 2; ++k) {
      const S force = t.force[k] != nullptr ? load_wide<T, S>(t.force[k] + x) : S(t.body_force[k]);
      (u[k] + 0.5 * force).store(t.velocity[k] + x);
    }
  }
};

/// A row of nodes; its velocities and those of the rows below and above, with a node more at both ends.
template <class T>
struct EnergyTask {
  const T* in[9];
  const double* velocity[3][2];  // null: there is a wall
  double wall_speed[3];
  int count;
  ExactSum *sum_x, *sum_y, *kinetic, *dissipation;
};

template <class T>
struct SumEnergy {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const EnergyTask<T>* task) {
    using S = Pack<double, register_bytes / 8>;
    const EnergyTask<T> t = *task;
    double kinetic[stretch], lost[stretch];
    for (int begin = 0; begin < t.count; begin += stretch) {
      const int count = std::min(stretch, t.count - begin), whole = count / S::size * S::size;
      for (int i = 0; i < whole; i += S::size) set<S>(t, begin + i, kinetic + i, lost + i);
      for (int i = whole; i < count; ++i) set<Pack<double, 1>>(t, begin + i, kinetic + i, lost + i);
      const auto terms = static_cast<std::size_t>(count);
      t.sum_x->add(t.velocity[1][0] + begin, terms);
      t.sum_y->add(t.velocity[1][1] + begin, terms);
      t.kinetic->add(kinetic, terms);
      t.dissipation->add(lost, terms);
    }
  }

 private:
  static constexpr int stretch = 256;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const EnergyTask<T>& t, int x, double* kinetic, double* lost) {
    const S ux = S::load(t.velocity[1][0] + x), uy = S::load(t.velocity[1][1] + x);
    S sum = 0.0;
    d2q9::for_each_velocity([&](auto q) {
      constexpr int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
      if constexpr (q == 0) return;
      const S f = load_wide<T, S>(t.in[q] + x);
      const double* const* origin = t.velocity[1 - cy];
      if (origin[0] != nullptr) {
        sum -= f * (cx * (ux - S::load(origin[0] + x - cx)) + cy * (uy - S::load(origin[1] + x - cx)));
      } else {
        const double speed = t.wall_speed[1 - cy], moved = 6 * d2q9::weight[q] * cx * speed;  // as in wall_stress()
        sum -= (2.0 * f - moved) * (cx * (ux - speed) + cy * uy);
      }
    });
    (0.5 * (ux * ux + uy * uy)).store(kinetic);
    sum.store(lost);
  }
};

/// Velocities of rows [-1, ny], each with a node more at both ends: of all rows, or only of three that follow each other.
class VelocityRows {
 public:
  VelocityRows(int nx, int rows) : width_(nx + 2), rows_(rows) {
    for (auto& values : values_) values.resize(static_cast<std::size_t>(width_) * rows);
  }
  /// Component k of row y, at x = 0.
  [[nodiscard]] double* row(int k, int y) { return values_[k].data() + width_ * ((y + 1) % rows_) + 1; }

 private:
  std::ptrdiff_t width_;
  int rows_;
  std::vector<double> values_[2];
};

}  // namespace

// Every step, population q brings momentum c_q f_q from node x - c_q to node x. Summed by parts, the change of the
// kinetic energy is the forces' power, the walls' power, and
//
//     - D = sum over x and q of f_q(x) c_q . (u(x) - u(x - c_q)),
//
// for links that end in a wall the momentum exchanged with it times u(x) - u_wall. In a flow that varies slowly this is
// 2 mu S:S. Unlike that it is right on the scale of the lattice, too, on which the membranes' forces are spread.
template <class T>
void Fluid<T>::velocities(int y, double* ux, double* uy) const {
  static const auto function = Dispatch<FindVelocity<T>, const VelocityTask<T>*>::pick();
  const T* in[9];
  lattice_.row_pointers(parity_, {y}, in);
  mask_.for_spans(y, [&](const MaskSpan& span) {
    VelocityTask<T> task{.in = {},
                         .force = {},
                         .body_force = {setting_.body_force_x, setting_.body_force_y},
                         .count = span.end - span.begin,
                         .velocity = {ux + span.begin, uy + span.begin}};
    for (int q = 0; q < 9; ++q) task.in[q] = in[q] + span.begin;
    for (int k = 0; k < 2 && span.active && setting_.membranes; ++k) task.force[k] = force_[k].row(y) + span.begin;
    function(&task);
  });
  for (double* u : {ux, uy}) {
    if (setting_.domain.wraps(0)) u[-1] = u[nx() - 1], u[nx()] = u[0];
  }
}

template <class T>
typename Fluid<T>::Energetics Fluid<T>::energetics() const {
  static const auto function = Dispatch<SumEnergy<T>, const EnergyTask<T>*>::pick();
  const int nx = this->nx(), ny = this->ny();
  const Domain<2>& domain = setting_.domain;
  // Where other blocks want velocities, those of all rows are found first.
  const bool all_first = energetics_halo_ != nullptr;
  VelocityRows rows(nx, all_first ? ny + 2 : 3);
  const auto find = [&](int y) {
    const int from = domain.wraps(1) ? (y + ny) % ny : y;
    if (from >= 0 && from < ny) velocities(from, rows.row(0, y), rows.row(1, y));
  };
  if (all_first) {
    for (int y = -1; y <= ny; ++y) find(y);
    double* const first_node[2] = {rows.row(0, 0), rows.row(1, 0)};
    energetics_halo_->begin(Way::out, first_node);
    energetics_halo_->end(Way::out, first_node);
  } else {
    find(-1), find(0);
  }
  enum { kinetic, sum_x, sum_y, membrane_power, dissipation };
  std::vector<ExactSum> sums(5);
  std::vector<double> power(static_cast<std::size_t>(nx));
  for (int y = 0; y < ny; ++y) {
    if (!all_first) find(y + 1);
    EnergyTask<T> task{.in = {},
                       .velocity = {},
                       .wall_speed = {last_walls_.lower, 0, last_walls_.upper},
                       .count = nx,
                       .sum_x = &sums[sum_x],
                       .sum_y = &sums[sum_y],
                       .kinetic = &sums[kinetic],
                       .dissipation = &sums[dissipation]};
    lattice_.row_pointers(parity_, {y}, task.in);
    for (int side = -1; side <= 1; ++side) {
      if ((y + side < 0 && domain.wall_below(1)) || (y + side >= ny && domain.wall_above(1))) continue;
      for (int k = 0; k < 2; ++k) task.velocity[side + 1][k] = rows.row(k, y + side);
    }
    function(&task);
    if (!setting_.membranes) continue;
    const double *ux = rows.row(0, y), *uy = rows.row(1, y);
    mask_.for_spans(y, [&](const MaskSpan& span) {
      if (!span.active) return;
      const T *fx = force_[0].row(y), *fy = force_[1].row(y);
      for (int x = span.begin; x < span.end; ++x) {
        power[x] = (static_cast<double>(fx[x]) - setting_.body_force_x) * ux[x] +
                   (static_cast<double>(fy[x]) - setting_.body_force_y) * uy[x];
      }
      sums[membrane_power].add(power.data() + span.begin, static_cast<std::size_t>(span.end - span.begin));
    });
  }
  add_up(ranks_, sums);
  return {.kinetic = sums[kinetic].value(),
          .dissipation = sums[dissipation].value(),
          .velocity_x = sums[sum_x].value(),
          .velocity_y = sums[sum_y].value(),
          .membrane_power = sums[membrane_power].value()};
}

template void Fluid<float>::velocities(int, double*, double*) const;
template void Fluid<double>::velocities(int, double*, double*) const;
template Fluid<float>::Energetics Fluid<float>::energetics() const;
template Fluid<double>::Energetics Fluid<double>::energetics() const;

}  // namespace rouleau::core
