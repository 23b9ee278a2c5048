// What a scene asks of its models.
#include "plan/plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "plan/read_scene.hpp"
#include "plugin/plugin_folder.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using Catch::Matchers::Contains;

namespace {

/// An operator that takes and gives this; its library is never opened.
nlohmann::json operator_with(const std::string& id, const std::vector<std::string>& needs,
                             const std::vector<std::string>& gives) {
  return {{"manifest", 1},
          {"abi", 1},
          {"version", "1.0.0"},
          {"library", "libthird.so"},
          {"title", "An operator"},
          {"license", "MIT"},
          {"kind", "collision"},
          {"id", id},
          {"needs", needs},
          {"gives", gives},
          {"lattices", {"D2Q9", "D3Q19"}},
          {"parameters", nlohmann::json::array()}};
}

class Refusals {
 public:
  Refusals() {
    folder_.copy(TESTED_third_party, "libthird.so");
    folder_.write("rate.json",
                  operator_with("org.example.no-rate", {"populations", "force"}, {"populations", "velocity"}));
    folder_.write("force.json", operator_with("org.example.no-force", {"populations", "relaxation_rate"},
                                              {"populations", "velocity"}));
    folder_.write("velocity.json", operator_with("org.example.no-velocity", {"populations", "force", "relaxation_rate"},
                                                 {"populations"}));
  }
  /// What the operator is refused for in a shipped scene; empty: it would be taken.
  [[nodiscard]] std::string of(const std::string& id, const std::string& name, std::vector<std::string> changes) const {
    changes.push_back("/fluid/collision={\"model\": \"" + id + "\"}");
    const scene::Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/" + name, changes);
    const plugin::Catalog catalog({ROULEAU_PLUGINS, folder_.path()});
    try {
      make_plan(scene, catalog);
    } catch (const Error& refused) {
      if (refused.cause() == Cause::plugin_refused) return {};  // it was opened, and is none
      CHECK(refused.place().pointer == "/fluid/collision/model");
      return refused.what();
    }
    return {};
  }

 private:
  test::PluginFolder folder_;
};

const std::string alike = R"(/cell_types/rbc/interior_viscosity="1.2 cP")", nobody = "/cells=[]",
                  no_interaction = "/interactions=[]";

}  // namespace

TEST_CASE("an operator that does not take what a scene gives it is refused at its place, with those that do") {
  const Refusals refusals;
  for (const char* scene : {"four-cells-shear.json", "red-cell-3d.json"}) {
    INFO(scene);
    const std::string contrast = R"(/cell_types/rbc/interior_viscosity="6 cP")";
    CHECK_THAT(refusals.of("org.example.no-rate", scene, {contrast}),
               Contains("does not take relaxation_rate") && Contains("another viscosity") && Contains("trt"));
    CHECK(refusals.of("org.example.no-rate", scene, {alike}).empty());
    CHECK_THAT(refusals.of("org.example.no-force", scene, {alike}),
               Contains("does not take force") && Contains("membranes act on the fluid"));
    CHECK_THAT(refusals.of("org.example.no-velocity", scene, {alike}),
               Contains("does not give velocity") && !Contains("org.example.no-rate cannot"));
    CHECK(refusals
              .of("org.example.no-force", scene,
                  {nobody, no_interaction,
                   "/stages=[{\"name\": \"shear\", "
                   "\"shear_rate\": \"20 1/s\", \"strain\": 1}]"})
              .empty());
  }
}

TEST_CASE("whatever drives a fluid alone wants an operator that takes a force, along whatever axis") {
  const Refusals refusals;
  const auto refused = [&](const std::string& stage, const std::vector<std::string>& more = {}) {
    std::vector<std::string> changes{nobody, no_interaction, "/output={}",
                                     R"(/stages=[{"name": "flow", "duration": "1 ms")" + stage + "}]"};
    changes.insert(changes.end(), more.begin(), more.end());
    return refusals.of("org.example.no-force", "red-cell-3d.json", changes);
  };
  for (const char* stage :
       {R"(, "pressure_gradient": "1 Pa/m")", R"(, "mean_velocity": "1 mm/s")",
        R"(, "pressure_gradient": 0, "oscillation": {"amplitude": "1 Pa/m", "frequency": "5 Hz"})"}) {
    CHECK_THAT(refused(stage), Contains("does not take force: a force drives the fluid in stage flow"));
  }
  for (const char* force :
       {R"(["1 N/m3", "0 N/m3", "0 N/m3"])", R"(["0 N/m3", "1 N/m3", "0 N/m3"])", R"(["0 N/m3", "0 N/m3", "1 N/m3"])"})
    CHECK_THAT(refused("", {std::string("/fluid/body_force=") + force}), Contains("fluid.body_force drives"));
  CHECK(refused(R"(, "shear_rate": "20 1/s")").empty());
  CHECK_THAT(refusals.of("org.example.no-rate", "four-cells-shear.json",
                         {nobody, no_interaction, R"(/stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 1}])",
                          R"(/fluid/layers=[{"from": "0 um", "to": "9.8 um", "viscosity": "6 cP"}])"}),
             Contains("relaxation_rate") && Contains("fluid.layers"));
}
