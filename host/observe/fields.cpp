#include "fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/fluid/relaxation.hpp"

namespace rouleau::observe {

namespace {

/// By central differences over two spacings. Beyond a wall half a spacing away the velocity is such that its mean with that
/// of the node before it is the wall's.
template <int D>
class Vorticity {
 public:
  using Node = std::array<int, D>;
  Vorticity(const core::FluidSetting<D>& fluid, const core::WallVelocity& walls,
            const std::vector<core::Moments<D>>& moments)
      : domain_(fluid.domain), solid_(fluid.solid.get()), walls_(walls), moments_(moments) {}

  /// Along z, in three dimensions along x, y and z, at a node of the lattice, lattice units; 0 in the solid.
  [[nodiscard]] std::array<double, D == 2 ? 1 : 3> at(const Node& node) const {
    if (solid_ != nullptr && solid_->at(node)) return {};
    const double along_z = rise(node, 1, 0) - rise(node, 0, 1);
    if constexpr (D == 2) return {along_z};
    if constexpr (D == 3) return {rise(node, 2, 1) - rise(node, 1, 2), rise(node, 0, 2) - rise(node, 2, 0), along_z};
  }

 private:
  /// d velocity[component] / d axis
  [[nodiscard]] double rise(const Node& node, std::size_t component, int axis) const {
    return (beside(node, component, axis, 1) - beside(node, component, axis, -1)) / 2;
  }
  [[nodiscard]] double beside(Node node, std::size_t component, int axis, int step) const {
    const double own = velocity(node, component);
    const auto k = static_cast<std::size_t>(axis);
    node[k] = domain_.wrapped(axis, node[k] + step);
    const double upper_or_lower = step > 0 ? walls_.upper : walls_.lower;
    if (node[k] < 0) return 2 * (axis == 1 && component == 0 ? upper_or_lower : 0) - own;
    if (solid_ != nullptr && solid_->at(node)) return -own;
    return velocity(node, component);
  }
  [[nodiscard]] double velocity(const Node& node, std::size_t component) const {
    std::size_t place = 0;
    for (std::size_t k = D; k-- > 0;)
      place = place * static_cast<std::size_t>(domain_.size[k]) + static_cast<std::size_t>(node[k]);
    return moments_[place].velocity[component];
  }

  const core::Domain<D>& domain_;
  const core::SolidNodes<D>* solid_;
  core::WallVelocity walls_;
  const std::vector<core::Moments<D>>& moments_;
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
  const Vorticity<dimension> curl(fluid.setting(), fluid.walls_now(), moments);
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
        if (!vorticity) continue;
        std::array<int, dimension> place{static_cast<int>(x), static_cast<int>(y)};
        if constexpr (dimension == 3) place[2] = z;
        const auto along = curl.at(place);
        if constexpr (dimension == 3)
          f.vorticity_x.push_back(along[0] * rate), f.vorticity_y.push_back(along[1] * rate);
        f.vorticity_z.push_back(along.back() * rate);
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
