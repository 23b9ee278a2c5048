#include "stability/limits_run.hpp"

#include <catch2/catch.hpp>

#include "json/schema.hpp"

using namespace rouleau::json;
using namespace rouleau::stability;
using namespace rouleau::trial;
using Json = nlohmann::json;

namespace {

Judgement failed_at(long step) {
  return {false,
          "diverged",
          {{"reason", "node_step"}, {"step", step}, {"message", "a node, too fast"}, {"remedy", "slower"}}};
}

LimitsFile file_with_parameter() {
  LimitsFile limits;
  limits.title = "Edges";
  limits.parameter = LimitsParameter{"stiffness", "N/m", {"/stiffness"}, {1e-6, 1e-2}};
  limits.axes = {Axis{"coupling", {Setting{"explicit", {}, NAN}, Setting{"auto, semi", {}, NAN}}}};
  return limits;
}

}  // namespace

TEST_CASE("limits.json fits its schema, with edges and without", "[limits_files]") {
  LimitsFile limits = file_with_parameter();
  LimitsState state{&limits, {}, "now", ""};
  const auto validated = [&state] {
    Json result = limits_json(state);
    CHECK_NOTHROW(validate(Document::parse(result.dump(), "limits.json"), limits_result_schema()));
    return result;
  };
  CHECK(validated()["complete"] == false);
  const Judgement stable{true, "completed", nullptr};
  CombinationResult found{
      Point{{0}}, {{{StabilityEdge::Direction::above, 1e-4, 2e-4}}, {1e-6, 1e-2, 1e-4, 2e-4}, {1e-2}, true}, {}};
  found.trials = {{1e-6, stable}, {1e-2, stable}, {1e-4, stable}, {2e-4, failed_at(7)}};
  CombinationResult none{
      Point{{1}}, {{{StabilityEdge::Direction::above, {}, 1e-6}}, {1e-6}, {}, true}, {{1e-6, failed_at(3)}}};
  state.combinations = {found, none};
  state.finished = "later";
  const Json result = validated();
  CHECK(result["complete"] == true);
  CHECK(result["edges"][0]["failure"]["step"] == 7);
  CHECK(result["edges"][1]["stable_up_to"].is_null());
  CHECK(result["edges"][1]["failure"]["step"] == 3);
  REQUIRE(result["warnings"].size() == 1);
  CHECK(result["warnings"][0].get<std::string>().find("0.01 (stable)") != std::string::npos);
  const std::string csv = limits_csv(result), text = limits_text(result);
  CHECK(csv.find("stiffness,explicit,above,0.0001,0.0002,N/m,node_step,7\n") != std::string::npos);
  CHECK(csv.find("\"auto, semi\"") != std::string::npos);
  CHECK(text.find("stable up to 0.0001 N/m, fails at 0.0002 N/m: node_step at step 7") != std::string::npos);
  CHECK(text.find("stable nowhere") != std::string::npos);
}
