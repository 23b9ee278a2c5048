// The unsteady term of creeping flow, taken in a frame that moves: the loop, for any width of vector registers.
#pragma once

#include <rouleau/collision.hpp>

namespace rouleau::core {

/// Nodes of one span of a row after their collision. Lattice units.
template <class T>
struct MovingFrameTask {
  T* out[9];
  const T* velocity[2];      ///< per node; null: what the populations say, with half the body force
  const T* relaxation_rate;  ///< per node, or null: `rate`
  T rate;
  T body_force[2];
  T frame[2];  ///< velocity of the frame
  int count;
};

/// Without its quadratic terms the equilibrium makes du/dt of the momentum balance, and that is not the same for all
/// who look on: a cell that travels at U through a fluid at rest is another problem than one at rest in a fluid that
/// passes at -U. With the quadratic terms Q(u, u) the balance has Du/Dt, which is; and with Q(u, u) - Q(u - U, u - U) =
/// 2 Q(u, U) - Q(U, U) it has du/dt as seen from the frame that moves at U, which is du/dt + U.grad u. A collision
/// relaxes towards these terms with the rate of the viscous stress; the force F that acts in it has Q(U, F) in the same
/// way (Guo's source). So they can be added behind any collision operator:
///
///     out_q += Q_q(U, w (2 u - U) + (2 - w) F),   Q_q(a, b) = weight_q (9/2 (c_q.a)(c_q.b) - 3/2 a.b),  w: 1/tau.
struct AddMovingFrame {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const MovingFrameTask<float>* task) {
    sweep<register_bytes>(*task);
  }
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const MovingFrameTask<double>* task) {
    sweep<register_bytes>(*task);
  }

 private:
  template <int register_bytes, class T>
  ROULEAU_ALWAYS_INLINE static void sweep(const MovingFrameTask<T>& task) {
    const bool at_cells = task.velocity[0] != nullptr, along_x = task.frame[1] == 0;
    if (at_cells && along_x) return sweep<register_bytes, T, true, true>(task);
    if (at_cells) return sweep<register_bytes, T, true, false>(task);
    if (along_x) return sweep<register_bytes, T, false, true>(task);
    sweep<register_bytes, T, false, false>(task);
  }

  template <int register_bytes, class T, bool at_cells, bool along_x>
  ROULEAU_ALWAYS_INLINE static void sweep(const MovingFrameTask<T>& task) {
    constexpr int width = register_bytes / sizeof(T);
    const MovingFrameTask<T> t = task;
    // Far from cells the force is the body force, so that w (2 u - U) + (2 - w) F is 2 w times the momentum j = u + F/2
    // after the collision, and this:
    T constant[2];
    for (int k = 0; k < 2; ++k) constant[k] = t.rate * (-t.body_force[k] - t.frame[k]) + (2 - t.rate) * t.body_force[k];
    const int whole = t.count / width * width;
    for (int x = 0; x < whole; x += width) add<Pack<T, width>, T, at_cells, along_x>(t, constant, x);
    for (int x = whole; x < t.count; ++x) add<Pack<T, 1>, T, at_cells, along_x>(t, constant, x);
  }

  template <class S, class T, bool at_cells, bool along_x>
  ROULEAU_ALWAYS_INLINE static void add(const MovingFrameTask<T>& t, const T (&constant)[2], int x) {
    S f[9], a[2];
    d2q9::for_each_velocity([&](auto q) { f[q] = S::load(t.out[q] + x); });
    for (int k = 0; k < 2; ++k) {
      S momentum = 0;
      d2q9::for_each_velocity([&](auto q) {
        if (d2q9::velocity[q][k] != 0) momentum = d2q9::velocity[q][k] > 0 ? momentum + f[q] : momentum - f[q];
      });
      if constexpr (at_cells) {
        const S rate = t.relaxation_rate != nullptr ? S::load(t.relaxation_rate + x) : S(t.rate);
        const S u = S::load(t.velocity[k] + x);
        a[k] = rate * (u + u - t.frame[k]) + (2 - rate) * (momentum - u) * 2;
      } else {
        a[k] = (2 * t.rate) * momentum + constant[k];
      }
    }
    // The terms of U_x a_x and U_y a_y, and of what is mixed of them, which all nine velocities share.
    const S xx = a[0] * t.frame[0];
    S yy = 0, xy = a[1] * t.frame[0];
    if constexpr (!along_x) yy = a[1] * t.frame[1], xy += a[0] * t.frame[1];
    d2q9::for_each_velocity([&](auto q) {
      constexpr int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
      constexpr T weight = static_cast<T>(d2q9::weight[q]);
      S term = xx * (weight * T(4.5 * cx * cx - 1.5));
      if constexpr (!along_x) term += yy * (weight * T(4.5 * cy * cy - 1.5));
      if constexpr (cx * cy != 0) term += xy * (weight * T(4.5 * cx * cy));
      (f[q] + term).store(t.out[q] + x);
    });
  }
};

}  // namespace rouleau::core
