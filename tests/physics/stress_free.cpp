// Cells that are free of stress in another shape than the one they begin in: exact tensions and energies, and the shape
// of a red cell that follows from a sphere or a spheroid at rest. No fluid: a cell at rest has the least energy.
#include <catch2/catch.hpp>
#include <iostream>
#include <numbers>

#include "minimise.hpp"
#include "unit/surface/fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

Surfaces cell_at_rest(const core::TriangleSurface& first, const core::TriangleSurface& rest) {
  Surfaces cells;
  cells.types.push_back(
      std::make_shared<const RestSurface>(core::created_as(core::rest_surface(first), core::rest_surface(rest))));
  add_cell(cells, 0, {0, 0, 0});
  return cells;
}

core::TriangleSurface scaled_to(double area, core::TriangleSurface surface) {
  const double scale = std::sqrt(area / core::content_of(surface).area);
  for (Vec<3>& node : surface.nodes) node *= scale;
  return surface;
}

/// A law in the plane under the same stretch in all directions: tension, and energy per area at rest.
struct Uniform {
  core::MembraneLaw law;
  double (*tension)(double stretch);
  double (*energy)(double stretch);
};
constexpr double plane_modulus = 0.3, dilation = 4;
std::vector<Uniform> laws_under_uniform_stretch() {
  return {
      {surface_law("neo-hookean", {plane_modulus, 0}), [](double l) { return plane_modulus * (1 - std::pow(l, -6)); },
       [](double l) { return plane_modulus / 2 * (2 * l * l - 3 + std::pow(l, -4)); }},
      {surface_law("skalak", {plane_modulus, dilation, 0}),
       [](double l) { return plane_modulus * (l * l - 1 + dilation * l * l * (std::pow(l, 4) - 1)); },
       [](double l) {
         const double one = 2 * l * l - 2, two = std::pow(l, 4) - 1;
         return plane_modulus / 4 * (one * one + 2 * one - 2 * two + dilation * two * two);
       }}};
}

/// Neo-Hookean energy of a unit sphere whose axes are stretched by `axes`: I1 and I2 of each tangent plane follow from
/// C = F'F and the normal, the integral by midpoints in the height and the angle.
double energy_of_stretched_sphere(const Vec<3>& axes) {
  constexpr int steps = 400;
  const Vec<3> c = axes.cwiseProduct(axes);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double z = -1 + 2 * (i + 0.5) / steps, r = std::sqrt(1 - z * z);
    for (int j = 0; j < steps; ++j) {
      const double angle = 2 * std::numbers::pi * (j + 0.5) / steps;
      const Vec<3> square(r * r * std::cos(angle) * std::cos(angle), r * r * std::sin(angle) * std::sin(angle), z * z);
      const double trace = c.sum() - c.dot(square), det = c.prod() * square.cwiseQuotient(c).sum();
      sum += plane_modulus / 2 * (trace - 3 + 1 / det);
    }
  }
  return sum * 4 * std::numbers::pi / steps / steps;
}

/// um, pN: moduli of membranes in uN/m, of bending in 1e-18 J.
struct RedCell {
  double shear, area, bending;
};

/// A cell with the area and volume of Evans and Fung's disc at rest, which began as an oblate spheroid of these.
class RelaxedCell {
 public:
  static constexpr double radius = 3.91;
  static constexpr double cup = 1;  ///< um that its rim is moved up by at first, which bends it to a cup

  /// `reduced`: reduced volume of the shape that is free of stress, an oblate spheroid with the area of the cell.
  RelaxedCell(int n, double reduced, const RedCell& moduli, double bent = 0)
      : disc_(core::content_of(core::biconcave_disc(n, radius))),
        cell_(cell_at_rest(spheroid(n, disc_.reduced_volume()), spheroid(n, reduced))),
        forces_(cell_, {laws(moduli)}) {
    // Out of its symmetry, so that it finds what has less energy nearby.
    for (int i = 0; i < cell_.node_count(); ++i) {
      const double x = cell_.position[0][i] / radius, z = cell_.position[2][i] / radius;
      cell_.position[1][i] += 0.01 * x * x + bent * (x * x + z * z);
    }
    Eigen::VectorXd place = place_of(cell_);
    left_ = minimise(place, {2e-3, 0.05, 1e-9, 20000}, [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
      move_to(at, cell_);
      forces_.run({}, cell_);
      gradient.setZero(at.size());
      add_gradient(cell_, gradient);
      return forces_.energy(cell_);
    });
    center_ = core::inertia_ellipsoid(mesh(), cell_.nodes(0));
  }

  [[nodiscard]] double force_left() const { return left_; }
  [[nodiscard]] core::MembraneEnergy energies() { return forces_.energies(cell_); }
  [[nodiscard]] double drift_of_volume() const {
    return core::enclosed_volume(mesh(), cell_.nodes(0)) / cell_.type_of(0).rest_volume - 1;
  }
  [[nodiscard]] double drift_of_area() const {
    return core::surface_area(mesh(), cell_.nodes(0)) / cell_.type_of(0).rest_surface_area - 1;
  }
  /// Heights of the upper and of the lower side where a line parallel to the axis, so far from it, goes through the
  /// cell, averaged over directions.
  [[nodiscard]] std::array<double, 2> sides(double from_axis) const {
    const Vec<3> axis = center_.axes[2], one = center_.axes[0], two = center_.axes[1];
    constexpr int directions = 24;
    std::array<double, 2> sides{0, 0};
    for (int d = 0; d < directions; ++d) {
      const double angle = 2 * std::numbers::pi * (d + 0.5) / directions;
      const Vec<3> foot = center_.center + from_axis * (std::cos(angle) * one + std::sin(angle) * two);
      double most = -1e9, least = 1e9;
      for (const auto& [i, j, k] : mesh().triangles()) {
        const auto flat = [&](int node) {
          const Vec<3> p = cell_.nodes(0)[node] - foot;
          return Vec<3>(p.dot(one), p.dot(two), p.dot(axis));
        };
        const Vec<3> a = flat(i), b = flat(j), c = flat(k);
        const double whole = (b - a).cross(c - a).z();
        const double of_a = b.cross(c).z() / whole, of_b = c.cross(a).z() / whole, of_c = 1 - of_a - of_b;
        if (of_a < 0 || of_b < 0 || of_c < 0) continue;
        const double height = of_a * a.z() + of_b * b.z() + of_c * c.z();
        most = std::max(most, height), least = std::min(least, height);
      }
      sides[0] += most / directions, sides[1] += least / directions;
    }
    return sides;
  }
  /// Thickness of the disc at a share of its radius, um.
  static double of_disc(double share) {
    const double x = share * share;
    return radius * std::sqrt(1 - x) * (0.207 + x * (2.002 - 1.122 * x));
  }
  [[nodiscard]] double thickness(double from_axis) const {
    const auto [upper, lower] = sides(from_axis);
    return upper - lower;
  }
  /// How far the middle of its hollow lies beside the middle plane of its rim: 0 of a disc, large of a cup.
  [[nodiscard]] double cupped() const {
    const auto at = [&](double r) { return (sides(r)[0] + sides(r)[1]) / 2; };
    return std::abs(at(0.05) - at(0.8 * radius));
  }
  [[nodiscard]] double radius_reached() const {
    double sum = 0;
    for (int i = 0; i < cell_.node_count(); ++i) {
      Vec<3> p = cell_.nodes(0)[i] - center_.center;
      p -= p.dot(center_.axes[2]) * center_.axes[2];
      sum = std::max(sum, p.norm());
    }
    return sum;
  }

 private:
  [[nodiscard]] const core::Mesh& mesh() const { return cell_.type_of(0).mesh; }
  [[nodiscard]] core::TriangleSurface spheroid(int n, double reduced) const {
    const double of_sphere = std::pow(disc_.area, 1.5) / (6 * std::sqrt(std::numbers::pi));
    const Vec<3> axes = core::spheroid_axes({disc_.area, reduced * of_sphere}, false);
    return scaled_to(disc_.area, core::even_spheroid(n, axes));
  }
  static MembraneLaws laws(const RedCell& of) {
    // Ka = mu (1 + 2 C)
    return {surface_law("skalak", {of.shear, (of.area / of.shear - 1) / 2, 0}),
            surface_law("bending", {of.bending, 1, 0}), surface_law("volume", {1e3, 1}),
            surface_law("surface-area", {1e3, 1, 0})};
  }

  core::SurfaceContent disc_;
  Surfaces cell_;
  core::SurfaceForces forces_;
  core::InertiaEllipsoid center_;
  double left_ = 0;
};

void print(const std::string& name, RelaxedCell& cell) {
  std::cout << name << ": volume " << cell.drift_of_volume() << ", area " << cell.drift_of_area() << ", cupped by "
            << cell.cupped() << " um, radius " << cell.radius_reached() << ", force left " << cell.force_left()
            << ", energies " << cell.energies().tension << " " << cell.energies().bending << "; thickness (disc):";
  for (const double share : {0.02, 0.2, 0.4, 0.6, 0.7, 0.8})
    std::cout << "  " << cell.thickness(share * RelaxedCell::radius) << " (" << RelaxedCell::of_disc(share) << ")";
  std::cout << "\n";
}

}  // namespace

TEST_CASE("a sphere that is free of stress as a smaller one has the law's tension, energy and Laplace's pressure",
          "[stress_free]") {
  const double stretch = GENERATE(0.9, 1.05, 1.5);
  const double radius = 3;
  for (const auto& [law, tension, energy] : laws_under_uniform_stretch()) {
    Surfaces cell = cell_at_rest(core::ellipsoid(12, Vec<3>::Constant(radius)),
                                 core::ellipsoid(12, Vec<3>::Constant(radius / stretch)));
    core::SurfaceForces forces(cell, {{law}});
    for (const double of_triangle : forces.tensions(cell, 0))
      CHECK(of_triangle == Approx(tension(stretch)).epsilon(1e-9));
    const double area = core::surface_area(cell.type_of(0).mesh, cell.nodes(0));
    CHECK(forces.energy(cell) == Approx(energy(stretch) * area / stretch / stretch).epsilon(1e-11));
    const auto [least, most] = core::first_stretch(cell.type_of(0));
    CHECK(least == Approx(stretch).epsilon(1e-7));
    CHECK(most == Approx(stretch).epsilon(1e-7));
    forces.run({}, cell);
    double virial = 0;
    for (int i = 0; i < cell.node_count(); ++i) virial -= force_on(cell, i).dot(cell.nodes(0)[i]);
    const double volume = core::enclosed_volume(cell.type_of(0).mesh, cell.nodes(0));
    CHECK(virial == Approx(2 * tension(stretch) * area).epsilon(1e-10));  // of any surface under one tension
    // Of flat triangles on a sphere, A R/3V - 1 is at most half the square of an edge over the radius.
    CHECK(virial / (3 * volume) == Approx(2 * tension(stretch) / radius).epsilon(0.5 / 12 / 12 * 1.3 * 1.3));
  }
}

TEST_CASE("energy of a stretched sphere converges to the integral over it", "[stress_free]") {
  const Vec<3> axes(1.3, 0.8, 1.1);
  const double exact = energy_of_stretched_sphere(axes);
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const int n = 8 << k;
    Surfaces cell = cell_at_rest(core::ellipsoid(n, axes), core::unit_sphere(n));
    core::SurfaceForces forces(cell, {{surface_law("neo-hookean", {plane_modulus, 0})}});
    error[k] = std::abs(forces.energy(cell) / exact - 1);
    std::cout << "stretched sphere, n " << n << ": energy off by " << error[k] << "\n";
  }
  CHECK(error[1] < error[0] / 3.5);
  CHECK(error[2] < error[1] / 3.5);
  CHECK(error[2] < 1e-3);
}

// Shear and area modulus and bending of Peng et al. (J. Fluid Mech. 742, 2014), the bending of Evans (1983).
constexpr RedCell peng{4, 4, 0.28};

TEST_CASE(
    "a red cell that is free of stress as a spheroid of reduced volume 0.95 comes to rest as Evans and Fung's disc",
    "[stress_free]") {
  RelaxedCell cell(12, 0.95, peng), cup(12, 0.95, peng, RelaxedCell::cup);
  print("spheroid of 0.95", cell);
  print("the same from a cup", cup);
  for (const double share : {0.02, 0.2, 0.4, 0.6, 0.8, 0.9})
    CHECK(cell.thickness(share * RelaxedCell::radius) == Approx(RelaxedCell::of_disc(share)).epsilon(0.1));
  CHECK(cell.cupped() < 0.02);
  CHECK(std::abs(cell.drift_of_volume()) < 1e-3);
  CHECK(std::abs(cell.drift_of_area()) < 1e-3);
  // Where a cup stays one it has more energy.
  CHECK(cell.energies().total() < cup.energies().total() + 1e-2);
}

TEST_CASE("a red cell that is free of stress as a sphere has less energy as a cup than as a disc", "[stress_free]") {
  RelaxedCell cell(12, 1, peng), cup(12, 1, peng, RelaxedCell::cup);
  print("sphere", cell);
  print("the same from a cup", cup);
  CHECK(cup.cupped() > 1);
  CHECK(cell.cupped() < 0.05);
  CHECK(cup.energies().total() < cell.energies().total());
}

TEST_CASE("red cells of several stress-free spheroids and moduli", "[.stress_free]") {
  for (const RedCell& moduli : {peng, {2.5, 5, 0.2}, {5, 20, 0.2}}) {
    std::cout << "shear " << moduli.shear << " uN/m, area " << moduli.area << " uN/m, bending " << moduli.bending
              << "e-18 J\n";
    for (const double reduced : {0.7, 0.8, 0.9, 0.95, 0.98, 1.0}) {
      for (const double bent : {0.0, RelaxedCell::cup}) {
        RelaxedCell cell(16, reduced, moduli, bent);
        print(std::to_string(reduced) + (bent > 0 ? " from a cup" : " from a spheroid"), cell);
      }
    }
  }
}
