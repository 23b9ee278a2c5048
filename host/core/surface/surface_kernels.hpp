// The loops over the triangles and edges of one cell that its membrane forces consist of, for any width of vector
// registers. Arrays have room for a whole pack behind their end.
#pragma once

#include <rouleau/pack.hpp>

#include "core/membrane/turning_angle.hpp"

namespace rouleau::core {

struct SurfaceArrays {
  int triangles, edges;
  // of triangles
  const double* side[6];     ///< x, y, z of the side from the first to the second node, then of that to the third
  const double* inverse[3];  ///< metric at rest: 11, 12, 22
  const double* rest_area;
  double *invariant_1, *invariant_2;
  double* normal[3];  ///< twice the area along the outer normal
  const double *stress_1, *stress_2;
  const double* moment[3];     ///< at the three nodes
  const double* turn[3];       ///< turning angle over twice the length, of the edges opposite to the three nodes
  const double* area_pull[3];  ///< d energy / d area that the three nodes add
  double* force[9];            ///< on the first, second and third node: x, y, z
  // of edges
  const double* along[3];             ///< from node a to node b
  const double* normals[6];           ///< of the left and the right triangle
  double *turned_length, *edge_turn;  ///< length times turning angle; turning angle over twice the length
  bool with_moment, with_area_pull;
  double pressure, surface_tension;
};

/// Triangles: normals and the invariants of their stretches.
struct MeasureTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SurfaceArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const S ax = S::load(a.side[0] + t), ay = S::load(a.side[1] + t), az = S::load(a.side[2] + t);
      const S bx = S::load(a.side[3] + t), by = S::load(a.side[4] + t), bz = S::load(a.side[5] + t);
      const S nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
      nx.store(a.normal[0] + t);
      ny.store(a.normal[1] + t);
      nz.store(a.normal[2] + t);
      const S g11 = ax * ax + ay * ay + az * az, g12 = ax * bx + ay * by + az * bz, g22 = bx * bx + by * by + bz * bz;
      const S b11 = S::load(a.inverse[0] + t), b12 = S::load(a.inverse[1] + t), b22 = S::load(a.inverse[2] + t);
      (b11 * g11 + 2.0 * b12 * g12 + b22 * g22 - 2.0).store(a.invariant_1 + t);
      ((b11 * b22 - b12 * b12) * (nx * nx + ny * ny + nz * nz) - 1.0).store(a.invariant_2 + t);
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
      const S ux = S::load(a.along[0] + e), uy = S::load(a.along[1] + e), uz = S::load(a.along[2] + e);
      const S lx = S::load(a.normals[0] + e), ly = S::load(a.normals[1] + e), lz = S::load(a.normals[2] + e);
      const S rx = S::load(a.normals[3] + e), ry = S::load(a.normals[4] + e), rz = S::load(a.normals[5] + e);
      const SquareRoot<S> length = sqrt_and_inverse(ux * ux + uy * uy + uz * uz);
      const S both = sqrt_and_inverse((lx * lx + ly * ly + lz * lz) * (rx * rx + ry * ry + rz * rz)).inverse;
      const S triple = ux * (ly * rz - lz * ry) + uy * (lz * rx - lx * rz) + uz * (lx * ry - ly * rx);
      const S angle = turning_angle(triple * length.inverse * both, (lx * rx + ly * ry + lz * rz) * both);
      (length.root * angle).store(a.turned_length + e);
      (0.5 * angle * length.inverse).store(a.edge_turn + e);
    }
  }
};

/// Forces on the corners of triangles, minus the gradient of the energy.
/// With the metric g of the sides e1, e2 and its inverse B at rest, d I1 = B : dg and d I2 = det B d det g; of the surface
/// d area = d det g / (4 sqrt det g), of the volume the normal over 6 at each corner. Of an edge, energy changes with
/// m d(l theta), m the mean of the moments at its ends: theta turns with the distance of the opposite corners from it, and
/// either triangle takes half of what dl brings.
struct ActOnTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const SurfaceArrays a = *arrays;
    for (int t = 0; t < a.triangles; t += S::size) {
      const S one[3] = {S::load(a.side[0] + t), S::load(a.side[1] + t), S::load(a.side[2] + t)};
      const S two[3] = {S::load(a.side[3] + t), S::load(a.side[4] + t), S::load(a.side[5] + t)};
      const S normal[3] = {S::load(a.normal[0] + t), S::load(a.normal[1] + t), S::load(a.normal[2] + t)};
      const S g11 = dot(one, one), g12 = dot(one, two), g22 = dot(two, two), det = dot(normal, normal);
      const S b11 = S::load(a.inverse[0] + t), b12 = S::load(a.inverse[1] + t), b22 = S::load(a.inverse[2] + t);
      const S area = S::load(a.rest_area + t), w1 = area * S::load(a.stress_1 + t), w2 = area * S::load(a.stress_2 + t);
      S pull = a.surface_tension;
      if (a.with_area_pull) {
        pull += S::load(a.area_pull[0] + t) + S::load(a.area_pull[1] + t) + S::load(a.area_pull[2] + t);
      }
      const S by_det = w2 * (b11 * b22 - b12 * b12) + 0.25 * pull * sqrt_and_inverse(det).inverse;
      // d energy / d g, twice: what the sides e1 and e2 are pulled by.
      S a11 = 2.0 * (w1 * b11 + by_det * g22), a12 = 2.0 * (w1 * b12 - by_det * g12);
      S a22 = 2.0 * (w1 * b22 + by_det * g11);
      S along[3] = {S(0.0), S(0.0), S(0.0)};  // of the normal, on the three corners
      if (a.with_moment) {
        const S m0 = S::load(a.moment[0] + t), m1 = S::load(a.moment[1] + t), m2 = S::load(a.moment[2] + t);
        const S k0 = 0.5 * (m1 + m2), k1 = 0.5 * (m2 + m0), k2 = 0.5 * (m0 + m1);  // of the edges
        const S c0 = g12, c1 = g11 - g12, c2 = g22 - g12;  // dot products of the sides at the corners
        const S inverse = 1.0 / det;
        along[0] = (k0 * (c1 + c2) - k1 * c2 - k2 * c1) * inverse;
        along[1] = (k1 * (c2 + c0) - k2 * c0 - k0 * c2) * inverse;
        along[2] = (k2 * (c0 + c1) - k0 * c1 - k1 * c0) * inverse;
        const S q0 = k0 * S::load(a.turn[0] + t), q1 = k1 * S::load(a.turn[1] + t), q2 = k2 * S::load(a.turn[2] + t);
        // theta dl of the sides e2 - e1, e2 and e1 in the same form.
        a11 += q2 + q0;
        a12 -= q0;
        a22 += q1 + q0;
      }
      const S push = a.pressure * (1.0 / 6);
      for (int k = 0; k < 3; ++k) {
        const S f1 = -(a11 * one[k] + a12 * two[k]), f2 = -(a12 * one[k] + a22 * two[k]);
        ((push + along[0]) * normal[k] - f1 - f2).store(a.force[k] + t);
        ((push + along[1]) * normal[k] + f1).store(a.force[3 + k] + t);
        ((push + along[2]) * normal[k] + f2).store(a.force[6 + k] + t);
      }
    }
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static S dot(const S (&a)[3], const S (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
};

}  // namespace rouleau::core
