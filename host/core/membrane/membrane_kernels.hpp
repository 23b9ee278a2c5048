// The loops over one cell's segments and nodes that membrane forces consist of, for any width of vector registers.
#pragma once

#include <rouleau/pack.hpp>

#include "turning_angle.hpp"

namespace rouleau::core {

/// One cell's arrays, each pointing at its node 0.
struct CellArrays {
  int count;
  double *x, *y, *u, *v;
  double *tangent_x, *tangent_y, *inverse_length, *stretch, *rate;
  const double *inverse_rest_length, *inverse_rest_weight;
  double *curvature, *tension, *moment, *segment_force_x, *segment_force_y;
  double *force_x, *force_y;
  bool with_rate, with_moment, with_pressure;
  double pressure, perimeter_tension;
};

/// Segments: tangent, stretch and its rate; then nodes: curvature.
struct MeasureCell {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const CellArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const CellArrays a = *arrays;
    for (int i = 0; i < a.count; i += S::size) {
      const S dx = S::load(a.x + i + 1) - S::load(a.x + i), dy = S::load(a.y + i + 1) - S::load(a.y + i);
      const S square = dx * dx + dy * dy;
      const SquareRoot<S> length = sqrt_and_inverse(square);
      const S inverse = select(square > S(0.0), length.inverse, S(0.0));  // without a length there is no direction
      const S tx = dx * inverse, ty = dy * inverse, inverse_rest = S::load(a.inverse_rest_length + i);
      tx.store(a.tangent_x + i);
      ty.store(a.tangent_y + i);
      inverse.store(a.inverse_length + i);
      (square * inverse * inverse_rest).store(a.stretch + i);
      if (a.with_rate) {
        const S du = S::load(a.u + i + 1) - S::load(a.u + i), dv = S::load(a.v + i + 1) - S::load(a.v + i);
        ((tx * du + ty * dv) * inverse_rest).store(a.rate + i);
      }
    }
    if (!a.with_moment) return;
    a.tangent_x[-1] = a.tangent_x[a.count - 1];
    a.tangent_y[-1] = a.tangent_y[a.count - 1];
    for (int i = 0; i < a.count; i += S::size) {
      const S sx = S::load(a.tangent_x + i - 1), sy = S::load(a.tangent_y + i - 1);
      const S tx = S::load(a.tangent_x + i), ty = S::load(a.tangent_y + i);
      const S angle = turning_angle(sx * ty - sy * tx, sx * tx + sy * ty);
      (angle * S::load(a.inverse_rest_weight + i)).store(a.curvature + i);
    }
  }
};

/// Forces: every segment pulls its first node by S_i = T_i t_i - q_i n_i and its second one by -S_i.
struct ActOnCell {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const CellArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const CellArrays a = *arrays;
    if (a.with_moment) a.moment[a.count] = a.moment[0];
    for (int i = 0; i < a.count; i += S::size) {
      const S tx = S::load(a.tangent_x + i), ty = S::load(a.tangent_y + i);
      const S tension = S::load(a.tension + i) + a.perimeter_tension;
      S fx = tension * tx, fy = tension * ty;
      if (a.with_moment) {
        const S shear = (S::load(a.moment + i + 1) - S::load(a.moment + i)) * S::load(a.inverse_length + i);
        fx += shear * ty;
        fy -= shear * tx;
      }
      fx.store(a.segment_force_x + i);
      fy.store(a.segment_force_y + i);
    }
    a.segment_force_x[-1] = a.segment_force_x[a.count - 1];
    a.segment_force_y[-1] = a.segment_force_y[a.count - 1];
    for (int i = 0; i < a.count; i += S::size) {
      S fx = S::load(a.segment_force_x + i) - S::load(a.segment_force_x + i - 1);
      S fy = S::load(a.segment_force_y + i) - S::load(a.segment_force_y + i - 1);
      if (a.with_pressure) {
        const S half = 0.5 * a.pressure;
        fx += half * (S::load(a.y + i + 1) - S::load(a.y + i - 1));
        fy -= half * (S::load(a.x + i + 1) - S::load(a.x + i - 1));
      }
      if (a.count - i >= S::size) {
        fx.store(a.force_x + i);
        fy.store(a.force_y + i);
      } else {  // the next cell's forces belong to another worker
        for (int k = 0; k < a.count - i; ++k) {
          a.force_x[i + k] = fx.vector[k];
          a.force_y[i + k] = fy.vector[k];
        }
      }
    }
  }
};

}  // namespace rouleau::core
