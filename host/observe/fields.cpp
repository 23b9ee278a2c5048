#include "fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/fluid/relaxation.hpp"
#include "vorticity.hpp"

namespace rouleau::observe {

namespace {

/// Vorticity in three dimensions, by central differences over two spacings. Beyond a wall half a spacing away the velocity
/// is such that its mean with that of the node before it is the wall's.
class Curl {
 public:
  Curl(const core::FluidSetting<3>& fluid, const core::WallVelocity& walls,
       const std::vector<core::Moments<3>>& moments)
      : domain_(fluid.domain), solid_(fluid.solid.get()), walls_(walls), moments_(moments) {}

  /// At a node of the lattice, lattice units; 0 in the solid.
  [[nodiscard]] std::array<double, 3> at(const std::array<int, 3>& node) const {
    if (solid_ != nullptr && solid_->at(node)) return {0, 0, 0};
    return {rise(node, 2, 1) - rise(node, 1, 2), rise(node, 0, 2) - rise(node, 2, 0),
            rise(node, 1, 0) - rise(node, 0, 1)};
  }

 private:
  /// d velocity[component] / d axis
  [[nodiscard]] double rise(const std::array<int, 3>& node, std::size_t component, int axis) const {
    return (beside(node, component, axis, 1) - beside(node, component, axis, -1)) / 2;
  }
  [[nodiscard]] double beside(std::array<int, 3> node, std::size_t component, int axis, int step) const {
    const double own = velocity(node, component);
    const auto k = static_cast<std::size_t>(axis);
    node[k] = domain_.wrapped(axis, node[k] + step);
    const double upper_or_lower = step > 0 ? walls_.upper : walls_.lower;
    if (node[k] < 0) return 2 * (axis == 1 && component == 0 ? upper_or_lower : 0) - own;
    if (solid_ != nullptr && solid_->at(node)) return -own;
    return velocity(node, component);
  }
  [[nodiscard]] double velocity(const std::array<int, 3>& node, std::size_t component) const {
    const auto row = static_cast<std::size_t>(node[2]) * static_cast<std::size_t>(domain_.size[1]) +
                     static_cast<std::size_t>(node[1]);
    return moments_[row * static_cast<std::size_t>(domain_.size[0]) + static_cast<std::size_t>(node[0])]
        .velocity[component];
  }

  const core::Domain<3>& domain_;
  const core::SolidNodes<3>* solid_;
  core::WallVelocity walls_;
  const std::vector<core::Moments<3>>& moments_;
};

}  // namespace

template <class T, class Set>
FieldSnapshot observe_fields(core::Fluid<T, Set>& fluid, const scene::Scene& scene, const units::LatticeUnits& units) {
  constexpr int dimension = Set::dimension;
  const auto wanted = [&](const char* name) {
    const auto& q = scene.output.quantities;
    return std::find(q.begin(), q.end(), name) != q.end();
  };
  const std::array<int, dimension>& size = fluid.setting().domain.size;
  const scene::FieldStorage& storage = scene.output.field_storage;
  const std::vector<core::Moments<dimension>> moments = fluid.all_moments();
  const std::vector<double> relaxation_rate =
      wanted("viscosity") ? fluid.all_relaxation_rates() : std::vector<double>{};
  FieldSnapshot f;
  if (moments.empty()) return f;
  f.nx = storage.count(0, size[0]);
  f.ny = storage.count(1, size[1]);
  if constexpr (dimension == 3) f.nz = storage.count(2, size[2]);
  const bool velocity = wanted("velocity"), density = wanted("density"), viscosity = wanted("viscosity");
  const bool vorticity = wanted("vorticity");
  const double speed = units.to_si(1, units::dimension::velocity), rate = units.to_si(1, units::dimension::rate);
  const double viscosity_unit = units.to_si(1, units::dimension::viscosity);
  const auto nodes = static_cast<std::size_t>(f.nx) * static_cast<std::size_t>(f.ny) * static_cast<std::size_t>(f.nz);
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
  const auto node = [nx](std::size_t x, std::size_t y) { return nx * y + x; };
  for (auto [want, values] :
       {std::pair{velocity, &f.velocity_x}, std::pair{velocity, &f.velocity_y},
        std::pair{velocity && dimension == 3, &f.velocity_z}, std::pair{density, &f.density},
        std::pair{viscosity, &f.viscosity}, std::pair{vorticity && dimension == 3, &f.vorticity_x},
        std::pair{vorticity && dimension == 3, &f.vorticity_y}, std::pair{vorticity, &f.vorticity_z}}) {
    if (want) values->reserve(nodes);
  }
  // Beyond a wall lies a row of nodes whose velocities have the wall's as mean with those of the row before it.
  const core::WallVelocity walls = fluid.walls_now();
  const bool periodic_y = fluid.setting().domain.periodic[1];
  const std::size_t below = periodic_y ? 0 : 1;
  const VelocityGrid grid{nx, ny + 2 * below, {1, 1}, {true, periodic_y}};
  const auto u = [&](std::size_t i, std::size_t j) {
    if (!periodic_y && j == 0) return 2 * walls.lower - moments[i].velocity[0];
    if (!periodic_y && j + 1 == grid.ny) return 2 * walls.upper - moments[node(i, ny - 1)].velocity[0];
    return moments[node(i, j - below)].velocity[0];
  };
  const auto v = [&](std::size_t i, std::size_t j) { return moments[node(i, j - below)].velocity[1]; };
  for (int layer = 0; layer < f.nz; ++layer) {
    const int z = storage.first[2] + layer * storage.stride;
    const std::size_t first_of_layer = static_cast<std::size_t>(z) * nx * ny;
    for (int row = 0; row < f.ny; ++row) {
      for (int column = 0; column < f.nx; ++column) {
        const auto x = static_cast<std::size_t>(storage.first[0] + column * storage.stride),
                   y = static_cast<std::size_t>(storage.first[1] + row * storage.stride);
        const std::size_t at = first_of_layer + node(x, y);
        const core::Moments<dimension>& m = moments[at];
        if (velocity) {
          f.velocity_x.push_back(m.velocity[0] * speed);
          f.velocity_y.push_back(m.velocity[1] * speed);
          if constexpr (dimension == 3) f.velocity_z.push_back(m.velocity[2] * speed);
        }
        if (density) f.density.push_back(m.density);
        if (viscosity) f.viscosity.push_back(core::viscosity_of(1 / relaxation_rate[at]) * viscosity_unit);
        if constexpr (dimension == 2) {
          if (vorticity) f.vorticity_z.push_back(grid.vorticity(x, y + below, u, v) * rate);
        } else if (vorticity) {
          const auto along = Curl(fluid.setting(), walls, moments).at({static_cast<int>(x), static_cast<int>(y), z});
          f.vorticity_x.push_back(along[0] * rate);
          f.vorticity_y.push_back(along[1] * rate);
          f.vorticity_z.push_back(along[2] * rate);
        }
      }
    }
  }
  return f;
}

template FieldSnapshot observe_fields(core::Fluid<float>&, const scene::Scene&, const units::LatticeUnits&);
template FieldSnapshot observe_fields(core::Fluid<double>&, const scene::Scene&, const units::LatticeUnits&);
template FieldSnapshot observe_fields(core::Fluid<float, core::D3Q19>&, const scene::Scene&,
                                      const units::LatticeUnits&);
template FieldSnapshot observe_fields(core::Fluid<double, core::D3Q19>&, const scene::Scene&,
                                      const units::LatticeUnits&);

}  // namespace rouleau::observe
