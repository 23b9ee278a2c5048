// Forces of every shipped law on closed surfaces: gradients, balances, rest, rigid motion, Laplace's law.
#include <numbers>

#include <rouleau/membrane.hpp>

#include "core/membrane/stiffness.hpp"
#include "core/model/compiled_in.hpp"
#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

constexpr double pi = std::numbers::pi;

struct NamedLaws {
  std::string name;
  MembraneLaws laws;
  bool at_rest;  ///< no force on the shape the cell was created with
};

/// Energies of shipped laws, without their forces.
struct LocalAreaEnergy {
  explicit LocalAreaEnergy(const Parameters&) {}
  template <class S>
  S energy(const Patch<S>& patch) const {
    return 0.15 * (patch.area_ratio - 1.0) * (patch.area_ratio - 1.0);
  }
};
struct SkalakEnergy {
  explicit SkalakEnergy(const Parameters&) {}
  template <class S>
  S energy(const Triangle<S>& t) const {
    const S one = t.invariant_1, two = t.invariant_2;
    return 0.025 * (one * one + 2.0 * one - 2.0 * two + 3.0 * two * two);
  }
};
struct LimEnergy {  // by principal stretches, as Lim, Wortis and Mukhopadhyay have it
  explicit LimEnergy(const Parameters&) {}
  template <class S>
  S energy(const Triangle<S>& t) const {
    const S squares = t.invariant_1 + 2.0, J = sqrt(t.invariant_2 + 1.0);  // l1^2 + l2^2, l1 l2
    const S alpha = J - 1.0, beta = (squares - 2.0 * J) / (2.0 * J);
    return 0.15 * (alpha * alpha - 2.0 * alpha * alpha * alpha + 8.0 * alpha * alpha * alpha * alpha) +
           0.1 * (beta + 0.7 * alpha * beta + 1.81 * beta * beta);
  }
};
struct BodyEnergy {
  explicit BodyEnergy(const Parameters&) {}
  template <class S>
  S energy(const Body<S>& body) const {
    const S volume = body.volume / (0.9 * body.rest_volume) - 1.0,
            area = body.surface_area / body.rest_surface_area - 1.0;
    return 0.15 * volume * volume * (0.9 * body.rest_volume) + 0.1 * area * area * body.rest_surface_area;
  }
};

std::vector<NamedLaws> laws_of_surfaces() {
  return {{"neo-hookean", {surface_law("neo-hookean", {0.1, 0})}, true},
          {"skalak", {surface_law("skalak", {0.1, 10, 0})}, true},
          {"lim", {surface_law("lim", {0.1, 0.1, -2, 8, 0.7, 1.81})}, true},
          {"lim, other coefficients", {surface_law("lim", {0.1, 0.3, 0.5, 1, -0.4, 0.2})}, true},
          {"hooke", {surface_law("hooke", {0.1, 0.3})}, true},
          {"hooke, wider where it is pulled", {surface_law("hooke", {0.1, -0.7})}, true},
          {"bending about the shape at rest", {surface_law("bending", {0.5, 0, 0})}, true},
          {"bending about a plane", {surface_law("bending", {0.5, 1, 0})}, false},
          {"bending about a value", {surface_law("bending", {0.5, 2, 0.3})}, false},
          {"volume", {surface_law("volume", {0.3, 1})}, true},
          {"volume, smaller", {surface_law("volume", {0.3, 0.7})}, false},
          {"surface-area", {surface_law("surface-area", {0.2, 1, 0})}, true},
          {"a drop", {surface_law("surface-area", {0, 1, 0.4})}, false},
          {"local-area", {surface_law("local-area", {0.3})}, true},
          {"all kinds of elements",
           {surface_law("skalak", {0.1, 2, 0}), surface_law("bending", {0.5, 0, 0}), surface_law("volume", {0.3, 0.9}),
            surface_law("surface-area", {0.2, 1.1, 0}), surface_law("local-area", {0.1})},
           false}};
}

void deform(Surfaces& s, std::mt19937& random, double noise) {
  std::uniform_real_distribution<double> any(-noise, noise);
  const Vec<3> center(s.position[0][0], s.position[1][0], s.position[2][0]);
  for (int i = 0; i < s.node_count(); ++i) {
    s.position[0][i] = center.x() + 1.3 * (s.position[0][i] - center.x()) + any(random);
    s.position[1][i] =
        center.y() + 0.8 * (s.position[1][i] - center.y()) + 0.2 * (s.position[0][i] - center.x()) + any(random);
    s.position[2][i] += any(random);
  }
}

/// Force on node i minus the gradient of the energy by differences of fourth order, over the largest force.
double gradient_error(SurfaceForces& forces, Surfaces& s, std::mt19937& random) {
  constexpr double h = 2e-4;
  double worst = 0;
  const double most = largest_force(s);
  auto& position = s.position;
  for (int trial = 0; trial < 40; ++trial) {
    const auto i = random() % s.position[0].size();
    const auto k = random() % 3;
    double& coordinate = position[k][i];
    const double here = coordinate;
    const auto energy = [&](double step) {
      coordinate = here + step;
      const double value = forces.energy(s);
      coordinate = here;
      return value;
    };
    const double slope = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
    worst = std::max(worst, std::abs(force_on(s, static_cast<int>(i))[static_cast<int>(k)] + slope));
  }
  return worst / most;
}

}  // namespace

TEST_CASE("forces of every shipped law on a surface are minus the gradient of its energy") {
  auto random = generator(71);
  Surfaces s = one_cell(core::biconcave_disc(6, 1));
  deform(s, random, 0.01);
  for (const NamedLaws& entry : laws_of_surfaces()) {
    CAPTURE(entry.name);
    SurfaceForces forces(s, {entry.laws});
    forces.run({}, s);
    REQUIRE(largest_force(s) > 0);
    CHECK(gradient_error(forces, s, random) < 1e-8);  // rounding of the energy, 1e-16 / (1e-4 of a force of 1e-3)
  }
}

TEST_CASE("forces on a surface have no sum and no torque") {
  auto random = generator(72);
  Surfaces s = one_cell(core::biconcave_disc(6, 1));
  deform(s, random, 0.01);
  for (const NamedLaws& entry : laws_of_surfaces()) {
    CAPTURE(entry.name);
    SurfaceForces forces(s, {entry.laws});
    forces.run({}, s);
    const auto [sum, torque] = sum_and_torque(s);
    CHECK(sum.norm() < 1e-12 * largest_force(s));
    CHECK(torque.norm() < 1e-12 * largest_force(s));
  }
}

TEST_CASE("a surface that is turned and moved as a whole feels no force") {
  const core::TriangleSurface disc = core::biconcave_disc(8, 1);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(disc)));
  add_cell(s, 0, {30, -12, 7}, Eigen::AngleAxisd(2.1, Vec<3>(1, 2, 3).normalized()).toRotationMatrix());
  for (const NamedLaws& entry : laws_of_surfaces()) {
    if (!entry.at_rest) continue;
    CAPTURE(entry.name);
    SurfaceForces forces(s, {entry.laws});
    forces.run({}, s);
    // Positions of 30 are rounded to 4e-15, which is 1e-13 of a side; stresses of 0.1 act on areas of 0.01. Curvatures
    // change by 1e-13 over a side, their forces by as much over the side once more.
    CHECK(largest_force(s) < 1e-11);
  }
}

TEST_CASE("the forces on one cell do not depend on where others are, nor on the workers") {
  auto random = generator(73);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::unit_sphere(4))));
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::biconcave_disc(7, 2))));
  for (const int type : {0, 1, 1, 0, 1}) add_cell(s, type, {3.0 * type, 1, 0});
  deform(s, random, 0.01);
  const MembraneLaws laws = laws_of_surfaces().back().laws;
  SurfaceForces one(s, {laws, laws});
  one.run({}, s);
  const std::vector<double> x = s.force[0], y = s.force[1], z = s.force[2];
  SurfaceForces three(s, {laws, laws});
  for (const int index : {2, 0, 1}) three.run({index, 3}, s);
  CHECK(s.force[0] == x);
  CHECK(s.force[1] == y);
  CHECK(s.force[2] == z);
}

TEST_CASE("a blown up sphere stays one and comes to rest under the pressure of Laplace's law") {
  const double modulus = 0.1, stretch = 1.2, tension = modulus * (1 - std::pow(stretch, -6)), stiffness = 1;
  // As created the volume law presses with 2 T/R.
  Surfaces s = one_cell(core::unit_sphere(8), stretch);
  SurfaceForces forces(
      s, {{surface_law("neo-hookean", {modulus, 0}), surface_law("volume", {stiffness, 1 / (1 - 2 * tension)})}});
  for (const double found : forces.tensions(s, 0)) CHECK(found == Approx(tension).epsilon(1e-10));
  // Down the energy, as if every node met the same friction.
  for (int step = 0; step < 4000; ++step) {
    forces.run({}, s);
    for (int i = 0; i < s.node_count(); ++i)
      s.position[0][i] += s.force[0][i], s.position[1][i] += s.force[1][i], s.position[2][i] += s.force[2][i];
  }
  CHECK(largest_force(s) < 1e-9);
  const Mesh& mesh = s.types[0]->mesh;
  const double volume = enclosed_volume(mesh, s.nodes(0)), radius = std::cbrt(volume / (4 * pi / 3));
  const Vec<3> center = inertia_ellipsoid(mesh, s.nodes(0)).center;
  for (int i = 0; i < s.node_count(); ++i) CHECK((s.nodes(0)[i] - center).norm() == Approx(radius).epsilon(0.005));
  const double preferred = s.types[0]->rest_volume / (1 - 2 * tension);
  const double pressure = stiffness * (preferred - volume) / preferred,
               now = stretch * std::cbrt(volume / s.types[0]->rest_volume);
  CHECK(pressure * radius / (2 * modulus * (1 - std::pow(now, -6))) == Approx(1).epsilon(0.005));
}

TEST_CASE("the energy of a stretched sphere is that of its law") {
  Surfaces s = one_cell(core::unit_sphere(6), 1.5);
  const double area = s.types[0]->rest_surface_area, l2 = 2.25, l4 = l2 * l2;
  const auto energy = [&](const core::MembraneLaw& law) { return SurfaceForces(s, {{law}}).energy(s); };
  CHECK(energy(surface_law("neo-hookean", {0.1, 0})) == Approx(0.05 * (2 * l2 + 1 / l4 - 3) * area).epsilon(1e-12));
  const double i1 = 2 * l2 - 2, i2 = l4 - 1;
  CHECK(energy(surface_law("skalak", {0.1, 3, 0})) ==
        Approx(0.025 * (i1 * i1 + 2 * i1 - 2 * i2 + 3 * i2 * i2) * area).epsilon(1e-12));
  const double alpha = l2 - 1;  // both stretches are the same: no shear
  CHECK(energy(surface_law("lim", {0.1, 0.3, -2, 8, 0.7, 0.75})) ==
        Approx(0.15 * alpha * alpha * (1 - 2 * alpha + 8 * alpha * alpha) * area).epsilon(1e-12));
  CHECK(energy(surface_law("surface-area", {0.2, 1, 0.3})) ==
        Approx((0.1 * (l2 - 1) * (l2 - 1) + 0.3 * l2) * area).epsilon(1e-12));
}

TEST_CASE(
    "Hooke's surface of Poisson's ratio 1/2 is the neo-Hookean one at small strains, and a sphere of it that is blown "
    "up has its energy") {
  auto random = generator(75);
  Surfaces s = one_cell(core::unit_sphere(3));
  std::uniform_real_distribution<double> any(-1e-6, 1e-6);
  for (auto& places : s.position) {
    for (double& place : places) place += any(random);
  }
  Surfaces other = s;
  SurfaceForces(s, {{surface_law("hooke", {0.3, 0.5})}}).run({}, s);
  SurfaceForces(other, {{surface_law("neo-hookean", {0.1, 0})}}).run({}, other);
  for (int i = 0; i < s.node_count(); ++i)
    CHECK((force_on(s, i) - force_on(other, i)).norm() < 1e-4 * largest_force(s));
  // A sphere that is blown up by l is stretched by l along both directions: w = E (l - 1)^2/(1 - nu).
  for (const double nu : {-0.5, 0.0, 0.3, 0.9}) {
    Surfaces blown = one_cell(core::unit_sphere(3), 1.3);
    SurfaceForces forces(blown, {{surface_law("hooke", {0.2, nu})}});
    CHECK(forces.energy(blown) == Approx(0.2 * 0.09 / (1 - nu) * blown.types[0]->rest_surface_area).epsilon(1e-12));
  }
}

TEST_CASE("the stiffness of laws of surfaces is the slope of their tension along one direction, the other at rest") {
  CHECK(core::stretching_stiffness(surface_law("hooke", {0.3, 0.5})) == Approx(0.3 / (1 - 0.25)).epsilon(1e-6));
  CHECK(core::stretching_stiffness(surface_law("hooke", {0.3, 0})) == Approx(0.3).epsilon(1e-6));
  CHECK(core::stretching_stiffness(surface_law("local-area", {0.3})) == Approx(0.3).epsilon(1e-6));
  CHECK(core::stretching_stiffness(surface_law("lim", {0.1, 0.3, -2, 8, 0.7, 0.75}), {1.0}) ==
        Approx(0.4).epsilon(1e-6));
  CHECK(core::tension_at(surface_law("local-area", {0.3}), 1.2) == Approx(0.06).epsilon(1e-12));
}

TEST_CASE("a law of triangles, nodes or bodies that gives its energy alone gets the forces of it") {
  auto random = generator(74);
  Surfaces s = one_cell(core::unit_sphere(3));
  deform(s, random, 0.05);
  const core::Facts of_triangles{
      .parameters = {}, .needs = {"invariant_1", "invariant_2"}, .gives = {"stress_1", "stress_2", "energy"}};
  const core::Facts of_nodes{.parameters = {}, .needs = {"area_ratio"}, .gives = {"area_tension", "energy"}};
  const core::Facts of_bodies{.parameters = {},
                              .needs = {"volume", "rest_volume", "surface_area", "rest_surface_area"},
                              .gives = {"pressure", "surface_tension", "energy"}};
  const MembraneLaws shipped = {surface_law("skalak", {0.1, 3, 0}), surface_law("local-area", {0.3}),
                                surface_law("lim", {0.1, 0.3, -2, 8, 0.7, 1.81}), surface_law("volume", {0.3, 0.9}),
                                surface_law("surface-area", {0.2, 1, 0})};
  const MembraneLaws derived = {core::membrane_law(membrane<SkalakEnergy>("energy", "1"), of_triangles),
                                core::membrane_law(membrane<LocalAreaEnergy>("energy", "1"), of_nodes),
                                core::membrane_law(membrane<LimEnergy>("energy", "1"), of_triangles),
                                core::membrane_law(membrane<BodyEnergy>("energy", "1"), of_bodies)};
  Surfaces other = s;
  SurfaceForces(s, {shipped}).run({}, s);
  SurfaceForces(other, {derived}).run({}, other);
  for (int i = 0; i < s.node_count(); ++i)
    CHECK((force_on(s, i) - force_on(other, i)).norm() < 1e-13 * largest_force(s));
}

TEST_CASE("a law that surfaces cannot have is refused by name") {
  const Surfaces s = one_cell(core::unit_sphere(2));
  const auto refused = [&](core::MembraneLaw law, const char* words) {
    CHECK_THROWS_WITH(SurfaceForces(s, {{law}}), Catch::Matchers::Contains(words));
  };
  refused(law("inextensible", {0.1}), "\"inextensible\" is no law of surfaces");
  core::MembraneLaw remembers = surface_law("neo-hookean", {0.1, 0});
  remembers.state.push_back({"damage", 0, 1});
  refused(remembers, "remembers \"damage\"");
}
