// What a flow that starts at rest in a dense fluid leaves behind, and when a plan warns of it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "plan/flow.hpp"
#include "plan/limits.hpp"
#include "plan/plan.hpp"
#include "plan/read_scene.hpp"

using namespace rouleau::plan;
using rouleau::plugin::Catalog;

namespace {

/// Finite differences for du/dt = u'' [+ 1], height 1: what FlowStart::rate_at is a series of, at each of these
/// instants.
std::vector<double> start_by_differences(bool driven, const std::vector<double>& instants) {
  constexpr int n = 80;
  const double h = 1.0 / n, dt = 0.4 * h * h;
  std::vector<double> u(n + 1), next(n + 1), rates;
  if (!driven) u.front() = next.front() = -0.5, u.back() = next.back() = 0.5;
  double time = 0;
  for (const double instant : instants) {
    for (; time < instant; time += dt) {
      for (int i = 1; i < n; ++i) next[i] = u[i] + dt * ((u[i + 1] - 2 * u[i] + u[i - 1]) / (h * h) + (driven ? 1 : 0));
      u.swap(next);
    }
    double rate = 0;
    for (const double v : u) rate += driven ? 12 * h * v : 0;
    rates.push_back(driven ? rate : (u[n / 2 + 1] - u[n / 2 - 1]) / (2 * h));
  }
  return rates;
}

/// The limits of a lone capsule's shear whose name begins so.
std::optional<Limit> limit_of(const std::string& begin, const std::vector<std::string>& overrides) {
  static const Catalog catalog({ROULEAU_PLUGINS});
  const auto read = read_within_limits(std::string(ROULEAU_PHYSICS_SCENES) + "/auto-capsule.json", overrides,
                                       [](const auto&) { return Catalog({ROULEAU_PLUGINS}); });
  for (const Limit& limit : find_limits(make_plan(read.scene, catalog, read.numerics_choice)))
    if (limit.name.starts_with(begin)) return limit;
  return {};
}
const std::string left = "what the start of the flow leaves at the end",
                  viscosity = "what the start of the flow leaves in the", costs = "strain that the start";
/// Re 1.67 in this channel: everything is late by a strain of 2.8.
const std::string dense = R"(/numerics={"tau": 1, "density_factor": 6250})", coarse = "/domain/nodes=[128, 64]",
                  segments = "/cell_types/capsule/segments=63", at_rest = "/stages/0/start=impulsive";

}  // namespace

TEST_CASE("a flow that starts at rest comes up as the diffusion equation has it") {
  for (const bool driven : {false, true}) {
    // Strain is time in units of height^2/nu.
    const FlowStart start{driven ? 1.0 / 10 : 1.0 / 24, driven};
    const std::vector<double> instants{0.01, 0.03, 0.06, 0.1, 0.2, 0.4}, exact = start_by_differences(driven, instants);
    for (std::size_t i = 0; i < instants.size(); ++i)
      CHECK(start.rate_at(instants[i]) == Approx(exact[i]).margin(2e-3));
    CHECK(start.left_at(0.2) == Approx(1 - exact[4]).epsilon(0.06));
    double delay = 0;
    for (double s = 0.0005; s < 2; s += 0.001) delay += 0.001 * (1 - start.rate_at(s));
    CHECK(delay == Approx(start.delay).epsilon(1e-3));
  }
  CHECK(FlowStart{}.rate_at(0) == 1);
  CHECK(FlowStart{}.left_at(0) == 0);
  CHECK(FlowStart{}.left_of_viscosity(1) == 0);
}

TEST_CASE("capsules relax as the boundary integral's steady angles say") {
  // Ca, viscosity ratio, angle in degrees, of tests/reference/capsule_channel.json.
  constexpr double cases[][3] = {
      {0.0125, 1, 36.042}, {0.05, 1, 30.258}, {0.1, 1, 26.679}, {0.2, 1, 22.557}, {0.05, 5, 17.700}};
  for (const auto& [ca, ratio, angle] : cases)
    CHECK(capsule_relaxation(ca, ratio) == Approx(1 / std::tan(2 * angle * std::numbers::pi / 180)).epsilon(0.02));
}

TEST_CASE("a plan warns where a start at rest leaves more than the target, or 1 %, at the end of a stage") {
  const auto with = [](const std::vector<std::string>& more) {
    std::vector<std::string> all{coarse, segments, dense, at_rest};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  CHECK_FALSE(limit_of(left, with({"/stages/0/start=developed"})));
  const std::string strain6 = "/stages/0/strain=6", strain20 = "/stages/0/strain=20";
  REQUIRE(limit_of(left, with({strain6})));
  CHECK(limit_of(left, with({strain6}))->margin < 1);
  CHECK(limit_of(viscosity, with({strain6}))->margin < 1);
  CHECK(limit_of(left, with({strain20}))->margin > 1);
  CHECK(limit_of(viscosity, with({strain20}))->margin > 1);
  CHECK(limit_of(left, with({strain6, "/fluid/inertia=true"}))->value == limit_of(left, with({strain6}))->value);
  // Only what makes the fluid denser than it is costs anything.
  CHECK_FALSE(limit_of(left, with({R"(/numerics={"tau": 1, "density_factor": 1})"})));
  // A stage that goes on with the flow of the one before it starts nothing.
  const std::string again = R"(/stages/-={"name": "again", "shear_rate": "20 1/s", "strain": 1})";
  CHECK_FALSE(limit_of(left + " of the stage, over the whole (stage again)", with({again})));
  // Without cells, too, where the flow itself is what is asked for: 2 exp(-S/T).
  CHECK(limit_of(left, with({strain6, "/cells=[]"}))->value ==
        Approx(2 * std::exp(-6 / (1.6667 * 40.96 / 39.478))).epsilon(0.01));
  // A cell that turns over passes every angle late.
  const std::string ellipse = R"(/cell_types/capsule/shape={"ellipse": {"semi_axes": ["5 um", "3 um"]}})";
  CHECK_FALSE(limit_of(left, with({ellipse})));
  CHECK(limit_of(costs, with({ellipse, strain20}))->value == Approx(1.6667 * 40.96 / 24 / 20).epsilon(1e-3));
  CHECK(limit_of(costs, with({ellipse, strain20}))->limit == 0.1);
  CHECK_FALSE(limit_of(costs, with({ellipse, strain20, "/fluid/inertia=true"})));
}

TEST_CASE("the target of auto is the limit of what a start costs") {
  const auto limit = limit_of(left, {R"(/numerics={"auto": {"of": "steady", "error": 0.03}})", at_rest});
  REQUIRE(limit);
  CHECK(limit->limit == 0.03);
  CHECK(limit->margin > 1);
  const auto motion = limit_of(costs, {R"(/numerics={"auto": {"error": 0.1}})", at_rest});
  REQUIRE(motion);
  CHECK(motion->limit == 0.1);
  CHECK(motion->margin > 1);
}
