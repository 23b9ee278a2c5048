#include "error_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "flow.hpp"
#include "shape/extent.hpp"

namespace rouleau::plan {

namespace {

/// How much larger the error of round cells is than at usual capillary numbers.
double growth(const CapillaryErrors& errors, const MeasuredCapillary& measured, const CapillaryRange& capillary) {
  const double least = std::max(capillary.least, measured.least);
  const double most = std::min(capillary.most, measured.most);
  return std::max(
      {1.0, std::pow(errors.stiff / least, errors.stiff_power), std::pow(most / errors.soft, errors.soft_power)});
}

/// How far a viscosity ratio is from 1, with the measured one at 1.
double distance_from_one(double viscosity_ratio) {
  return std::abs(std::log(viscosity_ratio)) / std::log(measured_ratio);
}

/// Value between those at viscosity ratio 1 and 5, by the ratio's logarithm; beyond, extrapolated.
double between(double at_one, double at_measured, double viscosity_ratio) {
  return at_one + distance_from_one(viscosity_ratio) * (at_measured - at_one);
}
double order_between(const ShapeErrors& pair, double viscosity_ratio) {
  return std::clamp(between(pair[0].order, pair[1].order, viscosity_ratio), 2.0, 3.0);
}
double between(const ShapeErrors& pair, double viscosity_ratio, double radius) {
  return between(pair[0].at_ten, pair[1].at_ten, viscosity_ratio) *
         std::pow(10 / radius, order_between(pair, viscosity_ratio));
}

bool is_thin(const scene::Shape& shape) { return std::holds_alternative<scene::Biconcave>(shape); }

/// Whether a thin cell is alone and nearly along the flow.
bool begins_along_the_flow(const scene::Scene& scene) {
  if (scene.cells.size() != 1) return false;
  const scene::CellPlacement& cell = scene.cells[0];
  return is_thin(scene.cell_types[cell.type].shape) &&
         std::abs(std::remainder(cell.angle, std::numbers::pi)) < along_the_flow;
}

double grown(double with_tau, double tau) { return 1 + with_tau * std::max(0.0, tau - 1); }

}  // namespace

MembraneCoupling membrane_coupling(const scene::Numerics& numerics) {
  if (!numerics.slip_correction) return MembraneCoupling::plain;
  return numerics.kernel == sharp_kernel ? MembraneCoupling::sharp : MembraneCoupling::corrected;
}

LeastRadii least_radii(const scene::Scene& scene, MembraneCoupling coupling) {
  const bool spheres = std::all_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
    return std::holds_alternative<scene::Sphere>(scene.cell_types[cell.type].shape);
  });
  return least_radii_of[scene.domain.dimension() - 2][static_cast<int>(coupling)][spheres];
}

double resolved_radius(const scene::Shape& shape) {
  if (const auto* ellipse = std::get_if<scene::Ellipse>(&shape)) return ellipse->semi_axes.least();
  if (const auto* ellipsoid = std::get_if<scene::Ellipsoid>(&shape)) return ellipsoid->semi_axes.least();
  return shape::shape_radius(shape);
}

double lattice_error(const scene::Shape& shape, double radius, double viscosity_ratio, double tau, int dimension,
                     MembraneCoupling coupling, const CapillaryRange& capillary) {
  const int by_dimension = dimension - 2, by_coupling = static_cast<int>(coupling);
  const bool thin = is_thin(shape);
  const ShapeErrors& errors = shape_errors[by_dimension][by_coupling][thin];
  const auto& [at_one, at_measured] = by_capillary[by_dimension][thin];
  const MeasuredCapillary& measured = measured_capillary[by_dimension][by_coupling];
  return between(errors, viscosity_ratio, radius) * grown(growth_with_tau[by_dimension][thin], tau) *
             between(growth(at_one, measured, capillary), growth(at_measured, measured, capillary), viscosity_ratio) +
         between(errors[0].slip_at_ten, errors[1].slip_at_ten, viscosity_ratio) * 10 / radius;
}

double passing_error(double radius, int dimension, MembraneCoupling coupling) {
  if (coupling != MembraneCoupling::plain) return 0;
  return passing_at_ten[dimension - 2] * 10 / radius;
}

double stiffness_error(double compression, double reynolds, double viscosity_ratio) {
  const auto& [at_one, at_measured] = in_plane::by_compression;
  return between(at_one, at_measured, viscosity_ratio) * compression * compression * reynolds;
}

double steady_flow_error(const scene::Domain& domain, double spacing) {
  const auto square = [](double value) { return value * value; };
  if (domain.tube_radius || domain.has_shapes()) return tube_error * square(spacing / (domain.across(1) / 2));
  if (!domain.is_duct()) return 0;
  return duct_error *
         square(spacing / (!domain.walled(1) ? domain.size.z() : std::min(domain.size.y(), domain.size.z())));
}

double flow_start_error(const scene::Domain& domain, double spacing, double tau) {
  const double shape = (tau - 0.5) * spacing / domain.across(1);
  return (domain.is_duct() ? start_up_in_duct : start_up) * shape * shape;
}

double motion_error(double reynolds, const scene::Scene& scene) {
  return motion_by_reynolds[scene.domain.dimension() - 2][begins_along_the_flow(scene)] * reynolds;
}

double steady_error(const SteadyApproach& approach) {
  using namespace in_plane;
  const double to_height = approach.height / (2 * std::numbers::pi);
  const double times = approach.strain / (approach.reynolds * to_height * to_height);
  const double shape = of_shape * std::pow(measured_height / approach.height, 3) * std::exp(-shape_rate * times);
  const double relaxation = capsule_relaxation(std::min(approach.capillary, measured_capillary[0][0].most),
                                               std::max(1.0, approach.viscosity_ratio));
  const double late = relaxation_by_reynolds * approach.reynolds * std::exp(-approach.strain / relaxation);
  return std::max(shape + late, of_viscosity * approach.area_fraction * std::exp(-viscosity_rate * times));
}

double steady_error_in_space(double reynolds, double strain, double viscosity_ratio) {
  const auto& [at_one, at_measured] = in_space::steady_rate;
  const double rate = at_one * std::pow(at_measured / at_one, distance_from_one(viscosity_ratio));
  return in_space::steady_amplitude * reynolds * std::exp(-rate * strain);
}

double order_of_lattice_error(const scene::Scene& scene) {
  if (scene.cells.empty()) return 2;
  if (!scene.numerics.slip_correction) return 1;
  const int by_coupling = static_cast<int>(membrane_coupling(scene.numerics));
  double least = INFINITY;
  for (const scene::CellPlacement& cell : scene.cells) {
    const scene::CellType& type = scene.cell_types[cell.type];
    const double ratio = type.interior_viscosity / scene.fluid.viscosity;
    least = std::min(
        least, order_between(shape_errors[scene.domain.dimension() - 2][by_coupling][is_thin(type.shape)], ratio));
  }
  return least;
}

double growth_of_lattice_error(const scene::Scene& scene, double tau) {
  const bool thin = std::any_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
    return is_thin(scene.cell_types[cell.type].shape);
  });
  return grown(growth_with_tau[scene.domain.dimension() - 2][thin], tau);
}

}  // namespace rouleau::plan
