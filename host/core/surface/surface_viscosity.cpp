#include "surface_viscosity.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "core/domain/run_loop.hpp"
#include "core/domain/vectors.hpp"

namespace rouleau::core {

namespace {

struct StrainArrays {
  SurfaceArrays surface;  ///< triangles, corners, sides and normals
  const double *viscosity[2], *velocity[3];
  double* stress[6];
  double compliance;  ///< 1/G
};

/// One step of the stress of triangles.
struct StrainTriangles {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const StrainArrays* arrays) {
    using S = Pack<double, register_bytes / 8>;
    const StrainArrays a = *arrays;
    for (int t = 0; t < a.surface.triangles; t += S::size) {
      const Vectors<S> one = Vectors<S>::load(a.surface.side[0], t), two = Vectors<S>::load(a.surface.side[1], t);
      const auto motion = [&](int k) { return Vectors<S>::gather(a.velocity, a.surface.corner[k] + t); };
      const Vectors<S> first = motion(0), by_one = motion(1) - first, by_two = motion(2) - first;
      const Vectors<S> normal = Vectors<S>::load(a.surface.normal, t);
      const SquareRoot<S> twice_area = sqrt_and_inverse(dot(normal, normal));
      const S inverse = twice_area.inverse * twice_area.inverse;
      const S h11 = dot(two, two) * inverse, h12 = -dot(one, two) * inverse, h22 = dot(one, one) * inverse;
      const S d11 = dot(one, by_one), d22 = dot(two, by_two), d12 = 0.5 * (dot(one, by_two) + dot(two, by_one));
      const S m = S::load(a.viscosity[0] + t), k = S::load(a.viscosity[1] + t);
      const S shear = twice_area.root * m;
      const S trace = 0.5 * twice_area.root * (k - m) * (h11 * d11 + 2.0 * h12 * d12 + h22 * d22);
      const S m11 = h11 * d11 + h12 * d12, m12 = h11 * d12 + h12 * d22;  // one index raised
      const S m21 = h12 * d11 + h22 * d12, m22 = h12 * d12 + h22 * d22;
      const S lag = a.compliance * (m + k), more = lag + 1.0, share = 1.0 / more, whole = 1.0 / (lag * more + 1.0);
      const auto step = [&](int component, const S& viscous) {
        double *const stress = a.stress[component] + t, *const dashpot = a.stress[component + 3] + t;
        const S before = S::load(dashpot), now = (more * (lag * S::load(stress) + viscous) - lag * before) * whole;
        now.store(stress), ((lag * before + now) * share).store(dashpot);
      };
      step(0, shear * (m11 * h11 + m12 * h12) + trace * h11);
      step(1, shear * (m11 * h12 + m12 * h22) + trace * h12);
      step(2, shear * (m21 * h12 + m22 * h22) + trace * h22);
    }
  }
};

constexpr std::size_t components = 6;

/// Calls `exchange` with each variable of the state, the number of the component that it has, and which triangles:
/// there are about twice as many as places, those of the nodes, so that more than one variable has a component.
template <class Exchange>
void for_each_variable(const std::vector<std::size_t>& variables, int triangles, int nodes, const Exchange& exchange) {
  for (std::size_t k = 0; k < variables.size(); ++k) {
    const int first = nodes * static_cast<int>(k / components);
    exchange(variables[k], k % components, first, std::min(nodes, triangles - first));
  }
}

}  // namespace

void SurfaceViscosity::Room::resize(std::size_t triangles) {
  for (auto& array : viscosity) array.assign(triangles, 0.0);
  for (auto& array : stress) array.assign(triangles, 0.0);
}

SurfaceViscosity::SurfaceViscosity(Surfaces& surfaces, int type, double modulus, double tension_unit)
    : modulus_(modulus) {
  constexpr std::array names{"viscous_stress_11", "viscous_stress_12", "viscous_stress_22",
                             "dashpot_stress_11", "dashpot_stress_12", "dashpot_stress_22"};
  const Mesh& mesh = surfaces.types[type]->mesh;
  for (int first = 0; first < mesh.triangle_count(); first += mesh.node_count()) {
    for (const std::string name : names) {
      // An area times a stress, over squares of sides, has the unit of a tension.
      stress_.push_back(keep_state(
          surfaces.state,
          {type, -1, "", first == 0 ? name : name + "_" + std::to_string(first / mesh.node_count()), tension_unit, {}},
          0, surfaces.position[0].size()));
    }
  }
}

void SurfaceViscosity::step(const PaddedTriangles& mesh, const SurfaceArrays& surface, Surfaces& surfaces,
                            const CellRange& cell, Room& room) const {
  for_each_variable(stress_, mesh.count, cell.count, [&](std::size_t variable, std::size_t k, int first, int count) {
    std::copy_n(&surfaces.state[variable].value[cell.first], count, &room.stress[k][first]);
  });
  StrainArrays arrays{};
  arrays.surface = surface;
  point_into(arrays.viscosity, room.viscosity), point_into(arrays.stress, room.stress);
  for (std::size_t k = 0; k < 3; ++k) arrays.velocity[k] = &surfaces.velocity[k][cell.first];
  arrays.compliance = 1 / modulus_;
  run_loop<StrainTriangles>(arrays);
  for_each_variable(stress_, mesh.count, cell.count, [&](std::size_t variable, std::size_t k, int first, int count) {
    std::copy_n(&room.stress[k][first], count, &surfaces.state[variable].value[cell.first]);
  });
}

double SurfaceViscosity::power(const PaddedTriangles& mesh, const SurfaceArrays& surface, const Surfaces& surfaces,
                               const CellRange& cell) const {
  const auto along = [&](const double* const* sides, int t) { return Vec<3>(sides[0][t], sides[1][t], sides[2][t]); };
  double power = 0;
  for_each_variable(stress_, mesh.count, cell.count, [&](std::size_t variable, std::size_t k, int first, int count) {
    for (int t = first; t < first + count && k < 3; ++t) {
      const auto motion = [&](int corner) {
        const int i = cell.first + mesh.corner[corner][t], o = cell.first + mesh.corner[0][t];
        return Vec<3>(surfaces.velocity[0][i] - surfaces.velocity[0][o],
                      surfaces.velocity[1][i] - surfaces.velocity[1][o],
                      surfaces.velocity[2][i] - surfaces.velocity[2][o]);
      };
      const Vec<3> one = along(surface.side[0], t), two = along(surface.side[1], t);
      const double rate[3] = {one.dot(motion(1)), one.dot(motion(2)) + two.dot(motion(1)), two.dot(motion(2))};
      power += surfaces.state[variable].value[cell.first + t - first] * rate[k];
    }
  });
  return power;
}

double viscous_modulus(double viscosity, const KernelResponse& response) {
  constexpr double largest = 0.5, over_viscosity = 10;
  return std::min(largest, over_viscosity * viscosity) * KernelResponse{}.stretching / response.stretching;
}

}  // namespace rouleau::core
