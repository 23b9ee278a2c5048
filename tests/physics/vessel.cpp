// A vessel that narrows, end to end: what a run says of its walls, and of cells beside them.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "scene_run.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

constexpr double um = 1e-6;
const std::string file = std::string(ROULEAU_PHYSICS_SCENES) + "/vessel.json";

}  // namespace

TEST_CASE("the mean wall stress of a vessel carries what drives the flow through it") {
  const SceneRun run = run_scene(file, {"/cells=[]", "/interactions=[]"});
  REQUIRE(run.summary["status"] == "completed");
  // Once the flow is steady the force on the fluid, G times its area, is that on the walls, four sides.
  const double area = 40 * 12 * um * um, walls = 4 * std::hypot(20 * um, 4 * um);
  const auto lower = run.series_column("wall_stress_lower_Pa"), upper = run.series_column("wall_stress_upper_Pa");
  CHECK(lower.back() == Approx(2e4 * area / walls).epsilon(0.01));
  CHECK(upper.back() == lower.back());
  // As exactly as the vessel's area is known (docs/walls.md).
  const double flow = run.series_column("flow_rate_m2_per_s").back() * 40 * um;
  CHECK(run.series_column("mean_velocity_m_per_s").back() * area / flow == Approx(1).epsilon(1e-5));
}

TEST_CASE("cells at random in a vessel stay inside, and their share of the flow is that of their motion") {
  const SceneRun run = run_scene(file);
  REQUIRE(run.summary["status"] == "completed");
  const auto rate = run.series_column("flow_rate_m2_per_s"), discharge = run.series_column("discharge_hematocrit"),
             layer = run.series_column("cell_free_layer_lower_m");
  std::size_t count = 0;
  while (!run.column("x_m", static_cast<int>(count)).empty()) ++count;
  REQUIRE(count >= 2);
  // Between two outputs each cell goes as far as its flux says, within what accelerates it meanwhile.
  const auto time = run.column("time_s");
  double carried = 0, said = 0, flowed = 0;
  for (std::size_t n = 2; n < time.size(); ++n) {
    const double step = time[n] - time[n - 1];
    for (std::size_t c = 0; c < count; ++c) {
      const auto x = run.column("x_m", static_cast<int>(c)), area = run.column("area_m2", static_cast<int>(c));
      carried += (x[n] - x[n - 1]) * area[n];
    }
    said += step * (discharge[n] * rate[n] + discharge[n - 1] * rate[n - 1]) / 2 * 40 * um;
    flowed += step * (rate[n] + rate[n - 1]) / 2 * 40 * um;
  }
  CHECK(said == Approx(carried).epsilon(0.02));
  // Away from the walls they are faster than the fluid is on average.
  const double hematocrit = static_cast<double>(count) * run.column("area_m2")[0] / (40 * 12 * um * um);
  CHECK(carried / flowed > hematocrit);
  for (std::size_t c = 0; c < count; ++c) {
    for (const double gap : run.column("wall_gap_m", static_cast<int>(c))) CHECK(gap > 0.2 * um);
  }
  CHECK(*std::min_element(layer.begin(), layer.end()) > 0.2 * um);
  CHECK(*std::max_element(layer.begin(), layer.end()) < 8 * um);
}
