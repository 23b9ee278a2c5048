#include "cell_methods.hpp"

#include <cmath>
#include <numbers>

#include "core/membrane/stiffness.hpp"

namespace rouleau::core {

namespace {

constexpr double slight_strain = 1e-3;

Stiffness stiffness_of(const MembraneLaws& laws) {
  Stiffness sum;
  for (const MembraneLaw& law : laws) sum += law;
  return sum;
}

template <int D>
std::vector<MembraneLaws> laws_of(const BasicSolverSetup<D>& setup) {
  std::vector<MembraneLaws> laws;
  for (const CellType& type : setup.cell_types) laws.push_back(type.laws);
  return laws;
}

/// Second difference of a type's energy when its shape is stretched along x.
double energy_of_strain(const std::shared_ptr<const RestSurface>& rest, const MembraneLaws& laws, double strain) {
  MembraneLaws without_volume;
  for (const MembraneLaw& law : laws)
    if (!law.reads("volume")) without_volume.push_back(law);
  Surfaces one;
  one.types = {rest};
  add_cell(one, 0, Vec<3>::Zero());
  SurfaceForces forces(one, {without_volume});
  double sum = -2 * forces.energy(one);
  for (const double side : {-1.0, 1.0}) {
    Surfaces strained = one;
    for (double& x : strained.position[0]) x *= 1 + side * strain;
    sum += forces.energy(strained);
  }
  return std::abs(sum) / 2;
}

}  // namespace

std::unique_ptr<SlipCorrection> make_slip(const SolverSetup& setup, const Membranes& membranes) {
  if (!setup.slip_correction) return nullptr;
  std::vector<SlipCorrection::Type> types;
  for (const CellType& type : setup.cell_types) {
    const Stiffness stiffness = stiffness_of(type.laws);
    types.push_back({slip_constants(setup.kernel, type.viscosity_ratio, 2), stiffness.stretching, stiffness.bending});
  }
  return std::make_unique<SlipCorrection>(membranes, std::move(types), setup.viscosity());
}

std::unique_ptr<SurfaceSlip> make_slip(const BasicSolverSetup<3>& setup, const Surfaces& surfaces) {
  if (!setup.slip_correction) return nullptr;
  std::vector<SurfaceSlip::Type> types;
  for (const CellType& type : setup.cell_types) {
    double stretching = 0;
    for (const MembraneLaw& law : type.laws) stretching += stretching_stiffness(law);
    types.push_back({slip_constants(setup.kernel, type.viscosity_ratio, 3), stretching});
  }
  return std::make_unique<SurfaceSlip>(surfaces, std::move(types), setup.viscosity());
}

MembraneForces make_forces(const SolverSetup& setup, Membranes& membranes, const SlipCorrection* slip) {
  return {membranes,
          {.laws = laws_of(setup),
           .mobility = slip != nullptr ? slip->mobility() : std::vector<NodeMobility>{},
           .response = kernel_response(setup.kernel),
           .semi_implicit = setup.semi_implicit,
           .viscosity = setup.viscosity(),
           .tension_unit = setup.tension_unit}};
}

SurfaceForces make_forces(const BasicSolverSetup<3>& setup, Surfaces& surfaces, const SurfaceSlip* slip) {
  SurfaceForces forces(surfaces, laws_of(setup));
  std::vector<KernelResponse> responses;
  std::vector<double> moduli;
  for (const CellType& type : setup.cell_types) {
    const double shift = slip != nullptr ? slip_constants(setup.kernel, type.viscosity_ratio, 3).shift : 0;
    responses.push_back(kernel_response(setup.kernel, shift));
    moduli.push_back(viscous_modulus(setup.viscosity(), responses.back()));
  }
  forces.take_viscosity(surfaces, moduli, setup.tension_unit);
  if (setup.semi_implicit) forces.take_semi_implicit_steps(surfaces, setup.viscosity(), setup.tension_unit, responses);
  return forces;
}

double slight_energy(const SolverSetup& setup, const Membranes& membranes) {
  std::vector<Stiffness> of_type;
  for (const CellType& type : setup.cell_types) of_type.push_back(stiffness_of(type.laws));
  double energy = 0;
  for (const CellRange& cell : membranes.cells) {
    const double curvature = slight_strain * 2 * std::numbers::pi / cell.rest_perimeter;  // of a circle
    const Stiffness& stiffness = of_type[cell.type];
    energy += (stiffness.stretching * slight_strain * slight_strain + stiffness.bending * curvature * curvature) / 2 *
              cell.rest_perimeter;
  }
  return energy;
}

double slight_energy(const BasicSolverSetup<3>& setup, const Surfaces& surfaces) {
  std::vector<double> of_type;
  for (std::size_t t = 0; t < surfaces.types.size(); ++t)
    of_type.push_back(energy_of_strain(surfaces.types[t], setup.cell_types[t].laws, slight_strain));
  double energy = 0;
  for (const CellRange& cell : surfaces.cells) energy += of_type[cell.type];
  return energy;
}

}  // namespace rouleau::core
