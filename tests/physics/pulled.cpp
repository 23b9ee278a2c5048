// Cells that sink, and cells that forces pull at, against exact solutions of Stokes flow and the ledger of energy.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "scene_run.hpp"

// Names of its own, for files that are compiled together.
namespace rouleau::test::pulled {

constexpr double pi = std::numbers::pi, mu = 1.2e-3, weight = 1000 * 9.81;  // N/m3

/// Of a sphere that a force drags through a simple cubic array of its like, in a fluid that is at rest on average:
/// Hasimoto, J. Fluid Mech. 5 (1959) 317, to the order of Sangani and Acrivos, Int. J. Multiphase Flow 8 (1982) 343,
/// which has Zick and Homsy's 2.810 at a share of 0.064. A capsule that has come to its shape moves as a rigid body:
/// its membrane cannot turn in a flow that is symmetric about the axis.
inline double array_speed(double force, double radius, double side) {
  const double c = 4 * pi / 3 * std::pow(radius / side, 3);
  const double slower =
      1 - 1.7601 * std::cbrt(c) + c - 1.5593 * c * c + 3.9799 * std::pow(c, 8.0 / 3) - 3.0734 * std::pow(c, 10.0 / 3);
  return force / (6 * pi * mu * radius) * slower;
}

/// Over the second half of a run.
inline double speed(const SceneRun& run, const std::string& column, int cell = 0) {
  const std::vector<double> place = run.column(column, cell), time = run.column("time_s", cell);
  const std::size_t from = place.size() / 2;
  return (place.back() - place[from]) / (time.back() - time[from]);
}

constexpr double side = 12e-6, radius = 2.9777e-6;
inline std::vector<std::string> cube(int nodes, std::vector<std::string> more = {}) {
  const std::string n = std::to_string(nodes);
  more.push_back("/domain/nodes=[" + n + "," + n + "," + n + "]");
  more.emplace_back("/stages/0/duration=\"0.3 s\"");
  more.emplace_back("/output/cells/seconds=\"0.05 s\"");
  more.emplace_back("/numerics/density_factor=1000");
  return more;
}
inline double bound(int nodes) { return 0.9 / std::pow(radius / side * nodes, 2); }

TEST_CASE("a stiff sphere sinks in a periodic cube as in Hasimoto's array, to second order", "[space][forces]") {
  const double exact = array_speed(weight * 4 * pi / 3 * std::pow(radius, 3), radius, side);
  for (const int nodes : {16, 24}) {
    const SceneRun run = run_scene(scenes + "/sinking-3d.json", cube(nodes));
    const double u = speed(run, "x_m");
    const double put_in = run.series_column("external_power_W_per_m").back();
    const double work = weight * run.column("volume_m3").back() * u / side;
    const double lost =
        run.series_column("viscous_dissipation_W_per_m").back() - run.series_column("body_force_power_W_per_m").back();
    std::cout << "sinking sphere, " << nodes << " nodes: speed off by " << u / exact - 1 << " (bound " << bound(nodes)
              << "), power over weight times speed off by " << put_in / work - 1 << ", dissipation over power by "
              << lost / put_in - 1 << "\n";
    CHECK(std::abs(u / exact - 1) < bound(nodes));
    CHECK(put_in == Approx(work).epsilon(2e-3));
    CHECK(lost == Approx(put_in).epsilon(1e-3));
    CHECK(run.summary["conservation"]["momentum_residual"].get<double>() < 1e-12);
  }
}

TEST_CASE("of a pair that sinks one behind the other, as far apart as from its images, both are spheres of the array",
          "[space][forces]") {
  const SceneRun run = run_scene(
      scenes + "/sinking-3d.json",
      {"/domain/size=[\"24 um\",\"12 um\",\"12 um\"]", "/domain/nodes=[48,24,24]", "/numerics/density_factor=1000",
       "/stages/0/duration=\"0.2 s\"", "/output/cells/seconds=\"0.05 s\"",
       R"(/cells=[{"type":"sphere","at":["6 um","6 um","6 um"]},{"type":"sphere","at":["18 um","6 um","6 um"]}])"});
  const double exact = array_speed(weight * 4 * pi / 3 * std::pow(radius, 3), radius, side);
  const double first = speed(run, "x_m", 0), second = speed(run, "x_m", 1);
  std::cout << "sinking pair: " << first / exact - 1 << " and " << second / exact - 1 << "\n";
  CHECK(std::abs(first / exact - 1) < bound(24));
  CHECK(second == Approx(first).epsilon(1e-6));
}

TEST_CASE("a force on all of a sphere, held by one on the fluid, drags it as its weight does", "[space][forces]") {
  const SceneRun run = run_scene(scenes + "/sinking-3d.json",
                                 cube(24, {"/fluid/gravity=[\"0 m/s2\",\"0 m/s2\",\"0 m/s2\"]",
                                           "/fluid/body_force=[\"-578.703703703703704 N/m3\",\"0 N/m3\",\"0 N/m3\"]",
                                           R"(/stages/0/forces=[{"cells":[0],"force":["1 pN","0 pN","0 pN"]}])"}));
  const double error = speed(run, "x_m") / array_speed(1e-12, radius, side) - 1;
  std::cout << "dragged sphere: speed off by " << error << "\n";
  CHECK(std::abs(error) < bound(24));
}

TEST_CASE("a stiff cylinder sinks in a periodic square as in the array of Sangani and Acrivos", "[forces]") {
  // Int. J. Multiphase Flow 8 (1982) 193: at a share of 0.1 the series is good to 0.1 %. Of second order: 0.6 % were
  // measured at 11 spacings.
  constexpr double r = 2.8546e-6, box = 16e-6, c = pi * r * r / (box * box);
  const double drag = 4 * pi / (-std::log(c) / 2 - 0.738 + c - 0.887 * c * c + 2.038 * c * c * c);
  const double exact = weight * pi * r * r / (mu * drag);
  const SceneRun run = run_scene(scenes + "/sinking.json");
  const double error = -speed(run, "y_m") / exact - 1;
  std::cout << "sinking cylinder: speed off by " << error << "\n";
  CHECK(std::abs(error) < 0.01);
}

TEST_CASE("what a pull at both ends of a cell puts in is stored or lost, and it grows longer and narrower",
          "[forces][energy]") {
  const std::string ends = R"([{"patch":{"toward":[1,0],"share":0.1},"force":["2e-6 N/m","0 N/m"],"ramp":"5 ms"},)"
                           R"({"patch":{"toward":[-1,0],"share":0.1},"force":["-2e-6 N/m","0 N/m"],"ramp":"5 ms"}])";
  const SceneRun run =
      run_scene(scenes + "/sinking.json",
                {"/fluid/gravity=[\"0 m/s2\",\"0 m/s2\"]", "/numerics/slip_correction=false",
                 "/numerics/area_correction=false", "/numerics/density_factor=20", "/stages/0/duration=\"10 ms\"",
                 "/output/cells/seconds=\"0.05 ms\"", "/stages/0/forces=" + ends});
  const auto time = run.series_column("time_s"), total = run.series_column("total_energy_J_per_m"),
             lost = run.series_column("viscous_dissipation_W_per_m"),
             put_in = run.series_column("external_power_W_per_m");
  double work = 0, heat = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    work += (put_in[i] + put_in[i - 1]) / 2 * (time[i] - time[i - 1]);
    heat += (lost[i] + lost[i - 1]) / 2 * (time[i] - time[i - 1]);
  }
  const auto length = run.column("length_along_force_m"), width = run.column("width_across_force_m");
  std::cout << "pulled ring: work " << work << " J/m, stored " << total.back() - total.front() << ", lost " << heat
            << ", rest " << (work - heat - total.back() + total.front()) / work << " of the work; length "
            << length.back() / length.front() << ", width " << width.back() / width.front() << "\n";
  CHECK(work - heat == Approx(total.back() - total.front()).margin(0.01 * work));
  CHECK(length.front() == Approx(2 * 2.8546e-6).epsilon(1e-3));
  CHECK(length.back() > 1.05 * length.front());
  CHECK(width.back() < 0.97 * width.front());
  CHECK(run.column("x_m").back() == Approx(8e-6).epsilon(1e-9));
  CHECK(run.summary["conservation"]["momentum_residual"].get<double>() < 1e-12);
}

TEST_CASE("a patch has the share of the perimeter that is asked for, and its ramp begins where the stage before ends",
          "[forces]") {
  const std::string pull = R"({"patch":{"toward":[0,1],"share":0.1},"force":["3e-6 N/m","0 N/m"],"ramp":"1 ms"})";
  const Scene scene =
      plan::read_scene(scenes + "/sinking.json",
                       {R"(/stages=[{"name":"a","duration":"2 ms","forces":[)" + pull +
                        R"(]},{"name":"b","duration":"2 ms","forces":[)" +
                        R"({"patch":{"toward":[0,1],"share":0.1},"force":["1e-6 N/m","0 N/m"],"ramp":"1 ms"}]}])"});
  const Catalog catalog({ROULEAU_PLUGINS});
  const Plan plan = make_plan(scene, catalog);
  const auto setup = make_solver_setup<2>(plan, 1);
  const auto& made = setup.external.pulls.at(0);
  const core::ForcePatch& patch = *made.patch.at(0);
  double sum = 0, sideways = 0;
  const auto rest = without_cells<2>(scene, lattice_spacing(scene)).types[0];
  for (std::size_t i = 0; i < patch.node.size(); ++i)
    sum += patch.share[i], sideways += patch.share[i] * rest->x[patch.node[i]];
  CHECK(sum == Approx(1).epsilon(1e-12));
  CHECK(std::abs(sideways) < 1e-9);  // as symmetric as the cell
  // 72 segments: 7.2 of them, so seven nodes whole and two in part.
  CHECK(patch.node.size() == 9);
  CHECK(made.before.x() == Approx(3 * made.after.x()).epsilon(1e-12));
  CHECK(made.ramp_steps == Approx(1e-3 / plan.stages[1].units.time));
  const double unit = plan.stages[1].units.unit(units::dimension::tension);
  CHECK(made.after.x() * unit == Approx(1e-6).epsilon(1e-12));
}

}  // namespace rouleau::test::pulled
