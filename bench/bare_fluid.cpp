#include "bare_fluid.hpp"

#include <rouleau/d2q9.hpp>
#include <rouleau/dispatch.hpp>

namespace rouleau::bench {

namespace {

template <class T>
struct RowTask {
  const T* in[9];
  T* out[9];
  T *force_x, *force_y;
  int count;  // a multiple of the widest register
  T relaxation_rate, magic;
};

template <Kernel kernel, class T>
struct Row {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const RowTask<T>* task) {
    using S = Pack<T, register_bytes / sizeof(T)>;
    const RowTask<T> t = *task;
    const T omega = t.relaxation_rate;
    const T omega_odd = 2 * (2 - omega) / (4 * t.magic * omega + (2 - omega));
    const S keep_rest = 1 - omega, keep_even = T(0.5) - T(0.5) * omega, keep_odd = T(0.5) - T(0.5) * omega_odd;
    const S rest = omega * T(4.0 / 9), axis = omega * T(1.0 / 9), diagonal = omega * T(1.0 / 36);
    const S axis_odd = omega_odd * T(3.0 / 9), diagonal_odd = omega_odd * T(3.0 / 36);
    const S axis_force = T(3.0 / 9), diagonal_force = T(3.0 / 36);
    for (int x = 0; x < t.count; x += S::size) {
      S f[9];
      d2q9::for_each_velocity([&](auto q) { f[q] = S::load(t.in[q] + x); });
      if constexpr (kernel == Kernel::move) {
        d2q9::for_each_velocity([&](auto q) { f[q].store(t.out[q] + x); });
        continue;
      }
      const S s1 = f[1] + f[3], s2 = f[2] + f[4], s5 = f[5] + f[7], s6 = f[6] + f[8];
      const S d1 = f[1] - f[3], d2 = f[2] - f[4], d5 = f[5] - f[7], d6 = f[6] - f[8];
      const S density = (f[0] + (s1 + s2)) + (s5 + s6);
      const S jx = d1 + (d5 - d6), jy = d2 + (d5 + d6), rising = jx + jy, falling = jy - jx;
      S o1 = keep_odd * d1 + axis_odd * jx, o2 = keep_odd * d2 + axis_odd * jy;
      S o5 = keep_odd * d5 + diagonal_odd * rising, o6 = keep_odd * d6 + diagonal_odd * falling;
      if constexpr (kernel == Kernel::forced) {
        // With a linear equilibrium the half force in the velocity and in Guo's factor cancel.
        const S fx = S::load(t.force_x + x), fy = S::load(t.force_y + x);
        o1 += axis_force * fx;
        o2 += axis_force * fy;
        o5 += diagonal_force * (fx + fy);
        o6 += diagonal_force * (fy - fx);
        (jx + T(0.5) * fx).store(t.force_x + x);
        (jy + T(0.5) * fy).store(t.force_y + x);
      }
      const S axis_density = axis * density, diagonal_density = diagonal * density;
      const S e1 = keep_even * s1 + axis_density, e2 = keep_even * s2 + axis_density;
      const S e5 = keep_even * s5 + diagonal_density, e6 = keep_even * s6 + diagonal_density;
      (keep_rest * f[0] + rest * density).store(t.out[0] + x);
      (e1 + o1).store(t.out[1] + x);
      (e1 - o1).store(t.out[3] + x);
      (e2 + o2).store(t.out[2] + x);
      (e2 - o2).store(t.out[4] + x);
      (e5 + o5).store(t.out[5] + x);
      (e5 - o5).store(t.out[7] + x);
      (e6 + o6).store(t.out[6] + x);
      (e6 - o6).store(t.out[8] + x);
    }
  }
};

template <class T>
using RowFunction = void (*)(const RowTask<T>*);

template <class T>
RowFunction<T> pick(Kernel kernel) {
  switch (kernel) {
    case Kernel::move:
      return Dispatch<Row<Kernel::move, T>, const RowTask<T>*>::pick();
    case Kernel::plain:
      return Dispatch<Row<Kernel::plain, T>, const RowTask<T>*>::pick();
    default:
      return Dispatch<Row<Kernel::forced, T>, const RowTask<T>*>::pick();
  }
}

}  // namespace

template <class T>
BareFluid<T>::BareFluid(Kernel kernel, int nx, int ny, double relaxation_rate, double magic, core::WallVelocity walls)
    : kernel_(kernel),
      relaxation_rate_(static_cast<T>(relaxation_rate)),
      magic_(static_cast<T>(magic)),
      walls_(walls),
      lattice_({{nx, ny}, {true, false}}) {
  if (kernel == Kernel::forced) force_ = {core::Field<T, 2>({nx, ny}), core::Field<T, 2>({nx, ny})};
}

template <class T>
void BareFluid<T>::set(const std::function<double(int, int, int)>& population) {
  for (int q = 0; q < 9; ++q) {
    for (int y = 0; y < lattice_.size(1); ++y) {
      for (int x = 0; x < lattice_.size(0); ++x) lattice_.slot(q, {y})[x] = static_cast<T>(population(q, x, y));
    }
  }
  for (int y = 0; y < lattice_.size(1); ++y) send_row(lattice_, {y});
}

template <class T>
double BareFluid<T>::population(int q, int x, int y) const {
  const T* in[9];
  T* out[9];
  lattice_.row_pointers(parity_, {y}, 0, in, out);
  return static_cast<double>(in[q][x]);
}

template <class T>
void BareFluid<T>::step(rouleau::Range rows) {
  const RowFunction<T> row = pick<T>(kernel_);
  RowTask<T> task{};
  task.count = lattice_.size(0);
  task.relaxation_rate = relaxation_rate_;
  task.magic = magic_;
  for (int i = 0; i < rows.end - rows.begin; ++i) {
    const int y = parity_ == core::Parity::even ? rows.begin + i : rows.end - 1 - i;
    if (parity_ == core::Parity::even) receive_row(lattice_, {y});
    lattice_.row_pointers(parity_, {y}, 0, task.in, task.out);
    if (force_[0].allocated()) task.force_x = force_[0].row(y), task.force_y = force_[1].row(y);
    row(&task);
    add_wall_momentum(lattice_, y, {y}, walls_);
    if (parity_ == core::Parity::even) send_row(lattice_, {y});
    if (force_[0].allocated()) fill_velocity_halo<T, 2>(force_, {y}, lattice_.domain(), walls_);
  }
}

template class BareFluid<float>;
template class BareFluid<double>;

}  // namespace rouleau::bench
