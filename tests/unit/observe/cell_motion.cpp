// Where a cell in three dimensions lies, how long it is, how it moves, how its membrane turns within its shape and how
// hollow it is, against shapes and motions that are known by formula.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/surface/triangle_surface.hpp"
#include "observe/cell_measures.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;

namespace {

constexpr double pi = std::numbers::pi;
const Domain<3> box({40, 40, 40}, {true, true, true});
const Vec<3> center(21, 17, 13);

Surfaces one(const TriangleSurface& shape) {
  Surfaces surfaces;
  surfaces.types.push_back(std::make_shared<const RestSurface>(rest_surface(shape)));
  add_cell(surfaces, 0, center);
  return surfaces;
}

/// place(p): where a node at p, counted from the center, is moved to.
template <class Place>
void shape(Surfaces& s, Place place) {
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> to = center + place(Vec<3>(s.nodes(0)[i] - center));
    for (int k = 0; k < 3; ++k) s.position[k][i] = to[k];
  }
}
template <class Velocity>
CellMeasures moved(Surfaces& s, Velocity velocity) {
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> at = velocity(Vec<3>(s.nodes(0)[i] - center));
    for (int k = 0; k < 3; ++k) s.velocity[k][i] = at[k];
  }
  return measure(s, 0, box, nullptr, 0);
}

Vec<3> turned(const Vec<3>& p, double angle) { return Eigen::AngleAxisd(angle, Vec<3>::UnitZ()) * p; }

}  // namespace

TEST_CASE(
    "a membrane that treads in an ellipsoid turns as often as it goes around, however the ellipsoid lies and turns") {
  const Vec<3> axes(6, 4, 3);
  const double rate = -2e-3;  // rad per step
  for (const double angle : {0.0, 0.3, 1.5, -1.2, pi / 2}) {
    CAPTURE(angle);
    Surfaces s = one(ellipsoid(8, axes));
    shape(s, [&](const Vec<3>& p) { return turned(p, angle); });
    // Keller and Skalak (J. Fluid Mech. 120, 1982): each node goes around an ellipse, all in the time 2 pi/rate.
    const auto treads = [&](const Vec<3>& p) {
      const Vec<3> own = turned(p, -angle);
      return turned(Vec<3>(-rate * axes.x() / axes.y() * own.y(), rate * axes.y() / axes.x() * own.x(), 0), angle);
    };
    const auto turns = [](const Vec<3>& p) -> Vec<3> { return 5e-3 * Vec<3>::UnitZ().cross(p); };
    const Vec<3> travels(0.02, -0.01, 0.03);
    CHECK(moved(s, treads).treading == Approx(rate).epsilon(1e-6));
    CHECK(std::abs(moved(s, turns).treading) < 1e-9);  // as a solid body
    CHECK(moved(s, [&](const Vec<3>& p) -> Vec<3> { return treads(p) + turns(p) + travels; }).treading ==
          Approx(rate).epsilon(1e-5));
    // A shape that is drawn out, and no node goes around.
    CHECK(std::abs(moved(s, [&](const Vec<3>& p) -> Vec<3> {
                     const Vec<3> own = turned(p, -angle);
                     return turned(Vec<3>(1e-3 * own.x(), -1e-3 * own.y(), 0), angle);
                   }).treading) < 1e-8);
  }
}

TEST_CASE("a sphere has no axes, and its membrane's turns are those of the sphere") {
  Surfaces s = one(ellipsoid(6, Vec<3>::Constant(5)));
  const auto turns = [](const Vec<3>& p) -> Vec<3> { return 5e-3 * Vec<3>::UnitZ().cross(p) + Vec<3>(0.1, 0, 0); };
  CHECK(moved(s, turns).treading == Approx(5e-3).epsilon(1e-6));
  // A sphere in shear, u = g y: half of the shear is rotation, so that it turns g/(4 pi) times in a unit of time.
  const double g = 1e-3;
  const auto shear = [&](const Vec<3>& p) { return Vec<3>(g / 2 * p.y(), -g / 2 * p.x(), 0); };
  CHECK(moved(s, shear).treading / (2 * pi) == Approx(-g / (4 * pi)).epsilon(1e-6));
  CHECK(moved(s, [](const Vec<3>&) -> Vec<3> { return Vec<3>::Zero(); }).treading == 0);
}

TEST_CASE("a cell's velocity is the mean of what it encloses, and its extents are those of its nodes") {
  const Vec<3> axes(6, 4, 3);
  Surfaces s = one(ellipsoid(10, axes));
  const CellMeasures m = moved(s, [](const Vec<3>& p) { return Vec<3>(-0.02 + 0.01 * p.y(), 0.3, 0.01 * p.x()); });
  CHECK(m.velocity == Approx(-0.02).epsilon(1e-9));
  for (int k = 0; k < 3; ++k) CHECK(m.extent[k] == Approx(2 * axes[k]).epsilon(0.01));
}

TEST_CASE(
    "the hollow at a cell's rear is as deep as its formula says, and a cell that goes the other way has another rear") {
  const auto ahead = [](double velocity) { return [=](const Vec<3>&) { return Vec<3>(velocity, 0, 0); }; };
  // A sphere of radius R that is bent to x + k (y^2 + z^2): k R^2 + 1/(4 k) - R on the side that becomes hollow.
  const double radius = 6, bend = 0.2;
  Surfaces bowl = one(ellipsoid(24, Vec<3>::Constant(radius)));
  CHECK(moved(bowl, ahead(0.01)).rear_hollow == Approx(0).margin(0.02));
  shape(bowl, [&](const Vec<3>& p) { return Vec<3>(p.x() + bend * (p.y() * p.y() + p.z() * p.z()), p.y(), p.z()); });
  CHECK(moved(bowl, ahead(-0.01)).rear_hollow ==
        Approx(bend * radius * radius + 1 / (4 * bend) - radius).epsilon(0.01));
  CHECK(moved(bowl, ahead(0.01)).rear_hollow == Approx(0).margin(0.02));
  // A red cell whose axis lies along x: Evans and Fung (1972), thickness 0.81 um in the middle and 2.57 um at most of
  // 7.82 um.
  Surfaces disc = one(biconcave_disc(24, 10));
  shape(disc, [&](const Vec<3>& p) { return turned(p, -pi / 2); });
  CHECK(moved(disc, ahead(0.01)).rear_hollow == Approx((2.57 - 0.81) / 2 / 3.91 * 10).epsilon(0.01));
  // Beside the middle there is nothing.
  Surfaces bent = one(ellipsoid(24, Vec<3>(3, 8, 2)));
  shape(bent, [](const Vec<3>& p) { return Vec<3>(p.x(), p.y(), p.z() + 0.2 * p.y() * p.y()); });
  CHECK(std::isnan(moved(bent, ahead(0.01)).rear_hollow));
}
