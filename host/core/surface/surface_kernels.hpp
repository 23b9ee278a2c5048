// The loops over the triangles and edges of one cell that its membrane forces consist of, for any width of vector
// registers. Arrays have room for a whole pack behind their end.
#pragma once

#include <rouleau/pack.hpp>

#include "core/domain/vectors.hpp"
#include "core/membrane/turning_angle.hpp"

namespace rouleau::core {

struct SurfaceArrays {
  int triangles, edges;
  // of nodes
  const double* place[3];
  const double *node_moment, *node_pull;
  // of triangles
  const int *corner[3], *edge[3];  ///< nodes; edges opposite to them
  double* side[2][3];              ///< from the first to the second node, and to the third
  const double* inverse[3];        ///< metric at rest: 11, 12, 22
  const double* rest_area;
  double *invariant_1, *invariant_2;
  double* normal[3];  ///< twice the area along the outer normal
  const double *stress_1, *stress_2;
  const double* viscous[3];  ///< viscous stress times area, along the sides: 11, 12, 22 (SurfaceViscosity)
  double* force[3][3];       ///< on the first, second and third node
  // of edges
  const int *edge_node[2], *edge_triangle[2];  ///< nodes a and b; the left and the right triangle
  double *turned_length, *edge_turn;           ///< length times turning angle; turning angle over twice the length
  bool with_moment, with_area_pull, with_viscosity;
  double pressure, surface_tension;
};

/// Triangles: normals and the invariants of their stretches.
struct MeasureTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SurfaceArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const auto corner = [&](int k) { return Vectors<S>::gather(a.place, a.corner[k] + t); };
      const Vectors<S> first = corner(0), one = corner(1) - first, two = corner(2) - first, normal = cross(one, two);
      one.store(a.side[0], t);
      two.store(a.side[1], t);
      normal.store(a.normal, t);
      const S g11 = dot(one, one), g12 = dot(one, two), g22 = dot(two, two);
      const S b11 = S::load(a.inverse[0] + t), b12 = S::load(a.inverse[1] + t), b22 = S::load(a.inverse[2] + t);
      (b11 * g11 + 2.0 * b12 * g12 + b22 * g22 - 2.0).store(a.invariant_1 + t);
      ((b11 * b22 - b12 * b12) * dot(normal, normal) - 1.0).store(a.invariant_2 + t);
    }
  }
};

/// Edges: by how much the surface turns along them.
struct MeasureEdges {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SurfaceArrays a = *arrays;
    for (int e = 0; e < a.edges; e += S::size) {
      const auto node = [&](int k) { return Vectors<S>::gather(a.place, a.edge_node[k] + e); };
      const Vectors<S> along = node(1) - node(0), left = Vectors<S>::gather(a.normal, a.edge_triangle[0] + e),
                       right = Vectors<S>::gather(a.normal, a.edge_triangle[1] + e);
      const SquareRoot<S> length = sqrt_and_inverse(dot(along, along));
      const S both = sqrt_and_inverse(dot(left, left) * dot(right, right)).inverse;
      const S angle = turning_angle(dot(along, cross(left, right)) * length.inverse * both, dot(left, right) * both);
      (length.root * angle).store(a.turned_length + e);
      (0.5 * angle * length.inverse).store(a.edge_turn + e);
    }
  }
};

/// Forces on the corners of triangles, minus the gradient of the energy.
/// With the metric g of the sides e1, e2 and its inverse B at rest, d I1 = B : dg and d I2 = det B d det g; of the
/// surface d area = d det g / (4 sqrt det g), of the volume the normal over 6 at each corner. Of an edge, energy
/// changes with m d(l theta), m the mean of the moments at its ends: theta turns with the distance of the opposite
/// corners from it, and either triangle takes half of what dl brings.
struct ActOnTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SurfaceArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const Vectors<S> one = Vectors<S>::load(a.side[0], t), two = Vectors<S>::load(a.side[1], t),
                       normal = Vectors<S>::load(a.normal, t);
      const S g11 = dot(one, one), g12 = dot(one, two), g22 = dot(two, two), det = dot(normal, normal);
      const S b11 = S::load(a.inverse[0] + t), b12 = S::load(a.inverse[1] + t), b22 = S::load(a.inverse[2] + t);
      const S area = S::load(a.rest_area + t), w1 = area * S::load(a.stress_1 + t), w2 = area * S::load(a.stress_2 + t);
      S pull = a.surface_tension;
      if (a.with_area_pull) {
        const auto of_node = [&](int k) { return gathered<S>(a.node_pull, a.corner[k] + t); };
        pull += of_node(0) + of_node(1) + of_node(2);
      }
      const S by_det = w2 * (b11 * b22 - b12 * b12) + 0.25 * pull * sqrt_and_inverse(det).inverse;
      // d energy / d g, twice: what the sides e1 and e2 are pulled by.
      S a11 = 2.0 * (w1 * b11 + by_det * g22), a12 = 2.0 * (w1 * b12 - by_det * g12);
      S a22 = 2.0 * (w1 * b22 + by_det * g11);
      if (a.with_viscosity) {
        a11 += S::load(a.viscous[0] + t), a12 += S::load(a.viscous[1] + t), a22 += S::load(a.viscous[2] + t);
      }
      S along[3] = {S(0.0), S(0.0), S(0.0)};  // of the normal, on the three corners
      if (a.with_moment) {
        const auto moment = [&](int k) { return gathered<S>(a.node_moment, a.corner[k] + t); };
        const S m0 = moment(0), m1 = moment(1), m2 = moment(2);
        const S k0 = 0.5 * (m1 + m2), k1 = 0.5 * (m2 + m0), k2 = 0.5 * (m0 + m1);  // of the edges
        const S c0 = g12, c1 = g11 - g12, c2 = g22 - g12;  // dot products of the sides at the corners
        const S inverse = 1.0 / det;
        along[0] = (k0 * (c1 + c2) - k1 * c2 - k2 * c1) * inverse;
        along[1] = (k1 * (c2 + c0) - k2 * c0 - k0 * c2) * inverse;
        along[2] = (k2 * (c0 + c1) - k0 * c1 - k1 * c0) * inverse;
        const auto turn = [&](int k) { return gathered<S>(a.edge_turn, a.edge[k] + t); };
        const S q0 = k0 * turn(0), q1 = k1 * turn(1), q2 = k2 * turn(2);
        // theta dl of the sides e2 - e1, e2 and e1 in the same form.
        a11 += q2 + q0;
        a12 -= q0;
        a22 += q1 + q0;
      }
      const S push = a.pressure * (1.0 / 6);
      const Vectors<S> first = a11 * one + a12 * two, second = a12 * one + a22 * two;  // pulls on the other corners
      ((push + along[0]) * normal + first + second).store(a.force[0], t);
      ((push + along[1]) * normal - first).store(a.force[1], t);
      ((push + along[2]) * normal - second).store(a.force[2], t);
    }
  }
};

}  // namespace rouleau::core
