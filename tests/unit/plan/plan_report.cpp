// What a plan reports, and in which order.
#include "plan/plan_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"
#include "plugin/plugin_folder.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using Catch::Matchers::Contains;

namespace {

const plugin::Catalog& plugins_of_reports() {
  static const plugin::Catalog catalog({ROULEAU_PLUGINS});
  return catalog;
}
scene::Scene held_by_walls(const std::string& interactions) {
  return read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", {"/interactions=" + interactions});
}
const PlannedPass* pass_named(const PlanReport& report, const std::string& name) {
  for (const PlannedPass& pass : report.passes)
    if (pass.name == name) return &pass;
  return nullptr;
}
std::string why_left_out(const PlanReport& report, const std::string& what) {
  for (const Omission& omission : report.left_out)
    if (omission.what == what) return omission.why;
  return "";
}

/// Does the plan of a shipped scene with these changes have a warning that begins so?
bool warns(const std::string& name, const std::vector<std::string>& changes, const std::string& beginning) {
  const scene::Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/" + name, changes);
  const PlanReport report = make_report(make_plan(scene, plugins_of_reports()));
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& warning) { return warning.starts_with(beginning); });
}

TEST_CASE("a plan says by how much a start from rest makes a stage late") {
  const auto late = [](const std::vector<std::string>& changes) {
    scene::Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", changes);
    const Plan plan = make_plan(scene, plugins_of_reports());
    return make_report(plan).late_starts;
  };
  // Mean lag of a Couette flow that starts from rest, H^2/(24 nu) at this rate, of a fluid that is so many times
  // denser.
  const auto found = late({});
  REQUIRE(found.size() == 1);
  CHECK(found[0].stage == "shear");
  CHECK(found[0].strain == Approx(2999 * 20 * 25.088e-6 * 25.088e-6 / (24 * 1.2e-6)).epsilon(1e-6));
  CHECK(found[0].stage_strain == Approx(15).epsilon(1e-3));
  CHECK_THAT(in_words(found[0]), Contains("in stage shear") && Contains("strain of 1.31 (of 15)"));
  CHECK(late({"/stages/1/start=developed"}).empty());
  CHECK(late({"/numerics/density_factor=300"}).empty());  // 0.9 %
  CHECK(late({"/fluid/inertia=true", "/numerics/density_factor=1"}).empty());
}

const std::string morse_wall =
    R"({"between": ["wall", "rbc"], "model": "morse", "parameters": {"depth": "1e-7 J/m2", "decay": "30 1/um"}})";
const std::string morse_cells =
    R"({"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": "5.2e-8 J/m2"}})";

}  // namespace

TEST_CASE("a plan shows the speeds of walls that have a mean, and holds the faster one to the limit") {
  const scene::Scene scene = read_scene(
      std::string(ROULEAU_SCENES) + "/four-cells-shear.json",
      {R"(/stages=[{"name": "flow", "duration": "1 s", "walls": {"lower": "-0.5 mm/s", "upper": "0.1 mm/s"}}])",
       "/output={}"});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const Plan plan = make_plan(scene, catalog);
  const PlanReport report = make_report(plan);
  std::map<std::string, double> si, lattice;
  for (const Conversion& row : report.conversions) si[row.quantity] = row.si, lattice[row.quantity] = row.lattice;
  CHECK(si.at("lower wall's speed") == Approx(-0.5e-3).epsilon(1e-12));
  CHECK(si.at("upper wall's speed") == Approx(0.1e-3).epsilon(1e-12));
  CHECK(si.at("shear rate") == Approx(0.6e-3 / 25.088e-6).epsilon(1e-12));
  const double faster = std::abs(lattice.at("lower wall's speed"));
  CHECK(report.dimensionless.at("mach_wall") == Approx(faster * std::sqrt(3.0)).epsilon(1e-12));
  const auto limit = std::find_if(report.limits.begin(), report.limits.end(),
                                  [](const Limit& l) { return l.name.starts_with("Mach number of the walls"); });
  REQUIRE(limit != report.limits.end());
  CHECK(limit->value == report.dimensionless.at("mach_wall"));
  CHECK_THAT(limit->remedy, Contains("the walls' speeds"));
}

TEST_CASE(
    "a potential with walls has a well, limits and a place in the pass of interactions, but no neighbour search") {
  const scene::Scene scene = held_by_walls("[" + morse_wall + "]");
  const Plan plan = make_plan(scene, plugins_of_reports());
  CHECK(plan.owner_of(plan.interactions[0]) == "rbc, wall");
  CHECK(plan.has_wall_interactions);
  CHECK_FALSE(plan.has_interactions);
  const PlanReport report = make_report(plan);
  REQUIRE(report.wells.size() == 1);
  CHECK(report.wells[0].between == std::array<std::string, 2>{"rbc", "wall"});
  CHECK(report.wells[0].well.depth == Approx(1e-7).epsilon(1e-9));
  // 1e-7 J/m2 over 1.2 mPa s x 20 1/s x 3.91 um.
  CHECK(report.dimensionless.at("adhesion_number") == Approx(1e-7 / (1.2e-3 * 20 * 3.91e-6)).epsilon(1e-9));
  REQUIRE(pass_named(report, "interaction") != nullptr);
  CHECK(pass_named(report, "interaction")->why.find("walls") != std::string::npos);
  CHECK(why_left_out(report, "neighbour search") == "no interaction between cells is active");
  // 2/(30 1/um) are 0.34 spacings of 0.196 um: too narrow for the corners of two cells, wide enough for a wall.
  const auto width = std::find_if(report.limits.begin(), report.limits.end(), [](const Limit& limit) {
    return limit.name.starts_with("width of the well of morse");
  });
  REQUIRE(width != report.limits.end());
  CHECK(width->value == Approx(2 / (30e6 * 0.196e-6)).epsilon(1e-3));
  CHECK(width->limit == 0.25);
  const core::SolverSetup setup = make_solver_setup(plan, 0);
  CHECK(setup.interactions.empty());
  REQUIRE(setup.wall_interactions.size() == 1);
  CHECK(setup.wall_interactions[0].type == 0);
}

TEST_CASE("cells are joined by wells and by bonds between them, by nothing else") {
  const auto attracting = [](const std::string& interactions) {
    const scene::Scene scene = held_by_walls("[" + interactions + "]");
    return make_report(make_plan(scene, plugins_of_reports())).attracting;
  };
  const std::string cells = R"({"between": ["rbc", "rbc"], )";
  const std::string repulsion =
      cells + R"("model": "repulsion", "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}})";
  const std::string morse = cells + R"("model": "morse", "parameters": {"depth": "1e-8 J/m2"}})";
  const std::string off = cells + R"("model": "morse", "parameters": {"depth": "0 J/m2"}})";
  const std::string cut = cells + R"("model": "morse", "parameters": {"depth": "1e-8 J/m2", "cutoff": "0.4 um"}})";
  const std::string bonds = cells + R"("model": "bridging", "parameters": {"site_density": "1e12 1/m2",
    "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "200 1/s", "off_rate": "10 1/s",
    "cutoff": "1.5 um"}})";
  for (const std::string& nothing : {std::string(), repulsion, off, cut, morse_wall}) {
    INFO(nothing);
    CHECK(attracting(nothing).empty());
  }
  for (const std::string& joined : {morse, bonds, repulsion + "," + morse}) {
    INFO(joined);
    const scene::Attractions found = attracting(joined);
    REQUIRE(found.size() == 1);
    CHECK(found.begin()->first == std::array<std::string, 2>{"rbc", "rbc"});
    if (joined == bonds)
      CHECK(std::isnan(found.begin()->second));
    else
      CHECK(found.begin()->second == Approx(1e-8).epsilon(1e-6));
  }
  CHECK(attracting(morse + "," + morse).begin()->second == Approx(2e-8).epsilon(1e-6));
}

TEST_CASE("potentials of walls and of cells are told apart by what they act between") {
  const scene::Scene scene = held_by_walls("[" + morse_cells + "," + morse_wall + "]");
  const Plan plan = make_plan(scene, plugins_of_reports());
  CHECK(plan.has_interactions);
  CHECK(plan.has_wall_interactions);
  const PlanReport report = make_report(plan);
  CHECK(why_left_out(report, "neighbour search").empty());
  int of_cells = 0, of_walls = 0;
  for (const Limit& limit : report.limits) {
    of_cells += limit.name.starts_with("equilibrium gap of morse (rbc, rbc)") ? 1 : 0;
    of_walls += limit.name.starts_with("equilibrium gap of morse (rbc, wall)") ? 1 : 0;
  }
  CHECK(of_cells == 1);
  CHECK(of_walls == 1);
  const core::SolverSetup setup = make_solver_setup(plan, 0);
  CHECK(setup.interactions.size() == 1);
  CHECK(setup.wall_interactions.size() == 1);
}

TEST_CASE("a potential that rubs is refused between cells and walls, one that remembers is not") {
  const test::PluginFolder folder;
  folder.copy(TESTED_third_party, "libthird.so");
  folder.write("interaction.json", nlohmann::json{{"manifest", 1},
                                                  {"abi", 1},
                                                  {"version", "1.0.0"},
                                                  {"library", "libthird.so"},
                                                  {"title", "Third party's"},
                                                  {"license", "MIT"},
                                                  {"kind", "interaction"},
                                                  {"id", "org.example.rubs"},
                                                  {"needs", {"distance", "tangential_velocity"}},
                                                  {"gives", {"force", "energy"}},
                                                  {"parameters", nlohmann::json::array()}});
  const plugin::Catalog catalog({ROULEAU_PLUGINS, folder.path()});
  const scene::Scene rubs = held_by_walls(R"([{"between": ["rbc", "wall"], "model": "org.example.rubs"}])");
  try {
    make_plan(rubs, catalog);
    FAIL("it was not refused");
  } catch (const Error& refused) {
    CHECK(refused.place().pointer == "/interactions/0/model");
    CHECK_THAT(refused.what(), Contains("org.example.rubs") && Contains("tangential_velocity"));
  }
  const scene::Scene bonds = held_by_walls(R"([{"between": ["rbc", "wall"], "model": "bridging", "parameters": {
    "site_density": "1e12 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "200 1/s",
    "off_rate": "10 1/s", "cutoff": "1.5 um"}}])");
  const Plan plan = make_plan(bonds, catalog);
  CHECK(make_report(plan).wells.empty());
  CHECK(make_solver_setup(plan, 0).wall_interactions.at(0).potential.state.size() == 1);
}

TEST_CASE("a scene without interactions with walls has neither their pass nor their forces") {
  const scene::Scene none = held_by_walls("[]"), idle = held_by_walls(R"([{"between": ["rbc", "wall"], "model": "morse",
    "parameters": {"depth": 0}}])");
  for (const scene::Scene* scene : {&none, &idle}) {
    const Plan plan = make_plan(*scene, plugins_of_reports());
    CHECK(pass_named(make_report(plan), "interaction") == nullptr);
    CHECK(make_solver_setup(plan, 0).wall_interactions.empty());
  }
  CHECK(why_left_out(make_report(make_plan(idle, plugins_of_reports())), "interaction morse").starts_with("inactive"));
}

TEST_CASE(
    "warnings go from what the scene says to what follows from it: parameters, flow, kernel, slip, auto, limits") {
  const scene::Scene scene =
      read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json",
                 {R"(/cell_types/rbc/membrane/0/parameters/shear_modulus="6 N/m")", R"(/domain/y="periodic")",
                  R"(/stages=[{"name": "fall", "duration": "1 s", "pressure_gradient": "3 Pa/m"}])", "/output={}",
                  "/numerics/kernel=roma3", "/numerics/slip_correction=true"});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const Plan plan = make_plan(
      scene, catalog,
      NumericsChoice{.target = 0.01, .steady = false, .expected = {}, .values = {}, .doubt = "there is a doubt"});
  const PlanReport report = make_report(plan);
  const std::vector<std::string>& warnings = report.warnings;
  REQUIRE(warnings.size() > 5);
  CHECK_THAT(warnings[0], Contains("shear_modulus"));
  CHECK_THAT(warnings[1], Contains("no wall holds it"));
  CHECK_THAT(warnings[2], Contains("kernel roma3"));
  CHECK_THAT(warnings[3], Contains("numerics.slip_correction with attracting cells"));
  CHECK(warnings[4] == "there is a doubt");
  for (std::size_t i = 5; i < warnings.size(); ++i) CHECK(warnings[i].starts_with(report.limits[i - 5].name + " is "));
  CHECK(to_json(plan, report)["numerics_choice"]["target_error"] == 0.01);
}

TEST_CASE("slip correction is warned of with attraction, not with repulsion alone") {
  const auto warned = [&](const std::string& interactions) {
    return warns("four-cells-shear.json", {"/numerics/slip_correction=true", "/interactions=" + interactions},
                 "numerics.slip_correction with attracting cells");
  };
  const std::string repulsion = R"({"between": ["rbc", "rbc"], "model": "repulsion",
                                    "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}})";
  const std::string morse = R"({"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": "1e-8 J/m2"}})";
  CHECK_FALSE(warned("[" + repulsion + "]"));
  CHECK(warned("[" + repulsion + ", " + morse + "]"));
}

TEST_CASE("several cells in three dimensions want the slip correction") {
  const auto warned = [&](const std::string& name, const std::string& change) {
    return warns(name, {change}, "numerics.slip_correction is false");
  };
  CHECK_FALSE(warned("doublet-3d.json", "/title=as it is"));
  CHECK(warned("doublet-3d.json", "/numerics/slip_correction=false"));
  CHECK_FALSE(warned("red-cell-3d.json", "/numerics/slip_correction=false"));  // nobody is there to pass
  CHECK_FALSE(warned("four-cells-shear.json", "/numerics/slip_correction=false"));
}

TEST_CASE("strain of an oscillating stage is the integral of the shear rate's magnitude") {
  const double base = GENERATE(0.0, 0.3, -0.3, 1.7, -1.7), amplitude = GENERATE(1.0, -1.0);
  scene::StageSetting setting{};
  setting.shear_rate = base;
  setting.oscillating_rate = amplitude;
  setting.oscillation.frequency = 1.0 / 1000;
  double sum = 0;
  for (long step = 0; step <= 2600; ++step) {
    if (step % 100 == 0) {
      CAPTURE(step);
      CHECK(setting.strain_after(step) == Approx(sum).epsilon(1e-5).margin(1e-2));
    }
    sum += std::abs(base + amplitude * std::sin(2 * std::numbers::pi * (static_cast<double>(step) + 0.5) / 1000));
  }
}

TEST_CASE("the viscosity ratio of a plan is the one furthest from 1") {
  const auto ratio = [](const std::string& inside) {
    const scene::Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json",
                                          {"/cell_types/rbc/interior_viscosity=\"" + inside + " cP\""});
    return make_report(make_plan(scene, plugins_of_reports())).dimensionless.at("viscosity_ratio");
  };
  CHECK(ratio("0.024") == Approx(0.02));
  CHECK(ratio("0.6") == Approx(0.5));
  CHECK(ratio("60") == Approx(50));
}

TEST_CASE("a gap below the distance at which cells come to rest counts no contact, and is warned of") {
  const std::string begin = "morse between rbc and rbc: cells come to rest";
  CHECK(warns("doublet-3d.json", {"/output/aggregate_gap=\"0.2 um\""}, begin));
  CHECK(warns("four-cells-shear.json", {"/output/aggregate_gap=\"0.4 um\""}, begin));
  CHECK_FALSE(warns("four-cells-shear.json", {"/output/aggregate_gap=\"0.5 um\""}, begin));
  CHECK_FALSE(warns("four-cells-shear.json", {"/output/aggregate_gap=\"0.4 um\"", "/cells/0/row/count=1"}, begin));
}

TEST_CASE("a plan says what walls and images add, and that a run takes hours") {
  const auto report = [](const std::vector<std::string>& changes) {
    const scene::Scene scene =
        read_scene(std::string(ROULEAU_SCENES) + "/../tests/physics/scenes/plain-capsule-3d.json", changes);
    return make_report(make_plan(scene, plugins_of_reports()));
  };
  const PlanReport shipped = report({});
  REQUIRE(shipped.box_share);
  // Measured: +1.2 % of D at 8 radii, +0.6 % at 10 (docs/three-dimensions.md).
  CHECK(shipped.box_share->deformation == Approx(0.012 * std::pow(8 / shipped.box_share->radii, 3)));
  const auto small = report({R"(/domain/size=["12 um", "12 um", "12 um"])", "/domain/nodes=[32, 32, 32]",
                             R"(/cells/0/at=["6 um", "6 um", "6 um"])"})
                         .box_share;
  REQUIRE(small);
  CHECK(small->at_least);
  CHECK(small->deformation == Approx(0.012 * std::pow(8.0 / 6, 3)));
  const std::string rest = R"(/stages=[{"name": "rest", "duration": "1 ms"}])";
  CHECK_FALSE(report({rest, "/output={}"}).box_share);
  const auto hours = [](const PlanReport& of) {
    return std::any_of(of.warnings.begin(), of.warnings.end(),
                       [](const std::string& warning) { return warning.starts_with("the run takes about"); });
  };
  CHECK_FALSE(hours(shipped));
  CHECK(hours(report({"/stages/0/strain=1e5"})));
}

namespace {

/// Seconds of a step in each node of its membranes, without outputs, of the crowded scene with these changes.
/// A cutoff of 0: without a potential.
double cost_of_crowd(double hematocrit, int cutoff_nm, const std::vector<std::string>& changes = {}) {
  const std::string morse = R"({"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": "2e-7 J/m2",
    "zero_force_distance": "0.8 um", "cutoff": ")" +
                            std::to_string(cutoff_nm) + R"( nm"}})";
  std::vector<std::string> all = {"/cells/0/random/hematocrit=" + std::to_string(hematocrit),
                                  "/interactions=[" + (cutoff_nm > 0 ? morse : "") + "]"};
  all.insert(all.end(), changes.begin(), changes.end());
  const scene::Scene scene = read_unpacked_scene(std::string(ROULEAU_SCENES) + "/suspension-3d.json", all).scene;
  const Plan plan = make_plan(scene, plugins_of_reports());
  const double nodes = membrane_nodes(scene);
  return step_cost(scene::fluid_nodes(scene.domain), nodes, scene.numerics.precision, 3, membrane_scheme(plan)) / nodes;
}
/// What a potential of 2.2 um adds.
double cost_of_potential(double hematocrit, const std::vector<std::string>& changes = {}) {
  return cost_of_crowd(hematocrit, 2200, changes) - cost_of_crowd(hematocrit, 0, changes);
}

}  // namespace

TEST_CASE("what a potential costs goes by the surfaces that are near a node") {
  // Cells in the free volume: h/(1 - h) of them, less the one whose node it is.
  const double dense = cost_of_potential(0.25), sparse = cost_of_potential(0.12);
  CHECK(dense / sparse == Approx(0.25 / 0.75 / (0.12 / 0.88)).epsilon(0.15));
  // Measured at 25 % (docs/results/plan-constants.md): contacts took as long as all the rest of a step, to a third.
  const double besides = cost_of_crowd(0.25, 0);
  CHECK(dense > 0.67 * besides);
  CHECK(dense < 1.5 * besides);
  // A wider reach has more triangles as well as more surfaces.
  CHECK(cost_of_crowd(0.25, 3000) - cost_of_crowd(0.25, 0) > 1.5 * cost_of_potential(0.25));
}

TEST_CASE("lists of contacts cost by how far cells travel in a step") {
  const auto at_rate = [](const std::string& rate) {
    return cost_of_potential(0.25, {"/stages/0/shear_rate=" + rate + " 1/s"});
  };
  const double slowest = at_rate("1"), slow = at_rate("50"), fast = at_rate("100"), faster = at_rate("150");
  CHECK(faster - fast == Approx(fast - slow).epsilon(1e-6));
  CHECK(slow > slowest);
  CHECK(at_rate("2") == Approx(slowest));  // lists become old even where nothing moves
}

TEST_CASE("nodes of the lattice that feel a membrane cost more, in double precision above all") {
  // In a crowd most nodes feel one already: twice as many cells have about half as many of them each.
  const std::string f64 = R"(/numerics/precision="f64")";
  const auto added_by_precision = [&](double hematocrit) {
    return cost_of_crowd(hematocrit, 0, {f64}) - cost_of_crowd(hematocrit, 0);
  };
  const double of_few = added_by_precision(0.1), of_many = added_by_precision(0.2);
  CHECK(of_few > 1.4 * of_many);
  CHECK(of_few < 2.1 * of_many);
  CHECK(of_many > 0.1 * cost_of_crowd(0.2, 0));
  // Outputs cost as often as there are any.
  const auto whole = [](const std::string& strain) {
    const scene::Scene scene = read_unpacked_scene(std::string(ROULEAU_SCENES) + "/suspension-3d.json",
                                                   {R"(/output/cells={"strain": )" + strain + "}"})
                                   .scene;
    const Estimate of = estimate(make_plan(scene, plugins_of_reports()));
    return std::pair{of.wall_s, of.output.outputs};
  };
  const auto [seldom_s, seldom] = whole("0.5");
  const auto [often_s, often] = whole("0.05");
  const auto [more_s, more] = whole("0.02");
  CHECK((often_s - seldom_s) / (often - seldom) == Approx((more_s - often_s) / (more - often)).epsilon(1e-6));
  CHECK(often_s > seldom_s);
}
