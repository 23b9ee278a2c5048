#include "surface_viscosity.hpp"

#include <algorithm>

#include "core/domain/run_loop.hpp"
#include "core/domain/vectors.hpp"

namespace rouleau::core {

namespace {

/// Of the residual over the larger of the old and the new force: as close as forces of the membrane are to their values
/// at the end of a step.
constexpr double tolerance = 1e-3;
constexpr int most_iterations = 200;

/// Velocity that a node gains in a step from a force of 1 for each unit of its area, as viscous forces take it: that of
/// outlines (rate_mobility).
constexpr double mobility = 4;

struct StrainArrays {
  SurfaceArrays surface;  ///< triangles, corners, sides and normals
  const double *viscosity[2], *velocity[3];
  double *stress[3], *on_corner[3];  ///< T A along the sides; forces on the first corners, then on the others
  int corners_apart;
  bool strains;  ///< whether the stress is that of the velocity; else it is given
};

/// Stress of a motion, and the forces on the corners.
struct StrainTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const StrainArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const StrainArrays a = *arrays;
    for (int t = 0; t < a.surface.triangles; t += S::size) {
      const Vectors<S> one = Vectors<S>::load(a.surface.side[0], t), two = Vectors<S>::load(a.surface.side[1], t);
      S a11, a12, a22;
      if (a.strains) {
        const auto motion = [&](int k) { return Vectors<S>::gather(a.velocity, a.surface.corner[k] + t); };
        const Vectors<S> first = motion(0), by_one = motion(1) - first, by_two = motion(2) - first;
        const Vectors<S> normal = Vectors<S>::load(a.surface.normal, t);
        const S det = dot(normal, normal), inverse = 1.0 / det;
        const S h11 = dot(two, two) * inverse, h12 = -dot(one, two) * inverse, h22 = dot(one, one) * inverse;
        const S d11 = dot(one, by_one), d22 = dot(two, by_two), d12 = 0.5 * (dot(one, by_two) + dot(two, by_one));
        const S area = 0.5 * sqrt_and_inverse(det).root;
        const S shear = 2.0 * area * S::load(a.viscosity[0] + t);
        const S trace = (area * S::load(a.viscosity[1] + t) - 0.5 * shear) * (h11 * d11 + 2.0 * h12 * d12 + h22 * d22);
        const S m11 = h11 * d11 + h12 * d12, m12 = h11 * d12 + h12 * d22;  // one index raised
        const S m21 = h12 * d11 + h22 * d12, m22 = h12 * d12 + h22 * d22;
        a11 = shear * (m11 * h11 + m12 * h12) + trace * h11;
        a12 = shear * (m11 * h12 + m12 * h22) + trace * h12;
        a22 = shear * (m21 * h12 + m22 * h22) + trace * h22;
        a11.store(a.stress[0] + t), a12.store(a.stress[1] + t), a22.store(a.stress[2] + t);
      } else {
        a11 = S::load(a.stress[0] + t), a12 = S::load(a.stress[1] + t), a22 = S::load(a.stress[2] + t);
      }
      const Vectors<S> first = a11 * one + a12 * two, second = a12 * one + a22 * two;
      const auto on = [&](int k, const Vectors<S>& force) { force.store(a.on_corner, k * a.corners_apart + t); };
      on(0, first + second), on(1, S(-1.0) * first), on(2, S(-1.0) * second);
    }
  }
};

/// Four sums that do not wait for each other.
template <class Term>
double sum_of(std::size_t count, const Term& term) {
  double sum[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += term(i + k);
  }
  for (; i < count; ++i) sum[0] += term(i);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

using Vectors3 = std::vector<double>[3];
using Pointers = std::array<const double*, 3>;

double product(const Vectors3& a, const Vectors3& b) {
  return sum_of(a[0].size(), [&](std::size_t i) { return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i]; });
}

Pointers pointers_to(const Vectors3& vectors) { return {vectors[0].data(), vectors[1].data(), vectors[2].data()}; }

StrainArrays arrays_of(const PaddedTriangles& mesh, const SurfaceArrays& surface, SurfaceViscosity::Room& room) {
  for (auto* vectors : {&room.force, &room.residual, &room.search}) {
    for (auto& array : *vectors) array.resize(mesh.corners.first.size() - 1);
  }
  StrainArrays arrays{};
  arrays.surface = surface;
  arrays.corners_apart = mesh.size;
  point_into(arrays.viscosity, room.viscosity), point_into(arrays.stress, room.stress);
  point_into(arrays.on_corner, room.on_corner);
  return arrays;
}

void sum_corners(const PaddedTriangles& mesh, const StrainArrays& arrays, Vectors3& force) {
  const Pointers of_corners{arrays.on_corner[0], arrays.on_corner[1], arrays.on_corner[2]};
  for (std::size_t i = 0; i < force[0].size(); ++i) {
    const auto [x, y, z] = mesh.sums_of_corners(of_corners, static_cast<int>(i));
    force[0][i] = x, force[1][i] = y, force[2][i] = z;
  }
}

/// Forces of the present stress.
void forces_of_stress(const PaddedTriangles& mesh, StrainArrays arrays, Vectors3& force) {
  arrays.strains = false;
  run_loop<StrainTriangles>(arrays);
  sum_corners(mesh, arrays, force);
}

/// Stress of a motion, and its forces.
void strain(const PaddedTriangles& mesh, StrainArrays arrays, const Pointers& velocity, double* const (&stress)[3],
            Vectors3& force) {
  arrays.strains = true;
  for (std::size_t k = 0; k < 3; ++k) arrays.velocity[k] = velocity[k], arrays.stress[k] = stress[k];
  run_loop<StrainTriangles>(arrays);
  sum_corners(mesh, arrays, force);
}

Pointers motion_of(const Surfaces& surfaces, const CellRange& cell) {
  return {&surfaces.velocity[0][cell.first], &surfaces.velocity[1][cell.first], &surfaces.velocity[2][cell.first]};
}

/// Calls `exchange` with the numbers of each component that a variable of the state has: places of the nodes hold the
/// first triangles in three variables, the others, of which there are fewer than nodes, in three more.
template <class Exchange>
void for_each_variable(int triangles, int nodes, const Exchange& exchange) {
  for (std::size_t k = 0; k < 6; ++k) {
    const int first = k < 3 ? 0 : nodes;
    exchange(k, k % 3, first, std::min(nodes, triangles - first));
  }
}

}  // namespace

void SurfaceViscosity::Room::resize(std::size_t triangles) {
  for (auto* vectors : {&stress, &change}) {
    for (auto& array : *vectors) array.assign(triangles, 0.0);
  }
  for (auto& array : viscosity) array.assign(triangles, 0.0);
  for (auto& array : on_corner) array.assign(3 * triangles, 0.0);
}

SurfaceViscosity::SurfaceViscosity(Surfaces& surfaces, int type, double gain, double tension_unit) {
  constexpr std::array names{"viscous_stress_11",      "viscous_stress_12",      "viscous_stress_22",
                             "viscous_stress_11_more", "viscous_stress_12_more", "viscous_stress_22_more"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    // An area times a stress, over squares of sides, has the unit of a tension.
    stress_[k] = keep_state(surfaces.state, {type, -1, "", names[k], tension_unit, {}}, 0, surfaces.position[0].size());
  }
  for (const double area : surfaces.types[type]->node_area) inverse_mobility_.push_back(area / (mobility * gain));
}

void SurfaceViscosity::take_stress(const PaddedTriangles& mesh, const Surfaces& surfaces, const CellRange& cell,
                                   Room& room) const {
  for_each_variable(mesh.count, cell.count, [&](std::size_t variable, std::size_t component, int first, int count) {
    std::copy_n(&surfaces.state[stress_[variable]].value[cell.first], count, &room.stress[component][first]);
  });
}

void SurfaceViscosity::step(const PaddedTriangles& mesh, const SurfaceArrays& surface, Surfaces& surfaces,
                            const CellRange& cell, Room& room) const {
  take_stress(mesh, surfaces, cell, room);
  const StrainArrays arrays = arrays_of(mesh, surface, room);
  auto& [viscosity, stress, change, on_corner, force, residual, search] = room;
  forces_of_stress(mesh, arrays, force);
  const double old = product(force, force);
  strain(mesh, arrays, motion_of(surfaces, cell), arrays.stress, residual);
  const double limit = tolerance * tolerance * std::max(old, tolerance * tolerance * product(residual, residual));
  const std::size_t nodes = inverse_mobility_.size();
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) search[k][i] = residual[k][i] -= force[k][i];
  }
  double* of_search[3];
  point_into(of_search, change);
  double square = product(residual, residual);
  for (int iteration = 0; iteration < most_iterations && square > limit; ++iteration) {
    strain(mesh, arrays, pointers_to(search), of_search, force);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < nodes; ++i) force[k][i] = inverse_mobility_[i] * search[k][i] - force[k][i];
    }
    const double share = square / product(search, force), before = square;
    for (std::size_t k = 0; k < 3; ++k) {
      for (int t = 0; t < mesh.count; ++t) stress[k][t] += share * change[k][t];
      for (std::size_t i = 0; i < nodes; ++i) residual[k][i] -= share * force[k][i];
    }
    square = product(residual, residual);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < nodes; ++i) search[k][i] = residual[k][i] + square / before * search[k][i];
    }
  }
  for_each_variable(mesh.count, cell.count, [&](std::size_t variable, std::size_t component, int first, int count) {
    std::copy_n(&stress[component][first], count, &surfaces.state[stress_[variable]].value[cell.first]);
  });
}

double SurfaceViscosity::power(const PaddedTriangles& mesh, const SurfaceArrays& surface, const Surfaces& surfaces,
                               const CellRange& cell, Room& room) const {
  take_stress(mesh, surfaces, cell, room);
  forces_of_stress(mesh, arrays_of(mesh, surface, room), room.force);
  const Pointers v = motion_of(surfaces, cell);
  const Vectors3& f = room.force;
  return -sum_of(f[0].size(), [&](std::size_t i) { return f[0][i] * v[0][i] + f[1][i] * v[1][i] + f[2][i] * v[2][i]; });
}

}  // namespace rouleau::core
