// Why the paper's Fig. 6 splits: the same run with convective inertia and without it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <iostream>

#include "scene_run.hpp"

using namespace rouleau::test;

TEST_CASE("at 1.3e-6 J/m2 and 50/s a rouleau parts into two pairs with inertia at Re 3.5, and never without",
          "[paper][weekly]") {
  const bool inertia = GENERATE(true, false);
  const SceneRun run =
      run_scene(std::string(ROULEAU_SCENES) + "/paper/fig6-inertia.json",
                {"/stages/1/strain=40", std::string("/fluid/inertia=") + (inertia ? "true" : "false")});
  REQUIRE(run.summary["status"] == "completed");
  const auto& history = run.summary["aggregate_history"];
  std::cout << "Fig. 6, inertia " << inertia << ":";
  for (const auto& event : history) std::cout << " " << event["strain"] << " " << event["members"].dump();
  std::cout << "\n";
  const auto parted = std::find_if(history.begin(), history.end(), [](const nlohmann::json& event) {
    return event["strain"].get<double>() > 0 && event["count"] > 1;
  });
  CHECK((parted != history.end()) == inertia);
  if (parted != history.end()) {
    CHECK((*parted)["members"] == nlohmann::json::parse("[[0, 1], [2, 3]]"));
    CHECK((*parted)["through_image"] == false);
  }
}
