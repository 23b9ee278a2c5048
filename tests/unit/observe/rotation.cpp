// The angle of aggregates: outermost cells, images, and continuation over turns.
#include "observe/rotation.hpp"
#include "unit/periodic_box.hpp"
#include "unit/random.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;

namespace {

using std::numbers::pi;
const Domain<2> hundred = test::periodic_box(100);

CellContact contact(int a, int b, ImageShift image = {}) { return {a, b, image, 0.1, 1}; }

/// Angles of `cells` with these contacts and centres, as a follower that sees them for the first time gives them.
std::map<int, double> angles(Rotation& rotation, const std::vector<CellContact>& contacts,
                             const std::vector<Eigen::Vector2d>& centers) {
  return rotation.follow(contacts, find_aggregates(static_cast<int>(centers.size()), contacts), centers, hundred);
}

/// A chain of four cells at this angle, in an order that is not the scene's.
std::vector<Eigen::Vector2d> chain(double angle) {
  std::vector<Eigen::Vector2d> centers;
  for (const double along : {-6.0, 18.0, 6.0, -18.0})
    centers.emplace_back(50 + along * std::cos(angle), 40 + along * std::sin(angle));
  return centers;
}
const std::vector<CellContact> links{contact(0, 3), contact(0, 2), contact(1, 2)};

}  // namespace

TEST_CASE("an aggregate's angle is that of the line through its outermost cells, whatever their order") {
  for (const double angle : {0.0, 0.3, pi / 2, -1.2}) {
    Rotation rotation;
    const auto found = angles(rotation, links, chain(angle));
    REQUIRE(found.size() == 1);
    CHECK(found.at(0) == Approx(angle).margin(1e-14));
  }
}

TEST_CASE("of many cells the outermost ones are those of all pairs") {
  std::mt19937 random = test::generator(7);
  std::uniform_real_distribution<double> across(10, 90), up(20, 60);
  for (const bool on_a_grid : {false, true}) {
    std::vector<Eigen::Vector2d> centers;
    std::vector<CellContact> chained;
    for (int k = 0; k < 400; ++k) {
      const double x = across(random), y = up(random);
      centers.emplace_back(on_a_grid ? std::round(x) : x, on_a_grid ? std::round(y) : y);
      if (k > 0) chained.push_back(contact(k - 1, k));
    }
    Eigen::Vector2d longest = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& a : centers) {
      for (const Eigen::Vector2d& b : centers)
        if ((b - a).squaredNorm() > longest.squaredNorm()) longest = b - a;
    }
    Rotation rotation;
    CHECK(angles(rotation, chained, centers).at(0) == Approx(std::remainder(std::atan2(longest.y(), longest.x()), pi)));
  }
}

TEST_CASE("cells that are not in an aggregate have no part in its angle, and lone cells have none") {
  Rotation rotation;
  // First and last of the scene are alone; the pairs are told by their smallest cells.
  const auto found =
      angles(rotation, {contact(1, 3), contact(2, 4)}, {{90, 70}, {10, 10}, {30, 30}, {10, 20}, {40, 30}, {5, 70}});
  CHECK(found.size() == 2);
  CHECK(found.at(1) == Approx(pi / 2));
  CHECK(found.at(2) == Approx(0).margin(1e-15));
}

TEST_CASE("cells are brought together through the images by which they touch") {
  // Cell 1 has drifted three boxes away; its image beside cell 0 lies to the left of it and below.
  Rotation rotation;
  const auto found = angles(rotation, {contact(0, 1, {-4, 0}), contact(1, 2, {3, 0})}, {{4, 30}, {394, 20}, {84, 10}});
  CHECK(found.at(0) == Approx(pi / 4));
}

TEST_CASE("an aggregate that is followed turns without jumps as long as its members stay the same") {
  Rotation rotation;
  double angle = 0;
  for (; angle > -3 * pi; angle -= 0.2)
    CHECK(angles(rotation, links, chain(angle)).at(0) == Approx(angle).margin(1e-12));
  SECTION("one that has lost a cell is another one, whose angle begins anew") {
    const auto found = angles(rotation, {contact(0, 2), contact(1, 2)}, chain(angle));
    CHECK(found.at(0) == Approx(std::remainder(angle, pi)).margin(1e-12));
  }
  SECTION("and so is one that comes together again") {
    angles(rotation, {}, chain(angle));
    CHECK(angles(rotation, links, chain(angle)).at(0) == Approx(std::remainder(angle, pi)).margin(1e-12));
  }
}

TEST_CASE("an aggregate that is closed to a ring through the periodic border has no ends and no angle") {
  Rotation rotation;
  CHECK(
      angles(rotation, {contact(0, 1), contact(1, 2), contact(0, 2, {-1, 0})}, {{20, 30}, {50, 30}, {80, 30}}).empty());
  // A cell that touches its own image is one too, with whoever hangs on it.
  CHECK(angles(rotation, {contact(0, 0, {1, 0}), contact(0, 1)}, {{50, 30}, {50, 40}}).empty());
}
