#include "fields.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/relaxation.hpp"

namespace rouleau::observe {

template <class T>
FieldSnapshot observe_fields(core::Fluid<T>& fluid, const scene::Scene& scene, const units::LatticeUnits& units) {
  const auto wanted = [&](const char* name) {
    const auto& q = scene.output.quantities;
    return std::find(q.begin(), q.end(), name) != q.end();
  };
  const int nx = fluid.setting().nx, ny = fluid.setting().ny;
  const scene::FieldStorage& storage = scene.output.field_storage;
  FieldSnapshot f;
  f.nx = storage.count(0, nx);
  f.ny = storage.count(1, ny);
  const bool velocity = wanted("velocity"), density = wanted("density"), viscosity = wanted("viscosity");
  const bool vorticity = wanted("vorticity");
  const double speed = units.to_si(1, units::dimension::velocity), rate = units.to_si(1, units::dimension::rate);
  const double viscosity_unit = units.to_si(1, units::dimension::viscosity);
  const auto nodes = static_cast<std::size_t>(f.nx) * static_cast<std::size_t>(f.ny);
  std::vector<std::vector<core::Moments>> rows(static_cast<std::size_t>(ny));
  for (int y = 0; y < ny; ++y) fluid.moments(y, rows[static_cast<std::size_t>(y)]);
  for (auto [want, values] :
       {std::pair{velocity, &f.velocity_x}, std::pair{velocity, &f.velocity_y}, std::pair{density, &f.density},
        std::pair{viscosity, &f.viscosity}, std::pair{vorticity, &f.vorticity}}) {
    if (want) values->reserve(nodes);
  }
  const core::WallVelocity& walls = fluid.setting().walls;
  for (int row = 0; row < f.ny; ++row) {
    for (int column = 0; column < f.nx; ++column) {
      const int x = storage.first[0] + column * storage.stride, y = storage.first[1] + row * storage.stride;
      const core::Moments& m = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      if (velocity) {
        f.velocity_x.push_back(m.ux * speed);
        f.velocity_y.push_back(m.uy * speed);
      }
      if (density) f.density.push_back(m.density);
      if (viscosity) {
        double relaxation = fluid.setting().relaxation_rate;
        if (fluid.setting().viscosity_contrast && fluid.activity().active(x, y)) {
          relaxation = static_cast<double>(fluid.relaxation_rate().row(y)[x]);
        }
        f.viscosity.push_back(core::viscosity_of(1 / relaxation) * viscosity_unit);
      }
      if (vorticity) {
        const auto at = [&](int i, int j) -> const core::Moments& {
          return rows[static_cast<std::size_t>(j)][static_cast<std::size_t>((i + nx) % nx)];
        };
        const auto ux = [&](int j) {
          if (fluid.setting().periodic_y) return at(x, (j + ny) % ny).ux;
          if (j < 0) return 2 * walls.lower - m.ux;
          if (j >= ny) return 2 * walls.upper - m.ux;
          return at(x, j).ux;
        };
        const double curl = (at(x + 1, y).uy - at(x - 1, y).uy) / 2 - (ux(y + 1) - ux(y - 1)) / 2;
        f.vorticity.push_back(curl * rate);
      }
    }
  }
  return f;
}

template FieldSnapshot observe_fields(core::Fluid<float>&, const scene::Scene&, const units::LatticeUnits&);
template FieldSnapshot observe_fields(core::Fluid<double>&, const scene::Scene&, const units::LatticeUnits&);

}  // namespace rouleau::observe
