// Signed distances of regions against formulas and against trying all facets.
#include <Eigen/Geometry>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "random.hpp"

using namespace rouleau::core;
using Catch::Detail::Approx;

namespace {

template <int D>
Vec<D> random_place(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> component(-reach, reach);
  Vec<D> place;
  for (int k = 0; k < D; ++k) place[k] = component(random);
  return place;
}

/// The twelve triangles of a box.
Border<3> box_of_triangles(const Vec<3>& lower, const Vec<3>& upper, const Eigen::Matrix3d& turned) {
  std::vector<Vec<3>> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(
        turned * Vec<3>((i & 1) ? upper[0] : lower[0], (i & 2) ? upper[1] : lower[1], (i & 4) ? upper[2] : lower[2]));
  return {corners,
          {{0, 2, 3},
           {0, 3, 1},
           {4, 5, 7},
           {4, 7, 6},
           {0, 1, 5},
           {0, 5, 4},
           {2, 6, 7},
           {2, 7, 3},
           {0, 4, 6},
           {0, 6, 2},
           {1, 3, 7},
           {1, 7, 5}}};
}

/// A star of so many points, whose radius changes from corner to corner.
FacetedRegion<2> star(const std::vector<double>& radii, std::vector<Vec<2>>& corners) {
  const int n = static_cast<int>(radii.size());
  std::vector<std::array<int, 2>> facets;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    corners.emplace_back(radii[i] * std::cos(angle), radii[i] * std::sin(angle));
    facets.push_back({i, (i + 1) % n});
  }
  return FacetedRegion<2>({corners, facets});
}

/// By crossings of a ray along x.
bool inside_polygon(const std::vector<Vec<2>>& corners, const Vec<2>& place) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec<2>&a = corners[i], &b = corners[j];
    if ((a[1] > place[1]) != (b[1] > place[1]) && place[0] < (b[0] - a[0]) * (place[1] - a[1]) / (b[1] - a[1]) + a[0])
      inside = !inside;
  }
  return inside;
}

template <int D>
void check_gradient(const Region<D>& region, const Vec<D>& place, const Distance<D>& found) {
  constexpr double h = 1e-6;
  CHECK(found.gradient.norm() == Approx(1).epsilon(1e-9));
  for (int k = 0; k < D; ++k) {
    const double difference =
        (region.distance(place + h * Vec<D>::Unit(k)).value - region.distance(place - h * Vec<D>::Unit(k)).value) /
        (2 * h);
    CHECK(found.gradient[k] == Approx(difference).margin(1e-5));
  }
}

}  // namespace

TEST_CASE("The distance to a turned box of triangles is that of the formula", "[distances]") {
  std::mt19937 random = rouleau::test::generator(49);
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.7, Vec<3>(1, 2, 3).normalized()).toRotationMatrix();
  const Vec<3> lower(-3, -1, -2), upper(2, 4, 1.5);
  const auto formula = box_region<3>(lower, upper);
  const FacetedRegion<3> triangles(box_of_triangles(lower, upper, turned));
  for (int i = 0; i < 2000; ++i) {
    const Vec<3> place = random_place<3>(random, 7);
    const Distance<3> wanted = formula->distance(place), found = triangles.distance(turned * place);
    CHECK(found.value == Approx(wanted.value).margin(1e-12));
    CHECK((found.gradient - turned * wanted.gradient).norm() < 1e-9);
  }
}

TEST_CASE("The distance to a star is that of the nearest of all segments, its sign that of a ray's crossings",
          "[distances]") {
  std::mt19937 random = rouleau::test::generator(49);
  std::uniform_real_distribution<double> radius(0.5, 5);
  for (int shape = 0; shape < 20; ++shape) {
    std::vector<double> radii(3 + 7 * shape);
    for (double& r : radii) r = radius(random);
    std::vector<Vec<2>> corners;
    const FacetedRegion<2> region = star(radii, corners);
    for (int i = 0; i < 200; ++i) {
      const Vec<2> place = random_place<2>(random, 6);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec<2> a = corners[k], along = corners[(k + 1) % corners.size()] - a;
        const double share = std::clamp((place - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (place - a - share * along).norm());
      }
      const Distance<2> found = region.distance(place);
      CHECK(std::abs(found.value) == Approx(least).margin(1e-12));
      CHECK((found.value > 0) == inside_polygon(corners, place));
    }
  }
}

TEST_CASE("Gradients are derivatives of the distance", "[distances]") {
  std::mt19937 random = rouleau::test::generator(49);
  const RegionPointer<3> cylinder = extruded(ball_region<2>({1, 2}, 3), 0, -4, 5);
  const RegionPointer<3> tube = outside_of(extruded(ball_region<2>({1, 2}, 3), 1, -INFINITY, INFINITY));
  const auto both = union_of<3>({cylinder, box_region<3>({-1, -1, -1}, {7, 1, 1})});
  const FacetedRegion<3> triangles(box_of_triangles({-3, -1, -2}, {2, 4, 1.5}, Eigen::Matrix3d::Identity()));
  for (const Region<3>* region : {cylinder.get(), tube.get(), both.get(), static_cast<const Region<3>*>(&triangles)}) {
    for (int i = 0; i < 200; ++i) {
      const Vec<3> place = random_place<3>(random, 8);
      const Distance<3> found = region->distance(place);
      const Vec<3> aside = Vec<3>::Constant(1e-5);
      if ((region->distance(place + aside).gradient - found.gradient).norm() > 1e-4 ||
          (region->distance(place - aside).gradient - found.gradient).norm() > 1e-4)
        continue;  // where two parts of the border are as near
      check_gradient<3>(*region, place, found);
    }
  }
}

TEST_CASE("A cylinder's distance is exact inside, outside, beyond its ends and at its rim", "[distances]") {
  const RegionPointer<3> cylinder = extruded(ball_region<2>({1, 2}, 3), 2, -4, 5);
  CHECK(cylinder->distance({1, 2, 0}).value == Approx(3));
  CHECK(cylinder->distance({3.5, 2, 0}).value == Approx(0.5));
  CHECK(cylinder->distance({1, 2, 4.75}).value == Approx(0.25));
  CHECK(cylinder->distance({1, 2, 7}).value == Approx(-2));
  CHECK(cylinder->distance({1, 8, 0}).value == Approx(-3));
  CHECK(cylinder->distance({1, 8, 9}).value == Approx(-5));
  CHECK(cylinder->distance({1, 8, 9}).gradient[1] == Approx(-0.6));
  CHECK(cylinder->distance({1, 8, 9}).gradient[2] == Approx(-0.8));
}

TEST_CASE("A region and its images come again after every period", "[distances]") {
  std::mt19937 random = rouleau::test::generator(49);
  const Domain<2> domain({10, 8}, {true, false});
  const auto region = repeated<2>(ball_region<2>({9.5, 4}, 2), {9.5, 4}, domain);
  CHECK(region->distance({0, 4}).value == Approx(1.5));
  for (int i = 0; i < 100; ++i) {
    const Vec<2> place = random_place<2>(random, 12);
    for (const int periods : {-3, -1, 2}) {
      const Vec<2> image = place + Vec<2>(10. * periods, 0);
      CHECK(region->distance(image).value == Approx(region->distance(place).value).margin(1e-12));
    }
  }
}

TEST_CASE("A link is cut where the distance vanishes", "[distances]") {
  std::mt19937 random = rouleau::test::generator(49);
  const double radius = 4.3;
  const auto ball = ball_region<3>({0.1, 0.2, -0.3}, radius);
  int cut = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec<3> place = random_place<3>(random, 6).array().round(), by = random_place<3>(random, 1.4).array().round();
    if (by.isZero() || ball->distance(place).value <= 0 || ball->distance(place + by).value > 0) continue;
    const Vec<3> from = place - Vec<3>(0.1, 0.2, -0.3);  // |from + share by| = radius
    const double a = by.squaredNorm(), b = from.dot(by), c = from.squaredNorm() - radius * radius;
    const double wanted = (std::sqrt(b * b - a * c) - b) / a;
    CHECK(ball->share_inside(place, by) == Approx(wanted).epsilon(1e-12));
    CHECK(ball->Region<3>::share_inside(place, by) ==
          Approx(wanted).epsilon(1e-12));  // as for regions without a formula
    ++cut;
  }
  CHECK(cut > 50);
}

TEST_CASE("A border with a facet without size is refused", "[distances]") {
  CHECK_THROWS_AS(FacetedRegion<2>({{{0, 0}, {1, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(FacetedRegion<2>(Border<2>{}), std::invalid_argument);
}

TEST_CASE("A box of triangles from end to end of a periodic axis is a channel without ends", "[distances]") {
  std::mt19937 random = rouleau::test::generator(53);
  const Domain<3> domain({10, 12, 12}, {true, true, false});
  for (const double beyond : {0.0, 2.5}) {  // its ends in the domain's, or outside
    const Border<3> box = box_of_triangles({-0.5 - beyond, 2, 3}, {9.5 + beyond, 7, 8}, Eigen::Matrix3d::Identity());
    CHECK(open_sides(box).empty());
    const FacetedRegion<3> channel(with_images(box, domain));
    const auto formula = box_region<3>({-INFINITY, 2, 3}, {INFINITY, 7, 8});
    std::uniform_real_distribution<double> along(-0.5, 9.5), across(0, 9.5);
    for (int i = 0; i < 500; ++i) {
      const Vec<3> place(along(random), across(random), across(random));
      CHECK(channel.distance(place).value == Approx(formula->distance(place).value).margin(1e-9));
    }
  }
}

TEST_CASE("An obstacle over a periodic end is seen from both sides", "[distances]") {
  const Domain<2> domain({10, 8}, {true, false});
  const Border<2> square{{{-1.5, 2}, {0.5, 2}, {0.5, 4}, {-1.5, 4}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  const FacetedRegion<2> region(with_images(square, domain));
  CHECK(region.distance({9, 3}).value == Approx(0.5));
  CHECK(region.distance({7.5, 3}).value == Approx(-1));
  CHECK(region.distance({1.5, 3}).value == Approx(-1));
}

TEST_CASE("What is not closed is found, with its place", "[distances]") {
  Border<3> box = box_of_triangles({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity());
  std::swap(box.facets[4][0], box.facets[4][1]);
  CHECK(open_sides(box).size() == 3);
  box.facets.erase(box.facets.begin() + 4);
  CHECK(open_sides(box).size() == 3);
  CHECK(open_sides(Border<2>{{{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 2}}}).size() == 2);
}
