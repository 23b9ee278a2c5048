#include "fields.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/relaxation.hpp"
#include "vorticity.hpp"

namespace rouleau::observe {

template <class T>
FieldSnapshot observe_fields(core::Fluid<T>& fluid, const scene::Scene& scene, const units::LatticeUnits& units) {
  const auto wanted = [&](const char* name) {
    const auto& q = scene.output.quantities;
    return std::find(q.begin(), q.end(), name) != q.end();
  };
  const int nx = fluid.setting().domain.size[0], ny = fluid.setting().domain.size[1];
  const scene::FieldStorage& storage = scene.output.field_storage;
  const std::vector<core::Moments> moments = fluid.all_moments();
  const std::vector<double> relaxation_rate =
      wanted("viscosity") ? fluid.all_relaxation_rates() : std::vector<double>{};
  FieldSnapshot f;
  if (moments.empty()) return f;
  f.nx = storage.count(0, nx);
  f.ny = storage.count(1, ny);
  const bool velocity = wanted("velocity"), density = wanted("density"), viscosity = wanted("viscosity");
  const bool vorticity = wanted("vorticity");
  const double speed = units.to_si(1, units::dimension::velocity), rate = units.to_si(1, units::dimension::rate);
  const double viscosity_unit = units.to_si(1, units::dimension::viscosity);
  const auto nodes = static_cast<std::size_t>(f.nx) * static_cast<std::size_t>(f.ny);
  const auto node = [nx](std::size_t x, std::size_t y) { return static_cast<std::size_t>(nx) * y + x; };
  for (auto [want, values] :
       {std::pair{velocity, &f.velocity_x}, std::pair{velocity, &f.velocity_y}, std::pair{density, &f.density},
        std::pair{viscosity, &f.viscosity}, std::pair{vorticity, &f.vorticity}}) {
    if (want) values->reserve(nodes);
  }
  // Beyond a wall lies a row of nodes whose velocities have the wall's as mean with those of the row before it.
  const core::WallVelocity walls = fluid.walls_now();
  const bool periodic_y = fluid.setting().domain.periodic[1];
  const std::size_t below = periodic_y ? 0 : 1;
  const VelocityGrid grid{
      static_cast<std::size_t>(nx), static_cast<std::size_t>(ny) + 2 * below, {1, 1}, {true, periodic_y}};
  const auto u = [&](std::size_t i, std::size_t j) {
    if (!periodic_y && j == 0) return 2 * walls.lower - moments[i].ux;
    if (!periodic_y && j + 1 == grid.ny) return 2 * walls.upper - moments[node(i, static_cast<std::size_t>(ny) - 1)].ux;
    return moments[node(i, j - below)].ux;
  };
  const auto v = [&](std::size_t i, std::size_t j) { return moments[node(i, j - below)].uy; };
  for (int row = 0; row < f.ny; ++row) {
    for (int column = 0; column < f.nx; ++column) {
      const int x = storage.first[0] + column * storage.stride, y = storage.first[1] + row * storage.stride;
      const std::size_t at = node(static_cast<std::size_t>(x), static_cast<std::size_t>(y));
      const core::Moments& m = moments[at];
      if (velocity) {
        f.velocity_x.push_back(m.ux * speed);
        f.velocity_y.push_back(m.uy * speed);
      }
      if (density) f.density.push_back(m.density);
      if (viscosity) f.viscosity.push_back(core::viscosity_of(1 / relaxation_rate[at]) * viscosity_unit);
      if (vorticity) {
        f.vorticity.push_back(grid.vorticity(static_cast<std::size_t>(x), static_cast<std::size_t>(y) + below, u, v) *
                              rate);
      }
    }
  }
  return f;
}

template FieldSnapshot observe_fields(core::Fluid<float>&, const scene::Scene&, const units::LatticeUnits&);
template FieldSnapshot observe_fields(core::Fluid<double>&, const scene::Scene&, const units::LatticeUnits&);

}  // namespace rouleau::observe
