// Cells on top of each other are found by their centres alone, across periodic borders too.
#include "shape/crowding.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "plan/placed_cells.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

scene::Scene scene_of_circles(bool periodic_y) {
  scene::Scene scene{};
  scene.domain = {{20e-6, 10e-6}, {200, 100}, {}, {true, periodic_y, true}};
  scene.cell_types = {{"small", scene::Circle{0.2e-6}, 64, 1e-3, {}}, {"large", scene::Circle{0.5e-6}, 64, 1e-3, {}}};
  return scene;
}

/// The largest circle within a regular polygon of 64 sides.
double inner_radius(int type) { return (type == 0 ? 0.2e-6 : 0.5e-6) * std::cos(M_PI / 64); }

bool is_crowded(const scene::Scene& scene, std::size_t a, std::size_t b) {
  const double room = inner_radius(scene.cells[a].type) + inner_radius(scene.cells[b].type);
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      if (j != 0 && !scene.domain.periodic[1]) continue;
      const scene::Vector image(i * scene.domain.size.x(), j * scene.domain.size.y());
      if ((scene.cells[a].center - scene.cells[b].center + image).norm() < room) return true;
    }
  }
  return false;
}

}  // namespace

TEST_CASE("a crowded pair is found where there is one, and only there") {
  const auto seed = Catch::rngSeed();
  INFO("seed " << seed);
  std::mt19937 random(seed);
  int crowded = 0, apart = 0;
  for (int scene_count = 0; scene_count < 400; ++scene_count) {
    scene::Scene scene = scene_of_circles(scene_count % 2 == 0);
    // Places may lie in other images of the box.
    std::uniform_real_distribution<double> x(-20e-6, 40e-6), y(-10e-6, 20e-6);
    for (int i = 0; i < 16; ++i) {
      scene.cells.push_back({static_cast<int>(random() % 2), {x(random), y(random)}, 0, "/cells/0"});
    }
    bool any = false;
    for (std::size_t a = 0; a < scene.cells.size(); ++a) {
      for (std::size_t b = a + 1; b < scene.cells.size(); ++b) any = any || is_crowded(scene, a, b);
    }
    const auto pair = shape::find_crowded_pair(scene);
    REQUIRE(pair.has_value() == any);
    if (pair) CHECK(is_crowded(scene, static_cast<std::size_t>(pair->cell), static_cast<std::size_t>(pair->other)));
    (any ? crowded : apart) += 1;
  }
  CHECK(crowded > 50);
  CHECK(apart > 50);
}

TEST_CASE("a million cells in a row on top of each other are refused before memory is asked for") {
  scene::Scene scene = scene_of_circles(false);
  scene.cell_types[0].shape = scene::Circle{3e-9};
  scene.cell_types[0].segments = 1000;  // 400 GB of membranes
  for (int i = 0; i < 1'000'000; ++i) {
    scene.cells.push_back({0, {1e-6 + 1e-12 * i, 5e-6}, 0, "/cells/0"});
  }
  CHECK_THROWS_WITH(plan::make_cells<2>(scene, 1e-7),
                    Contains("(/cells/0) overlap: their centres are 1e-06 um apart; move them apart."));
}

TEST_CASE("cells that are tried strip by strip are refused where all at once are") {
  const auto seed = Catch::rngSeed();
  INFO("seed " << seed);
  std::mt19937 random(seed);
  int refused = 0, right = 0;
  const auto says = [](auto function) -> std::string {
    try {
      function();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  for (int scene_count = 0; scene_count < 300; ++scene_count) {
    const bool periodic = scene_count % 2 == 0;
    scene::Scene scene = scene_of_circles(periodic);
    std::uniform_real_distribution<double> x(-20e-6, 40e-6), y(periodic ? -10e-6 : 0.3e-6, periodic ? 20e-6 : 9.7e-6);
    for (int i = 0; i < 9; ++i)
      scene.cells.push_back({static_cast<int>(random() % 2), {x(random), y(random)}, 0, "/cells/0"});
    const std::string at_once = says([&] { plan::make_cells<2>(scene, 1e-7); });
    for (const std::size_t of_strip : {1, 2, 5}) {
      const std::string in_strips = says([&] { plan::try_cells(scene, of_strip); });
      REQUIRE(in_strips.empty() == at_once.empty());
    }
    (at_once.empty() ? right : refused) += 1;
  }
  CHECK(refused > 30);
  CHECK(right > 30);
}
