// The loops over the triangles and nodes of one cell that its slip correction consists of, for any width of vector
// registers. Arrays of triangles have room for a whole pack behind their end.
#pragma once

#include <rouleau/pack.hpp>

#include "core/domain/vectors.hpp"

namespace rouleau::core {

/// Symmetric matrices of 3 x 3, or packs of them.
template <class S>
struct SymmetricMatrices {
  S xx, yy, zz, xy, xz, yz;
  ROULEAU_ALWAYS_INLINE static SymmetricMatrices load(const auto& from, int at) {
    return {S::load(from[0] + at), S::load(from[1] + at), S::load(from[2] + at),
            S::load(from[3] + at), S::load(from[4] + at), S::load(from[5] + at)};
  }
  ROULEAU_ALWAYS_INLINE void store(double* const (&to)[6], int at) const {
    xx.store(to[0] + at), yy.store(to[1] + at), zz.store(to[2] + at);
    xy.store(to[3] + at), xz.store(to[4] + at), yz.store(to[5] + at);
  }
  ROULEAU_ALWAYS_INLINE friend Vectors<S> operator*(const SymmetricMatrices& a, const Vectors<S>& b) {
    return {a.xx * b.x + a.xy * b.y + a.xz * b.z, a.xy * b.x + a.yy * b.y + a.yz * b.z,
            a.xz * b.x + a.yz * b.y + a.zz * b.z};
  }
};

struct SlipArrays {
  int triangles, nodes;
  double shift;
  const int* corner[3];  ///< of triangles: their nodes
  // of nodes
  const double *place[3], *force[3];
  const double *normal_sum[3], *area;  ///< SurfaceNormals
  double *normal[3], *touch[3];        ///< outer unit vectors; where the nodes touch the lattice
  double* covered[6];                  ///< sum of what the triangles around have
  double *turn[6], *along[3];          ///< R (TurnForces); tangential forces over areas
  double *turned[3], *pressure;        ///< R times that; normal forces over areas
  double* velocity[3];
  // of triangles
  const double* triangle_area;
  double* gradient[2][3];  ///< of the hat functions of the first two corners, on the touching triangle, times the area
  /// The touching triangle's unit normal times itself, times a third of the area: xx, yy, zz, xy, xz, yz.
  double* covered_triangle[6];
  double* result[3][3];  ///< on the three corners
};

/// A triangle where it touches the lattice.
template <class S>
struct TouchingTriangle {
  Vectors<S> normal[3];  ///< of the nodes
  Vectors<S> around;     ///< twice the touching triangle's area, along its normal
  Vectors<S> gradient[2];
  S weight;  ///< area of the triangle that the nodes make, over the square of `around`
  ROULEAU_ALWAYS_INLINE TouchingTriangle(const SlipArrays& a, int t) {
    Vectors<S> corner[3];
    for (int k = 0; k < 3; ++k) {
      corner[k] = Vectors<S>::gather(a.touch, a.corner[k] + t);
      normal[k] = Vectors<S>::gather(a.normal, a.corner[k] + t);
    }
    const Vectors<S> one = corner[1] - corner[0], two = corner[2] - corner[0];
    around = cross(one, two);
    const S square = dot(around, around);
    weight = select(square > S(0.0), S::load(a.triangle_area + t) / square, S(0.0));
    gradient[0] = weight * cross(around, two - one);
    gradient[1] = weight * cross(two, around);
  }
};

/// Calls a loop's act<S>(arrays, node) for all nodes, in packs as far as there are whole ones.
template <class Loop, int register_bytes>
ROULEAU_ALWAYS_INLINE void for_nodes(const SlipArrays& a) {
  using S = Pack<double, register_bytes / 8>;
  int i = 0;
  for (; i + S::size <= a.nodes; i += S::size) Loop::template act<S>(a, i);
  for (; i < a.nodes; ++i) Loop::template act<Pack<double, 1>>(a, i);
}

/// Nodes: unit vectors, and where the nodes touch the lattice.
struct FindTouch {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    for_nodes<FindTouch, register_bytes>(*arrays);
  }
  template <class S>
  ROULEAU_ALWAYS_INLINE static void act(const SlipArrays& a, int i) {
    const Vectors<S> sum = Vectors<S>::load(a.normal_sum, i);
    const S length = sqrt(dot(sum, sum));
    const Vectors<S> n = select(length > S(0.0), 1.0 / length, S(0.0)) * sum;  // a fold without width has no direction
    n.store(a.normal, i);
    (Vectors<S>::load(a.place, i) - S(a.shift) * n).store(a.touch, i);
  }
};

/// Triangles: gradients, and what they add to the mean projection around a node.
struct MeasureTouch {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SlipArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const TouchingTriangle<S> triangle(a, t);
      for (int k = 0; k < 2; ++k) triangle.gradient[k].store(a.gradient[k], t);
      const Vectors<S>&n = triangle.around, by = (1.0 / 3 * triangle.weight) * n;
      SymmetricMatrices<S>{by.x * n.x, by.y * n.y, by.z * n.z, by.x * n.y, by.x * n.z, by.y * n.z}.store(
          a.covered_triangle, t);
    }
  }
};

/// Nodes: the tangential part of the forces, over areas.
struct ForcesAlong {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    for_nodes<ForcesAlong, register_bytes>(*arrays);
  }
  template <class S>
  ROULEAU_ALWAYS_INLINE static void act(const SlipArrays& a, int i) {
    const Vectors<S> n = Vectors<S>::load(a.normal, i), force = Vectors<S>::load(a.force, i);
    const S area = S::load(a.area + i), by_area = select(area > S(0.0), 1.0 / area, S(0.0));
    (by_area * (force - dot(force, n) * n)).store(a.along, i);
  }
};

/// Nodes: R with P M R = P on tangents, M = 1 - covered/area the mean projection of the triangles around a node: then
/// couples have no torque. Where the surface is folded so that there is none, R is the identity. And the forces over
/// areas: normal, tangential, and the latter turned by R.
struct TurnForces {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    for_nodes<TurnForces, register_bytes>(*arrays);
  }
  template <class S>
  ROULEAU_ALWAYS_INLINE static void act(const SlipArrays& a, int i) {
    const Vectors<S> n = Vectors<S>::load(a.normal, i), force = Vectors<S>::load(a.force, i);
    const S area = S::load(a.area + i), by_area = select(area > S(0.0), 1.0 / area, S(0.0));
    const SymmetricMatrices<S> q = SymmetricMatrices<S>::load(a.covered, i);
    // P q P = q - n w - w n, w = q n - (n q n)/2 n
    const Vectors<S> q_n = q * n, w = q_n - (0.5 * dot(n, q_n)) * n;
    const SymmetricMatrices<S> m{1.0 - by_area * (q.xx - 2.0 * n.x * w.x), 1.0 - by_area * (q.yy - 2.0 * n.y * w.y),
                                 1.0 - by_area * (q.zz - 2.0 * n.z * w.z), by_area * (n.x * w.y + n.y * w.x - q.xy),
                                 by_area * (n.x * w.z + n.z * w.x - q.xz), by_area * (n.y * w.z + n.z * w.y - q.yz)};
    const SymmetricMatrices<S> minors{m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xx * m.yy - m.xy * m.xy,
                                      m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy, m.xy * m.xz - m.yz * m.xx};
    const S determinant = m.xx * minors.xx + m.xy * minors.xy + m.xz * minors.xz;
    const auto unfolded = determinant > S(0.01);
    const S inverse = select(unfolded, 1.0 / determinant, S(0.0)), one = select(unfolded, S(0.0), S(1.0));
    const SymmetricMatrices<S> r{inverse * minors.xx + one, inverse * minors.yy + one, inverse * minors.zz + one,
                                 inverse * minors.xy,       inverse * minors.xz,       inverse * minors.yz};
    r.store(a.turn, i);
    const S pressure = by_area * dot(force, n);
    const Vectors<S> along = by_area * force - pressure * n;
    pressure.store(a.pressure + i);
    along.store(a.along, i);
    (r * along).store(a.turned, i);
  }
};

/// Triangles: the couples of their nodes' forces, as forces on the corners.
struct MakeCouples {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SlipArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      Vectors<S> normal[3], along[3];
      S pressure = 0.0;
      for (int k = 0; k < 3; ++k) {
        const int* const node = a.corner[k] + t;
        normal[k] = Vectors<S>::gather(a.normal, node), along[k] = Vectors<S>::gather(a.turned, node);
        pressure += gathered<S>(a.pressure, node);
      }
      const S share = -a.shift / 3;
      Vectors<S> on[2];
      for (int k = 0; k < 2; ++k) {
        const Vectors<S> g = Vectors<S>::load(a.gradient[k], t);
        on[k] = pressure * g;
        for (int j = 0; j < 3; ++j) on[k] = on[k] + dot(along[j], g) * normal[j];
        on[k] = share * on[k];
        on[k].store(a.result[k], t);
      }
      // The three hat functions add up to one.
      (S(-1.0) * (on[0] + on[1])).store(a.result[2], t);
    }
  }
};

/// Triangles: what the adjoint of the couples makes of velocities, at each corner: with G the gradient of the velocity
/// along the triangle times its area and n the node's normal, P G n + n tr G.
struct MakeTurns {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SlipArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const TouchingTriangle<S> triangle(a, t);
      const Vectors<S> last = Vectors<S>::gather(a.velocity, a.corner[2] + t);
      const Vectors<S> one = Vectors<S>::gather(a.velocity, a.corner[0] + t) - last,
                       two = Vectors<S>::gather(a.velocity, a.corner[1] + t) - last;
      const S trace = dot(triangle.gradient[0], one) + dot(triangle.gradient[1], two);
      for (int k = 0; k < 3; ++k) {
        const Vectors<S>& n = triangle.normal[k];
        const Vectors<S> turned = dot(one, n) * triangle.gradient[0] + dot(two, n) * triangle.gradient[1];
        (turned + (trace - dot(turned, n)) * n).store(a.result[k], t);
      }
    }
  }
};

/// Nodes: turns velocities by what the triangles around have in `turned`: R of its tangential part, and its normal
/// part.
struct TurnVelocities {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipArrays* arrays) {
    for_nodes<TurnVelocities, register_bytes>(*arrays);
  }
  template <class S>
  ROULEAU_ALWAYS_INLINE static void act(const SlipArrays& a, int i) {
    const Vectors<S> n = Vectors<S>::load(a.normal, i), all = Vectors<S>::load(a.turned, i);
    const S area = S::load(a.area + i), share = a.shift / 3 * select(area > S(0.0), 1.0 / area, S(0.0));
    const Vectors<S> across = dot(all, n) * n;
    const Vectors<S> turn = SymmetricMatrices<S>::load(a.turn, i) * (all - across) + across;
    (Vectors<S>::load(a.velocity, i) - share * turn).store(a.velocity, i);
  }
};

}  // namespace rouleau::core
