// What acts on walls, of fluid and membranes together; and that the viscosity by the walls is the one by the particles.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/solver/solver.hpp"
#include "observe/energy.hpp"
#include "observe/rheology.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

template <class T, class Set>
struct Bench {
  static constexpr int D = Set::dimension;
  using Cells = typename Solver<T, Set>::Cells;
  explicit Bench(const Case& c)
      : scene(plan::read_scene(c.file, c.overrides)), plan(plan::make_plan(scene, catalog())) {
    cells = plan::make_cells<D>(scene);
  }
  void start() {
    solver = std::make_unique<Solver<T, Set>>(plan::make_solver_setup<D>(plan, 0), cells);
    solver->start();
  }
  /// Of all populations, and a bound of their and the forces' rounding errors, which are alike where the flow is.
  struct Momentum {
    std::array<double, D> along{};
    double rounding = 0;
  };
  [[nodiscard]] Momentum momentum() {
    Momentum sum;
    solver->fluid().settle();
    std::vector<double> values;
    for (int q = 0; q < Set::velocity_count; ++q) {
      solver->fluid().copy_populations(q, values);
      ExactSum all;
      for (const double value : values) {
        all.add(value);
        sum.rounding += std::abs(value);
      }
      for (int k = 0; k < D; ++k) sum.along[k] += Set::velocity[q][k] * all.value();
    }
    for (int i = 0; i < cells.node_count(); ++i) {
      for (int k = 0; k < D; ++k) sum.rounding += std::abs(force(i, k));
    }
    sum.rounding *= 3 * static_cast<double>(std::numeric_limits<T>::epsilon());  // each in some operations of a step
    return sum;
  }
  [[nodiscard]] double force(int i, int axis) const {
    return (axis == 0 ? cells.force[0] : axis == 1 ? cells.force[1] : cells.force[2])[i];
  }
  [[nodiscard]] double particle_stress(bool with_images = true) {
    const auto across = [this](int c) { return solver->cell_tasks()->force_across_images(c); };
    return observe::particle_stress(cells, scene, solver->setup().viscosity(), solver->ranks(),
                                    with_images ? across : observe::ForceAcrossImages{})
        .xy;
  }

  scene::Scene scene;
  plan::Plan plan;
  Cells cells;
  std::unique_ptr<Solver<T, Set>> solver;
};

template <class T, class Set>
void check_balance(const Case& c) {
  CAPTURE(c.what, sizeof(T));
  Bench<T, Set> bench(c);
  bench.start();
  bench.solver->step(40);
  std::array<double, Set::dimension> last{};
  for (int step = 0; step < 4; ++step) {
    bench.solver->compute_forces();
    const auto before = bench.momentum();
    const auto share = bench.solver->cell_tasks()->wall_share(), now = bench.solver->wall_forces();
    const FluidSetting<Set::dimension>& setting = bench.solver->fluid().setting();
    const auto body = setting.body_force;
    const auto nodes = static_cast<double>(setting.solid ? setting.solid->fluid_count() : setting.domain.nodes());
    bench.solver->advance();
    const auto after = bench.momentum();
    const auto exchanged = bench.solver->fluid().wall_forces();
    const double rounding = after.rounding;
    double of_share = 0;
    for (int k = 0; k < Set::dimension; ++k) {
      if (step > 0) CHECK(now.all(k) == Approx(last[k] + share.all(k)).margin(1e-15));  // what is observed
      last[k] = exchanged.all(k);
      ExactSum given;
      given.add(body[k] * nodes);
      for (int i = 0; i < bench.cells.node_count(); ++i) given.add(bench.force(i, k));
      const double left = after.along[k] - before.along[k] - given.value() + exchanged.all(k) + share.all(k);
      CHECK(std::abs(left / rounding) < 1);
      of_share = std::max(of_share, std::abs(share.all(k)));
    }
    CHECK(of_share / rounding > (sizeof(T) == sizeof(double) ? 1e6 : 1));  // a balance without it would not close
  }
}

const std::string slip = "/numerics/slip_correction=true", area = "/numerics/area_correction=true",
                  sharp = "/numerics/kernel=sharp6", inertia = "/fluid/inertia=true", none = "/output={}";

/// A red cell along the lower wall, 0.8 spacings off it.
Case beside_wall(const std::string& what, std::vector<std::string> overrides) {
  for (const char* all : {R"(/domain/size=["12.544 um", "12.544 um"])", "/domain/nodes=[64, 64]",
                          R"(/cells=[{"type": "rbc", "at": ["6 um", "1.4 um"]}])", "/numerics/density_factor=500"})
    overrides.emplace_back(all);
  return {what, four_cells, overrides};
}
/// A capsule 0.5 spacings off walls that are 32 apart.
Case in_space(const std::string& what, const std::string& y, const std::string& z, const std::string& domain,
              std::vector<std::string> overrides) {
  overrides.push_back(R"(/domain={"size": ["12 um", "12 um", "12 um"], "nodes": [32, 32, 32], )" + domain + "}");
  overrides.push_back(R"(/cells=[{"type": "capsule", "at": ["6 um", ")" + y + R"( um", ")" + z + R"( um"]}])");
  return {what, ROULEAU_SCENES "/../tests/physics/scenes/plain-capsule-3d.json", overrides};
}
const std::string walls_y = R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}})",
                  walls_yz = walls_y + R"(, "z": {"lower": {"wall": {}}, "upper": {"wall": {}}})",
                  tube = R"("walls": {"tube": {"radius": "6 um"}})",
                  pushed = R"(/stages=[{"name": "driven", "pressure_gradient": "1e5 Pa/m", "duration": "1 s"}])";

}  // namespace

TEST_CASE("the momentum that the fluid gains is what membranes and a driving force give less what walls get") {
  const std::string held = R"(/interactions=[{"between": ["rbc", "wall"], "model": "morse", "parameters": {
    "depth": "1e-7 J/m2"}}])";
  const std::vector<Case> plane{beside_wall("plain", {shear, contrast}),
                                beside_wall("sharp", {shear, sharp, inertia}),
                                beside_wall("corrected", {shear, contrast, slip, area}),
                                beside_wall("held forces", {shear, semi_implicit}),
                                beside_wall("held by the wall", {shear, held}),
                                beside_wall("oscillating walls", {oscillating, none}),
                                beside_wall("driven", {driven, none})};
  for (const Case& c : plane) check_balance<double, D2Q9>(c);
  check_balance<float, D2Q9>(plane.front());
  const std::string viscous = "/cell_types/capsule/interior_viscosity=\"6 cP\"";
  const Case duct = in_space("duct", "3.2", "8.8", walls_yz, {pushed, none, slip, area, sharp, viscous});
  for (const Case& c :
       {in_space("plane walls", "3.2", "6", walls_y, {viscous}), duct,
        in_space("sheared duct", "8.8", "3.2", walls_yz, {}), in_space("tube", "8.0", "8.0", tube, {pushed, none}),
        in_space("tube, corrected", "3.2", "6", tube, {pushed, none, slip, area, sharp, semi_implicit})})
    check_balance<double, D3Q19>(c);
  check_balance<float, D3Q19>(duct);
}

namespace {

/// Means over the second half of some strain, over viscosity times shear rate, of the stresses on the walls (`fluid`:
/// without what membranes hand on to them) and of the particles' (`pairs`: what cells do to each other). And what
/// speeds the fluid up meanwhile: `gain` of its momentum, by which the two walls differ, and `rise` of the moment of
/// that about the middle, by which walls and particles do.
struct Means {
  double lower = 0, upper = 0, fluid = 0, particles = 0, pairs = 0, rise = 0, gain = 0;
};
template <class Set>
Means means_of(const Case& c, double strain) {
  Bench<double, Set> bench(c);
  bench.start();
  const scene::StageSetting& stage = bench.plan.stages.front();
  const long steps = std::lround(strain / std::abs(stage.shear_rate)), looks = 40;
  const double unit = bench.solver->setup().viscosity() * stage.shear_rate;
  bench.solver->step(steps / 2);
  Means means;
  // The fluid's momentum in a column of unit width, and its moment about the middle.
  const double height = bench.scene.domain.nodes[1];
  const auto moments = [&] {
    const std::vector<double> rows = bench.solver->fluid().row_velocities();
    std::array<double, 2> sums{};
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const double share = rows[row] / static_cast<double>(rows.size()) / unit;
      sums[0] += height * share;
      sums[1] += share * (std::fmod(static_cast<double>(row), height) - (height - 1) / 2);
    }
    return sums;
  };
  const long between = steps / 2 / looks;
  std::array<double, 2> first{};
  for (int look = 0; look < looks; ++look) {
    if (look > 0) bench.solver->step(between - 1);
    bench.solver->compute_forces();
    bench.solver->fluid().settle();
    if (look == 0) first = moments();
    const auto steps_between = static_cast<double>(between * (looks - 1));
    means.gain = (moments()[0] - first[0]) / steps_between, means.rise = (moments()[1] - first[1]) / steps_between;
    const auto all = bench.solver->wall_stress(), fluid = bench.solver->fluid().wall_stress();
    means.lower += all.lower / unit / looks, means.upper -= all.upper / unit / looks;
    means.fluid += (fluid.lower - fluid.upper) / 2 / unit / looks;
    means.particles += 1 / static_cast<double>(looks) + bench.particle_stress() / unit / looks;
    for (const CellRange& cell : bench.cells.cells) {
      double force = 0, middle = 0;
      for (int i = cell.first; i < cell.end(); ++i)
        force += bench.force(i, 0), middle += bench.cells.position[1][i] / cell.count;
      means.pairs -= force * middle / static_cast<double>(bench.solver->setup().domain.nodes()) / unit / looks;
    }
    bench.solver->advance();
  }
  return means;
}

template <class Set>
void compare_viscosities(const Case& c, double strain, bool beside, bool attract, double within = 0.003) {
  const Means means = means_of<Set>(c, strain);
  const double walls = (means.lower + means.upper) / 2;
  CAPTURE(c.what, means.lower, means.upper, means.particles, means.fluid, means.pairs, means.rise, means.gain);
  CHECK(means.lower + means.gain == Approx(means.upper).epsilon(0.003));
  CHECK(walls == Approx(means.particles + means.rise).epsilon(within));
  CHECK(walls > 1.02);
  if (beside) CHECK(means.fluid < 0.97 * walls);
  if (attract) CHECK(std::abs(means.pairs) > 0.03 * walls);
}

}  // namespace

namespace {

const std::string thick = "/numerics/tau=2";

}  // namespace

TEST_CASE("beside a wall both walls have one stress, and the viscosity by walls is that by particles") {
  // What the start leaves in the fluid dies out within 500 steps.
  const std::string shear100 =
      R"(/stages=[{"name": "shear", "shear_rate": "100 1/s", "strain": 5, "start": "developed"}])";
  const auto plane = [&](const char* what, std::vector<std::string> more) {
    Case c = beside_wall(what, std::move(more));
    for (const std::string& one :
         {shear100, std::string("/domain/nodes=[48, 48]"), thick, std::string("/numerics/density_factor=50")})
      c.overrides.push_back(one);
    return c;
  };
  compare_viscosities<D2Q9>(plane("2D", {}), 1, true, false);
  compare_viscosities<D2Q9>(plane("2D, corrected", {slip, area, sharp}), 1, false, false, 0.01);
  compare_viscosities<D3Q19>(in_space("3D", "3.1", "6", walls_y, {thick, "/numerics/density_factor=111"}), 0.7, true,
                             false);
}

TEST_CASE("beside a wall that moves what walls put in is what viscosity takes and what is stored") {
  for (const std::vector<std::string>& corrections : {std::vector<std::string>{shear}, {shear, contrast, slip, area}}) {
    Bench<double, D2Q9> bench(beside_wall("ledger", corrections));
    bench.start();
    bench.solver->step(1500);
    const auto look = [&] {
      bench.solver->compute_forces();
      bench.solver->fluid().settle();
      return observe::observe_energy(*bench.solver, bench.plan.stages[0].units);
    };
    const double half = bench.plan.stages[0].units.time / 2;
    const observe::EnergySnapshot first = look();
    observe::EnergySnapshot last = first;
    double given = 0, lost = 0;
    for (int step = 0; step < 300; ++step) {
      bench.solver->advance();
      const observe::EnergySnapshot now = look();
      given += (last.wall_power + now.wall_power) * half;
      lost += (last.viscous_dissipation + now.viscous_dissipation) * half;
      last = now;
    }
    CAPTURE(corrections.size(), given, lost, last.total - first.total);
    CHECK(std::abs(given - lost - (last.total - first.total)) < 1e-4 * given);
    const auto share = bench.solver->cell_tasks()->wall_share();
    CHECK(std::abs(share.lower[0]) > 1e-2 * std::abs(bench.solver->wall_forces().lower[0]));  // which would be missed
  }
}

TEST_CASE("in dense suspensions that attract the viscosity by walls is that by particles", "[optimised]") {
  const std::string shear20 =
      R"(/stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 5, "start": "developed"}])";
  Case plane = beside_wall("2D, attracting", {shear20, thick});
  plane.overrides.emplace_back(R"(/cells=[{"type": "rbc", "at": ["6 um", "6.2 um"], "angle": "45 deg"},
    {"type": "rbc", "at": ["3.8 um", "8.4 um"], "angle": "45 deg"},
    {"type": "rbc", "at": ["8.2 um", "4 um"], "angle": "45 deg"}])");
  plane.overrides.emplace_back("/interactions/0/parameters/depth=\"2e-7 J/m2\"");
  plane.overrides.emplace_back("/numerics/density_factor=400");
  compare_viscosities<D2Q9>(plane, 1, false, true);
  Case space = in_space("3D, attracting", "3.2", "6", walls_y,
                        {thick, "/numerics/density_factor=111", R"(/interactions=[{"between": ["capsule", "capsule"],
    "model": "morse", "parameters": {"depth": "3e-7 J/m2"}}])"});
  space.overrides.emplace_back(R"(/cells=[{"type": "capsule", "at": ["2 um", "3.4 um", "3 um"]}, {"type": "capsule",
    "at": ["6 um", "8.6 um", "3 um"]}, {"type": "capsule", "at": ["8.2 um", "3.6 um", "8.8 um"]},
    {"type": "capsule", "at": ["12 um", "8.4 um", "9.2 um"]}])");
  compare_viscosities<D3Q19>(space, 0.7, false, true);
}

namespace {

/// Cells sheared by x += strain y, without a fluid: the stress, and the energy, of all.
template <class Set>
std::pair<double, double> stress_and_energy(const Case& c, double strain) {
  Bench<double, Set> bench(c);
  for (int i = 0; i < bench.cells.node_count(); ++i) bench.cells.position[0][i] += strain * bench.cells.position[1][i];
  bench.start();
  bench.solver->compute_forces();
  return {bench.particle_stress() * static_cast<double>(bench.solver->setup().domain.nodes()),
          observe::cell_energy(*bench.solver).sum};
}
template <class Set>
void compare_with_energy(const Case& c) {
  CAPTURE(c.what);
  constexpr double h = 1e-5;
  const double rise = (stress_and_energy<Set>(c, h).second - stress_and_energy<Set>(c, -h).second) / (2 * h);
  CHECK(stress_and_energy<Set>(c, 0).first == Approx(rise).epsilon(1e-5));
}
const std::string pair_in_plane = R"(/cells=[{"type": "rbc", "at": ["6 um", "4 um"], "angle": "10 deg"},
  {"type": "rbc", "at": ["7.5 um", "7.2 um"], "angle": "15 deg"}])";
Case pair_in_space(const std::string& domain) {
  Case c = in_space("pair in space", "6", "6", domain, {R"(/interactions=[{"between": ["capsule", "capsule"],
    "model": "morse", "parameters": {"depth": "1e-6 J/m2"}}])"});
  c.overrides.emplace_back(R"(/cells=[{"type": "capsule", "at": ["5 um", "4 um", "6 um"]},
    {"type": "capsule", "at": ["10.2 um", "7.4 um", "6 um"]}])");
  return c;
}

/// Stress with a cell moved by a period along y, of two cells, and what it would be without images.
template <class Set>
std::pair<double, double> stress_of_moved(const Case& c, double periods) {
  Bench<double, Set> bench(c);
  const CellRange& last = bench.cells.cells.back();
  for (int i = last.first; i < last.end(); ++i) bench.cells.position[1][i] += periods * bench.scene.domain.nodes[1];
  bench.start();
  bench.solver->compute_forces();
  return {bench.particle_stress(), bench.particle_stress(false)};
}

}  // namespace

TEST_CASE("the particle stress is what it costs in energy to shear all cells, with what they do to each other") {
  Case plane = beside_wall("pair in the plane", {shear});
  plane.overrides.push_back(pair_in_plane);
  compare_with_energy<D2Q9>(plane);
  compare_with_energy<D3Q19>(pair_in_space(walls_y));
}

TEST_CASE("the particle stress is the same through whichever image cells act on each other") {
  const std::string free = "/domain/y=\"periodic\"";
  Case plane = beside_wall("pair", {pushed, none, free});
  plane.overrides.push_back(pair_in_plane);
  const auto check = []<class Set>(const Case& c, Set) {
    const auto [here, plain] = stress_of_moved<Set>(c, 0);
    CHECK(here == Approx(plain));
    for (const double periods : {1.0, -2.0}) {
      const auto [moved, without] = stress_of_moved<Set>(c, periods);
      CHECK(moved == Approx(here).epsilon(1e-9));
      CHECK(std::abs(without - here) > 0.1 * std::abs(here));
    }
  };
  check(plane, D2Q9{});
  Case space = pair_in_space("\"y\": \"periodic\"");
  space.overrides.push_back(pushed), space.overrides.push_back(none);
  check(space, D3Q19{});
  // One cell and its own images against two cells and theirs.
  const auto stack = [&](const char* size, const char* nodes, const char* cells) {
    Case c = beside_wall("stack", {pushed, none, free});
    for (const char* more : {size, nodes, cells}) c.overrides.emplace_back(more);
    return stress_of_moved<D2Q9>(c, 0);
  };
  const auto [one, without] = stack(R"(/domain/size=["12.544 um", "3.528 um"])", "/domain/nodes=[64, 18]",
                                    R"(/cells=[{"type": "rbc", "at": ["6 um", "2 um"], "angle": "4 deg"}])");
  const auto two = stack(R"(/domain/size=["12.544 um", "7.056 um"])", "/domain/nodes=[64, 36]",
                         R"(/cells=[{"type": "rbc", "at": ["6 um", "1.9 um"], "angle": "4 deg"},
                                     {"type": "rbc", "at": ["6 um", "5.428 um"], "angle": "4 deg"}])");
  CHECK(one == Approx(two.first).epsilon(1e-9));
  CHECK(std::abs(without - one) > 0.1 * std::abs(one));
}
