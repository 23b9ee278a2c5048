// The limits that a plan compares a scene with.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "plan/limit_list.hpp"
#include "plan/limits.hpp"
#include "plan/plan.hpp"
#include "plan/read_scene.hpp"

using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::scene;

TEST_CASE("each stiffness is that of the cell type which is nearest to its limit") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto margin = [&](const std::vector<std::string>& overrides, const std::string& begin) {
    const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", overrides);
    double least = 1e300;
    for (const Limit& limit : find_limits(make_plan(scene, catalog))) {
      if (limit.name.starts_with(begin)) least = std::min(least, limit.margin);
    }
    return least;
  };
  // One type whose bending is beyond its limit, another whose stretching is further beyond.
  const std::vector<std::string> bends{R"(/cell_types/rbc/membrane/1/parameters/modulus="3.6e-17 J")"};
  std::vector<std::string> both = bends;
  both.emplace_back(R"(/cell_types/taut={"shape": {"circle": {"radius": "3 um"}}, "segments": 96, "membrane": [)"
                    R"({"model": "hooke", "parameters": {"stretching_modulus": "1 N/m"}}]})");
  CHECK(margin(bends, "bending stiffness") < 1);
  CHECK(margin(both, "bending stiffness") == margin(bends, "bending stiffness"));
  CHECK(margin(both, "stretching stiffness") < margin(bends, "stretching stiffness") / 100);
}

TEST_CASE("limits know the relaxation times of layers, and a driven channel its layers") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const std::string two = R"(/fluid/layers=[{"from": "0 um", "to": "9.8 um", "viscosity": "0.006 cP"},
                                            {"from": "9.8 um", "to": "15.68 um", "viscosity": "60 cP"}])";
  const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", {two});
  const auto plan = make_plan(scene, catalog);
  const auto value = [&](const std::string& name) {
    for (const Limit& limit : find_limits(plan)) {
      if (limit.name == name) return std::pair(limit.value, limit.margin);
    }
    return std::pair(0.0, 0.0);
  };
  CHECK(value("tau - 1/2 in the layer of least viscosity").first == Approx(0.0025));
  CHECK(value("tau - 1/2 in the layer of least viscosity").second == Approx(0.5));
  CHECK(value("tau - 1/2 in the layer of largest viscosity").first == Approx(25));
  CHECK(value("tau - 1/2 in the layer of largest viscosity").second == Approx(2));
  CHECK(plan.viscosity_contrast);
  // Where the cells are is not known to the limits: the lowest of all layers counts.
  const Scene plain = read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json");
  CHECK(explicit_margin(plan.facts) < explicit_margin(make_plan(plain, catalog).facts));
}

TEST_CASE("a plan in three dimensions says what leaks: of a strain of 1 where it is put back, else of all of the stage",
          "[optimised]") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto leak = [&](const std::string& begin, std::vector<std::string> overrides) {
    overrides.emplace_back("/numerics/density_factor=10");
    const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/suspension-3d.json", overrides);
    for (const Limit& limit : find_limits(make_plan(scene, catalog))) {
      if (limit.name.starts_with(begin)) return std::pair(limit.value, limit.limit);
    }
    return std::pair(-1.0, -1.0);
  };
  const std::string kept = "volume kept in a cell", leaks = "volume that a cell is expected to leak";
  const std::string open = "/numerics/area_correction=false", finer = "/checks/area_drift=0.001";
  CHECK(leak(kept, {finer}).second == 0.001);
  CHECK(leak(leaks, {}).first == -1);
  CHECK(leak(leaks, {open}).first == Approx(3 * leak(kept, {}).first));
  CHECK(leak(leaks, {open, "/stages/0/strain=30"}).first == Approx(30 * leak(kept, {}).first));
  CHECK(leak(kept, {R"(/stages/0={"name": "rest", "duration": "1 ms"})", "/output={}"}).first == -1);
}

TEST_CASE("attraction has a limit by compression, and one where nothing keeps a cell's own faces apart") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto limits_of = [&](std::vector<std::string> overrides) {
    overrides.emplace_back(R"(/stages=[{"name": "rest", "duration": "1 s"}])");
    overrides.emplace_back("/numerics/density_factor=6000");
    overrides.emplace_back(R"(/interactions/0/parameters/depth="3e-6 J/m2")");
    overrides.emplace_back("/output={}");
    return find_limits(
        make_plan(read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", overrides), catalog));
  };
  const auto find = [](const std::vector<Limit>& limits, const std::string& begin) {
    return std::find_if(limits.begin(), limits.end(), [&](const Limit& l) { return l.name.starts_with(begin); });
  };
  const std::vector<Limit> bare = limits_of({});
  // Morse attracts at most by depth decay/2; a lattice unit of pressure is density_factor rho (dx/dt)^2.
  const double spacing = 0.196e-6, density = 6000 * 1000, step = spacing * spacing * density / 6 / 1.2e-3;
  const auto compression = find(bare, "compression by the attraction of morse");
  REQUIRE(compression != bare.end());
  CHECK(compression->value ==
        Approx(3 * 3e-6 * 3.84e6 / 2 * step * step / (density * spacing * spacing)).epsilon(1e-4));
  CHECK(compression->remedied_by == RemediedBy::density_factor);
  const auto depth = find(bare, "depth of morse");
  REQUIRE(depth != bare.end());
  CHECK(depth->value == Approx(3e-6 * 3.91e-6 * 3.91e-6 / 3.6e-19).epsilon(1e-3));
  CHECK(depth->margin < 1);
  CHECK(depth->remedy.find(R"(["rbc", "self"])") != std::string::npos);

  const std::vector<Limit> apart = limits_of({R"(/interactions/-={"between": ["self", "rbc"], "model": "repulsion",
      "parameters": {"strength": "1e-5 J/m2", "cutoff": "0.8 um"}})"});
  CHECK(find(apart, "depth of morse") == apart.end());
  CHECK(find(apart, "contact stiffness of repulsion") != apart.end());
}

TEST_CASE("with kernels that let nodes zigzag the semi-implicit step bears less, and \"auto\" does not take it") {
  // limits/kernels.json: stable up to 9.2e-6 N/m with the explicit step, 5.2e-6 with the semi-implicit one.
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto limits = [&](const std::string& kernel, const std::string& coupling) {
    const Scene scene =
        read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json",
                   {"/numerics/density_factor=3000", "/numerics/kernel=" + kernel, "/numerics/coupling=" + coupling});
    const Plan plan = make_plan(scene, catalog);
    const std::vector<Limit> all = find_limits(plan);
    const auto found = std::find_if(all.begin(), all.end(),
                                    [](const Limit& limit) { return limit.name.starts_with("stretching stiffness"); });
    REQUIRE(found != all.end());
    return std::pair{*found, plan.semi_implicit};
  };
  const auto [peskin, taken] = limits("peskin4", "auto");
  CHECK(taken);
  CHECK(peskin.margin > 1);
  const auto [automatic, sharp_taken] = limits("roma3", "auto");
  CHECK_FALSE(sharp_taken);
  CHECK(automatic.margin < 1);
  CHECK_THAT(automatic.remedy, Catch::Matchers::Contains("peskin4"));
  CHECK(limits("roma3", "semi-implicit").first.limit == Approx(automatic.limit / 2));
}

TEST_CASE("the sharp kernel bears less stiffness, and with the semi-implicit step as much more from tau 0.9 on") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto limit = [&](const std::string& kernel, const std::string& tau, const std::string& coupling,
                         const std::vector<std::string>& further = {}) {
    std::vector<std::string> changes{"/numerics/kernel=" + kernel, "/numerics/tau=" + tau,
                                     "/numerics/coupling=" + coupling};
    changes.insert(changes.end(), further.begin(), further.end());
    const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json", changes);
    const std::vector<Limit> all = find_limits(make_plan(scene, catalog));
    return std::find_if(all.begin(), all.end(),
                        [](const Limit& each) { return each.name.starts_with("stretching stiffness"); })
        ->limit;
  };
  for (const char* tau : {"0.8", "1", "2"}) {
    const double explicit_limit = limit("sharp6", tau, "explicit");
    CHECK(explicit_limit == Approx(0.36 * limit("peskin4", tau, "explicit")));
    const double gain = limit("sharp6", tau, "semi-implicit") / explicit_limit;
    CHECK(gain == Approx(std::string(tau) == "0.8" ? 1 : 20));
  }
  // As much with the slip correction, but not where the cell is more viscous and tau is large (docs/stability.md, "With
  // sharp6").
  const std::string corrected = "/numerics/slip_correction=true",
                    alike = "/cell_types/rbc/interior_viscosity=\"1.2 cP\"";
  const auto gain = [&](const std::string& kernel, const std::string& tau, const std::vector<std::string>& changes) {
    return limit(kernel, tau, "semi-implicit", changes) / limit(kernel, tau, "explicit", changes);
  };
  CHECK(gain("sharp6", "3", {corrected}) == Approx(20));
  CHECK(gain("sharp6", "3.5", {corrected}) == Approx(4));
  CHECK(gain("sharp6", "3.5", {corrected, alike}) == Approx(20));
  CHECK(gain("peskin4", "3.5", {corrected}) == Approx(20));
}

TEST_CASE("plan knows how far membranes turn while a semi-implicit step holds their forces") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto held = [&](const std::vector<std::string>& further) -> std::optional<double> {
    // Without bending, and at tau 1, where the viscosity of the lattice is 1/6.
    std::vector<std::string> changes{
        "/numerics/coupling=semi-implicit",
        R"(/cell_types/rbc/membrane=[{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-4 N/m"}}])"};
    changes.insert(changes.end(), further.begin(), further.end());
    const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json", changes);
    for (const Limit& limit : find_limits(make_plan(scene, catalog))) {
      if (limit.name.starts_with("strain during which")) return limit.value;
    }
    return std::nullopt;
  };
  CHECK_FALSE(held({"/numerics/coupling=explicit"}));
  // A time step of spacing^2/6 over the viscosity of a fluid 600 times as dense as water; lattice units of stiffness
  // follow.
  const double spacing = 20e-6 / 60, density = 600 * 1000, step = spacing * spacing / 6 / (1.2e-3 / density);
  const double unit = density * spacing * spacing * spacing / (step * step);
  // The stiffness is the largest at stretches from 0.95 to 1.1 along one direction, T = G (s - 1/s^3): G (1 + 3/s^4).
  const double stiffness = 1e-4 / unit * (1 + 3 / std::pow(0.95, 4));
  const double steps = 1 + 8 * 0.67 / 2 * stiffness;
  const std::optional<double> found = held({});
  REQUIRE(found);
  CHECK(*found == Approx(steps * 100 * step).epsilon(0.03));
  // The sharp kernel's waves pull more, and couples beside a membrane that touches the lattice inside more again.
  const std::optional<double> sharp = held({"/numerics/kernel=sharp6"});
  REQUIRE(sharp);
  CHECK((*sharp / (100 * step) - 1) / (*found / (100 * step) - 1) == Approx(1.43 / 0.67).epsilon(0.01));
  CHECK(held({"/numerics/kernel=sharp6", "/numerics/slip_correction=true"}) > 1.3 * *sharp);
}

TEST_CASE("plan knows by how many steps the stress of viscous membranes lags") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto error = [&](const std::string& law, const std::string& density) -> std::optional<double> {
    const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json",
                                   {"/cell_types/rbc/membrane=[" + law + "]", "/numerics/density_factor=" + density});
    for (const Limit& limit : find_limits(make_plan(scene, catalog)))
      if (limit.name.starts_with("relative error of the stress of viscous membranes")) return limit.value;
    return std::nullopt;
  };
  const std::string elastic = R"({"model": "neo-hookean", "parameters": {"shear_modulus": "4e-6 N/m"}})";
  const std::string viscous =
      elastic + R"(, {"model": "viscous", "parameters": {"viscosity": "2e-7 N s/m", "area_viscosity": "3e-7 N s/m"}})";
  CHECK_FALSE(error(elastic, "600"));
  // The spring before the dashpot has half a lattice unit at tau 1: a lag of twice the viscosity in lattice units, which
  // is that over the fluid's and the spacing, times 1/6.
  const double spacing = 20e-6 / 60, steps = 2 * 5e-7 / (1.2e-3 * spacing) / 6;
  const double step = spacing * spacing / 6 / (1.2e-3 / 600e3);
  const std::optional<double> found = error(viscous, "600");
  REQUIRE(found);
  CHECK(*found == Approx(std::pow(100 * step * steps, 2)).epsilon(1e-9));
  CHECK(*error(viscous, "300") == Approx(*found / 4).epsilon(1e-9));
}

TEST_CASE("plan knows over what length the slip of stiff membranes is smoothed, where cells turn over") {
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto smoothing = [&](double stiffness, const std::vector<std::string>& further) -> std::optional<double> {
    std::vector<std::string> changes{
        "/domain/nodes=[112, 56]", "/cell_types/rbc/segments=43",
        R"(/numerics={"tau": 1, "density_factor": 2000, "slip_correction": true, "coupling": "auto"})",
        "/cell_types/rbc/membrane/0/parameters/shear_modulus=\"" + std::to_string(6e-6 * stiffness) + " N/m\""};
    changes.insert(changes.end(), further.begin(), further.end());
    const Scene scene = read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/auto-biconcave.json", changes);
    for (const Limit& limit : find_limits(make_plan(scene, catalog))) {
      if (limit.name.starts_with("smoothing of the slip")) return limit.value;
    }
    return std::nullopt;
  };
  // Radius 8.75 spacings, segments of 1: solver runs took 4, 20 and 80 passes for 1, 5 and 20 times a red cell's
  // stiffness.
  constexpr double pass = 1.0 / 2 / (8.75 * 8.75);
  CHECK(smoothing(1, {}).value() == Approx(4 * pass).epsilon(0.05));
  CHECK(smoothing(5, {}).value() == Approx(20 * pass).epsilon(0.05));
  CHECK(smoothing(20, {}).value() == Approx(80 * pass).epsilon(0.05));
  CHECK(smoothing(20, {"/numerics/density_factor=500"}).value() == Approx(20 * pass).epsilon(0.05));
  CHECK_FALSE(smoothing(20, {"/numerics/slip_correction=false"}));
  CHECK_FALSE(smoothing(20, {R"(/cell_types/rbc/shape={"circle": {"radius": "3.91 um"}})"}));
}

namespace {

std::optional<Limit> limit_named(const std::string& scene_name, const std::vector<std::string>& changes,
                                 const std::string& begin) {
  static const Catalog catalog({ROULEAU_PLUGINS});
  const Scene scene = read_scene(std::string(ROULEAU_SCENES) + "/" + scene_name, changes);
  for (const Limit& limit : find_limits(make_plan(scene, catalog)))
    if (limit.name.starts_with(begin)) return limit;
  return {};
}
const std::string between_cells = "gap between cells, as placed, in",
                  to_a_wall = "gap between cells, as placed, and a wall";

}  // namespace

TEST_CASE("cells that are placed nearer than a spacing to each other or to a wall are warned of, in both dimensions") {
  struct Case {
    std::string scene, shape, place, second;
    double spacing, height;
  };
  const std::vector<Case> cases{{"four-cells-shear.json", R"({"circle": {"radius": "3 um"}})", R"(["20 um", "12 um"])",
                                 R"(["26.02 um", "12 um"])", 0.196, 25.088},
                                {"red-cell-3d.json", R"({"sphere": {"radius": "3 um"}})", R"(["6 um", "8 um", "8 um"])",
                                 R"(["12.02 um", "8 um", "8 um"])", 1.0 / 3, 20}};
  for (const Case& c : cases) {
    INFO(c.scene);
    const auto find = [&](const std::string& cells, const std::string& begin) {
      return limit_named(c.scene, {"/cell_types/rbc/shape=" + c.shape, "/cells=[" + cells + "]", "/interactions=[]"},
                         begin);
    };
    const auto cell = [](const std::string& place) { return R"({"type": "rbc", "at": )" + place + "}"; };
    const auto close = find(cell(c.place) + ", " + cell(c.second), between_cells);
    REQUIRE(close);
    // Nodes lie on the circles, so that polygons are a little further apart.
    CHECK(close->value == Approx(0.02 / c.spacing).margin(0.1));
    CHECK(close->margin < 1);
    CHECK_FALSE(find(cell(c.place), between_cells));
    CHECK_FALSE(find(cell(c.place), to_a_wall));
    std::string low = c.place;
    low.replace(low.find(c.scene == "red-cell-3d.json" ? "\"8 um\"" : "12 um\""), c.scene == "red-cell-3d.json" ? 6 : 6,
                c.scene == "red-cell-3d.json" ? "\"3.1 um\"" : "3.06 um\"");
    const auto wall = find(cell(low), to_a_wall);
    REQUIRE(wall);
    CHECK(wall->value == Approx((c.scene == "red-cell-3d.json" ? 0.1 : 0.06) / c.spacing).margin(0.05));
    CHECK(wall->margin < 1);
    CHECK(wall->remedied_by == RemediedBy::nothing);  // no lattice is made finer for it
  }
}

TEST_CASE("cells at random keep the gap that was asked for, and are as near as that") {
  const std::string random = R"(/cells=[{"type": "rbc", "random": {"count": 2, "seed": 1, "gap": "0.1 um"}}])";
  const auto gap = limit_named("red-cell-3d.json", {random}, between_cells);
  REQUIRE(gap);
  CHECK(gap->value == Approx(0.3));
}

TEST_CASE("wells deeper than were tried are told in three dimensions, too") {
  const auto depth = [](const std::vector<std::string>& changes) {
    return limit_named("doublet-3d.json", changes, "depth of morse");
  };
  const auto deep = depth({"/interactions/0/parameters/depth=\"1e-5 J/m2\""});
  REQUIRE(deep);
  CHECK(deep->value == Approx(1e-5 * 3.91e-6 * 3.91e-6 / 3.6e-19).epsilon(0.06));  // its cutoff takes some
  CHECK(deep->margin < 1);
  CHECK(depth({})->margin > 1);  // whose faces stay apart
  CHECK_FALSE(depth({"/interactions/0/parameters/depth=\"1e-5 J/m2\"",
                     R"(/interactions/-={"between": ["rbc", "self"], "model": "repulsion",
                         "parameters": {"strength": "3e-5 J/m2", "cutoff": "0.8 um"}})"}));
}

TEST_CASE("a fluid alone is judged by its own start") {
  const std::string alone = "/cells=[]", none = "/interactions=[]", factor = "/numerics/density_factor=1",
                    output = "/output={}";
  const auto flow = [](const std::string& duration) {
    return R"(/stages=[{"name": "flow", "duration": ")" + duration + R"(", "pressure_gradient": "1e5 Pa/m"}])";
  };
  const std::string left = "what the start of the flow leaves in the relative viscosity";
  // H^2/(pi^2 nu) is 53 us.
  const auto early = limit_named("four-cells-shear.json", {alone, none, factor, output, flow("60 us")}, left);
  REQUIRE(early);
  CHECK(early->margin < 1);
  CHECK_THAT(early->remedy, Catch::Matchers::Contains("more time"));
  CHECK(limit_named("four-cells-shear.json", {alone, none, factor, output, flow("2 ms")}, left)->margin > 1);
}

TEST_CASE("plan knows how thin the fluid inside cells may be on the lattice where slip is corrected") {
  // limits/viscosity-ratio-3d.json: at tau 1 and ratio 0.033 sheared cells came apart, which plan did not say; at tau 2
  // they do not.
  const Catalog catalog({ROULEAU_PLUGINS});
  const auto margin = [&](const std::vector<std::string>& changes) -> std::optional<double> {
    for (const Limit& limit :
         find_limits(make_plan(read_scene(std::string(ROULEAU_SCENES) + "/red-cell-3d.json", changes), catalog)))
      if (limit.name == "tau - 1/2 inside the cells") return limit.margin;
    return std::nullopt;
  };
  const std::string thin = "/cell_types/rbc/interior_viscosity=\"0.039 cP\"",
                    corrected = "/numerics/slip_correction=true";
  CHECK(margin({thin, corrected}).value_or(9) < 1);
  CHECK(margin({thin, "/numerics/kernel=sharp6"}).value_or(9) < 1);
  CHECK(margin({thin, corrected, "/numerics/tau=2"}) > 1);
  CHECK_FALSE(margin({thin}));       // the plain scheme bore a hundredth
  CHECK_FALSE(margin({corrected}));  // more viscous than the plasma
}

TEST_CASE("a value at its limit is not beyond it, however it was rounded") {
  LimitList limits;
  limits.above("radius", 2e-6 / (124e-6 / 620), 10, "");  // 9.999999999999998
  limits.below("Mach number", 0.1 * (1 + 1e-15), 0.1, "");
  limits.above("radius below it", 9.9999, 10, "");
  const std::vector<Limit> found = std::move(limits).sorted();
  REQUIRE(found.size() == 3);
  CHECK(found[0].name == "radius below it");
  CHECK(found[0].margin < 1);
  CHECK(found[1].margin == 1);
  CHECK(found[2].margin == 1);
}
