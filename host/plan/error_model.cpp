#include "error_model.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

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
constexpr ShapeErrors round_cell{{0.010, 2}, {0.021, 2}}, thin_cell{{0.040, 3}, {0.039, 2}};
constexpr double growth_with_tau = 0.2;  ///< of that error, for each unit of tau above 1
// Without slip correction the tangential slip of the membrane, of first order, comes on top.
constexpr double slip_at_ten[2] = {0.014, 0.025};
// A fluid that is simulated denser: strains at which things happen are wrong by this share of the Reynolds number.
constexpr double motion_by_reynolds = 0.024;
// Disturbances of the steady state die out as 0.7 exp(-1.35 strain / sqrt(Reynolds number)).
constexpr double steady_amplitude = 0.7, steady_rate = 1.35;
}  // namespace in_plane

namespace in_space {
// Of round and of thin cells, at ten spacings a radius, for every viscosity ratio and relaxation time that was measured: what the
// kernel takes from normal forces, of second order, and slip, of first order.
constexpr double kernel_at_ten = 0.031, slip_at_ten = 0.022;
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

}  // namespace

double resolved_radius(const scene::Shape& shape) {
  if (const auto* ellipse = std::get_if<scene::Ellipse>(&shape)) return ellipse->semi_axes.minCoeff();
  if (const auto* ellipsoid = std::get_if<scene::Ellipsoid>(&shape)) return ellipsoid->semi_axes.minCoeff();
  return shape::shape_radius(shape);
}

double lattice_error(const scene::Shape& shape, double radius, double viscosity_ratio, double tau, int dimension,
                     bool slip_correction) {
  if (dimension == 3) return in_space::kernel_at_ten * 100 / (radius * radius) + in_space::slip_at_ten * 10 / radius;
  double error = between(is_thin(shape) ? in_plane::thin_cell : in_plane::round_cell, viscosity_ratio, radius) *
                 growth_of_lattice_error(tau, dimension);
  if (!slip_correction)
    error += between(in_plane::slip_at_ten[0], in_plane::slip_at_ten[1], viscosity_ratio) * 10 / radius;
  return error;
}

double growth_of_lattice_error(double tau, int dimension) {
  return dimension == 2 ? 1 + in_plane::growth_with_tau * std::max(0.0, tau - 1) : 1;
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

double motion_error(double reynolds, int dimension) {
  return (dimension == 2 ? in_plane::motion_by_reynolds : in_space::motion_by_reynolds) * reynolds;
}

double steady_error(double reynolds, double strain, double viscosity_ratio, int dimension) {
  if (dimension == 3) {
    const auto& [at_one, at_measured] = in_space::steady_rate;
    const double rate = at_one * std::pow(at_measured / at_one, distance_from_one(viscosity_ratio));
    return in_space::steady_amplitude * reynolds * std::exp(-rate * strain);
  }
  const double decay = in_plane::steady_rate * strain / std::sqrt(0.5 + 0.5 * std::max(1.0, viscosity_ratio));
  return in_plane::steady_amplitude * std::exp(-decay / std::sqrt(reynolds));
}

double order_of_lattice_error(const scene::Scene& scene) {
  if (scene.cells.empty()) return 2;
  if (!scene.numerics.slip_correction) return 1;
  double least = in_plane::thin_cell[0].order;
  for (const scene::CellPlacement& cell : scene.cells) {
    const scene::CellType& type = scene.cell_types[cell.type];
    const double ratio = type.interior_viscosity / scene.fluid.viscosity;
    least = std::min(least, order_between(is_thin(type.shape) ? in_plane::thin_cell : in_plane::round_cell, ratio));
  }
  return least;
}

}  // namespace rouleau::plan
