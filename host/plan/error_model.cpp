#include "error_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "flow_start.hpp"
#include "shape/outline.hpp"

namespace rouleau::plan {

namespace {

/// Error of a shape at ten spacings a radius and tau 1, and the power of the spacing with which it falls.
struct ShapeError {
  double at_ten, order;
};
/// The first at viscosity ratio 1, the second at measured_ratio.
using ShapeErrors = ShapeError[2];

namespace in_plane {
constexpr ShapeErrors round_cell{{0.0065, 2}, {0.029, 2}}, thin_cell{{0.040, 3}, {0.039, 2}};
/// Stiffer round cells than at `stiff`, and softer ones than at `soft`, have larger errors, by these powers of the capillary number.
struct CapillaryErrors {
  double stiff, stiff_power, soft, soft_power;
  [[nodiscard]] double growth(const CapillaryRange& capillary) const {
    const double least = std::max(capillary.least, measured_capillary.least);
    const double most = std::min(capillary.most, measured_capillary.most);
    return std::max({1.0, std::pow(stiff / least, stiff_power), std::pow(most / soft, soft_power)});
  }
};
constexpr CapillaryErrors by_capillary[2] = {{0.05, 0.3, 0.2, 0.6}, {0.0125, 0.2, 0.2, 0.3}};
constexpr double thin_growth_with_tau = 0.2;  ///< of the error of thin cells, for each unit of tau above 1
/// Of the compression squared times the Reynolds number: in deformations at viscosity ratio 1, in angles at measured_ratio.
constexpr double by_compression[2] = {0.065, 0.15};
// Without slip correction the tangential slip of the membrane, of first order, comes on top.
constexpr double slip_at_ten[2] = {0.014, 0.025};
// And where cells pass each other it keeps the plasma between them: so much too far apart they go.
constexpr double passing_at_ten = 0.06;
// A fluid that is simulated denser: strains at which things happen are wrong by this share of the Reynolds number.
constexpr double motion_by_reynolds = 0.024;
// Of a thin cell that is placed along the flow and slowly leaves that position: within this angle, rad.
constexpr double motion_from_along_the_flow = 0.076, along_the_flow = 0.5;
// What a cell and the walls make of each other dies out with the slowest mode of the channel's fluid, within a strain of T = Re
// (H / 2 pi a)^2. Shapes: 0.5 (6.4 a/H)^3 exp(-1.2 strain/T), and 0.3 Re times what is left of the membrane's own relaxation. The
// relative viscosity, over the second half of the strain: 1.7 exp(-0.7 strain/T) of what cells add, which is twice their share of the area.
constexpr double of_shape = 0.5, shape_rate = 1.2, relaxation_by_reynolds = 0.3, of_viscosity = 3.4,
                 viscosity_rate = 0.7;
constexpr double measured_height = 6.4;
}  // namespace in_plane

namespace in_space {
// Of round and of thin cells, at ten spacings a radius, for every viscosity ratio and relaxation time that was measured: what the
// kernel takes from normal forces, of second order, and slip, of first order.
constexpr double kernel_at_ten = 0.031, slip_at_ten = 0.022;
constexpr double passing_at_ten = 0.085;  ///< as in the plane
// With the slip correction and the kernel sharp6.
constexpr ShapeErrors sharp{{0.015, 2}, {0.024, 2}};
constexpr double motion_by_reynolds = 0.037;
// Disturbances of the steady state die out as membranes relax: 0.5 times the Reynolds number, exp(-0.55 strain) at viscosity ratio 1
// and exp(-0.38 strain) at measured_ratio.
constexpr double steady_amplitude = 0.5, steady_rate[2] = {0.55, 0.38};
}  // namespace in_space

// Start-up of a flow without cells, times ((tau - 1/2)/rows)^2: between two planes, and with walls all round, from 70 % of the steady
// flow rate on.
constexpr double start_up = 1.2, start_up_in_duct = 5;
// Steady flow rates: of a duct with square section times 1/rows^2, of a tube times 1/radius^2 in spacings.
constexpr double duct = 0.26, tube = 0.65;

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
         std::abs(std::remainder(cell.angle, std::numbers::pi)) < in_plane::along_the_flow;
}

double thin_growth(double tau) { return 1 + in_plane::thin_growth_with_tau * std::max(0.0, tau - 1); }

}  // namespace

MembraneCoupling membrane_coupling(const scene::Numerics& numerics) {
  if (!numerics.slip_correction) return MembraneCoupling::plain;
  return numerics.kernel == sharp_kernel ? MembraneCoupling::sharp : MembraneCoupling::corrected;
}

LeastRadii least_radii(const scene::Scene& scene, MembraneCoupling coupling) {
  if (!scene.domain.depth || coupling != MembraneCoupling::sharp) return {};
  const bool spheres = std::all_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
    return std::holds_alternative<scene::Sphere>(scene.cell_types[cell.type].shape);
  });
  if (spheres) return {.run = 6.5};
  // Of what a denser fluid does to red cells of viscosity ratio 5, 5.9 spacings show 0.4, 6.8 and 7.8 show 0.6 and 0.8.
  return {.run = 10, .companion = 7, .coarsest = 5.5};
}

double resolved_radius(const scene::Shape& shape) {
  if (const auto* ellipse = std::get_if<scene::Ellipse>(&shape)) return ellipse->semi_axes.minCoeff();
  if (const auto* ellipsoid = std::get_if<scene::Ellipsoid>(&shape)) return ellipsoid->semi_axes.minCoeff();
  return shape::shape_radius(shape);
}

double lattice_error(const scene::Shape& shape, double radius, double viscosity_ratio, double tau, int dimension,
                     MembraneCoupling coupling, const CapillaryRange& capillary) {
  if (dimension == 3 && coupling == MembraneCoupling::sharp) return between(in_space::sharp, viscosity_ratio, radius);
  if (dimension == 3) return in_space::kernel_at_ten * 100 / (radius * radius) + in_space::slip_at_ten * 10 / radius;
  double error = 0;
  if (is_thin(shape)) {
    error = between(in_plane::thin_cell, viscosity_ratio, radius) * thin_growth(tau);
  } else {
    const auto& [at_one, at_measured] = in_plane::by_capillary;
    error = between(in_plane::round_cell, viscosity_ratio, radius) *
            between(at_one.growth(capillary), at_measured.growth(capillary), viscosity_ratio);
  }
  if (coupling == MembraneCoupling::plain)
    error += between(in_plane::slip_at_ten[0], in_plane::slip_at_ten[1], viscosity_ratio) * 10 / radius;
  return error;
}

double passing_error(double radius, int dimension, MembraneCoupling coupling) {
  if (coupling != MembraneCoupling::plain) return 0;
  return (dimension == 3 ? in_space::passing_at_ten : in_plane::passing_at_ten) * 10 / radius;
}

double stiffness_error(double compression, double reynolds, double viscosity_ratio) {
  const auto& [at_one, at_measured] = in_plane::by_compression;
  return between(at_one, at_measured, viscosity_ratio) * compression * compression * reynolds;
}

double steady_flow_error(const scene::Domain& domain, double spacing) {
  const auto square = [](double value) { return value * value; };
  if (domain.tube_radius) return tube * square(spacing / *domain.tube_radius);
  if (!domain.is_duct()) return 0;
  return duct *
         square(spacing / (domain.periodic_y ? domain.depth->size : std::min(domain.size.y(), domain.depth->size)));
}

double flow_start_error(const scene::Domain& domain, double spacing, double tau) {
  const double shape = (tau - 0.5) * spacing / domain.height();
  return (domain.is_duct() ? start_up_in_duct : start_up) * shape * shape;
}

double motion_error(double reynolds, const scene::Scene& scene) {
  if (scene.domain.depth) return in_space::motion_by_reynolds * reynolds;
  return (begins_along_the_flow(scene) ? in_plane::motion_from_along_the_flow : in_plane::motion_by_reynolds) *
         reynolds;
}

double steady_error(const SteadyApproach& approach) {
  using namespace in_plane;
  const double to_height = approach.height / (2 * std::numbers::pi);
  const double times = approach.strain / (approach.reynolds * to_height * to_height);
  const double shape = of_shape * std::pow(measured_height / approach.height, 3) * std::exp(-shape_rate * times);
  const double relaxation = capsule_relaxation(std::min(approach.capillary, measured_capillary.most),
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
  if (scene.domain.depth) return 2;
  double least = in_plane::thin_cell[0].order;
  for (const scene::CellPlacement& cell : scene.cells) {
    const scene::CellType& type = scene.cell_types[cell.type];
    const double ratio = type.interior_viscosity / scene.fluid.viscosity;
    least = std::min(least, order_between(is_thin(type.shape) ? in_plane::thin_cell : in_plane::round_cell, ratio));
  }
  return least;
}

double growth_of_lattice_error(const scene::Scene& scene, double tau) {
  const bool thin = std::any_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
    return is_thin(scene.cell_types[cell.type].shape);
  });
  return thin && !scene.domain.depth ? thin_growth(tau) : 1;
}

}  // namespace rouleau::plan
