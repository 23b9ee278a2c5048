// What the tests of blocks and ranks share: scenes, cuts, and ranks that are threads.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "plan/read_scene.hpp"
#include "plugin/catalog.hpp"
#include "unit/random.hpp"
#include "unit/rank_threads.hpp"

namespace rouleau::test {

/// A scene, changed as --set does.
struct Case {
  std::string what;
  std::string file;
  std::vector<std::string> overrides = {};
};

inline const std::string
    four_cells = ROULEAU_SCENES "/four-cells-shear.json",
    shear = R"(/stages=[{"name": "shear", "shear_rate": "50 1/s", "strain": 5, "start": "developed"}])",
    driven = R"(/stages=[{"name": "driven", "pressure_gradient": "2e4 Pa/m", "duration": "1 s"}])",
    kept = R"(/stages=[{"name": "kept", "mean_velocity": "1 mm/s", "duration": "1 s"}])",
    oscillating = R"(/stages=[{"name": "shake", "walls": {"lower": 0, "upper": "1 mm/s"}, "duration": "1 s",
      "oscillation": {"amplitude": {"lower": "0.2 mm/s", "upper": "0.5 mm/s"}, "frequency": "100 Hz"}}])",
    contrast = "/cell_types/rbc/interior_viscosity=\"6 cP\"", semi_implicit = "/numerics/coupling=\"semi-implicit\"";

/// Where the middle of the four cells lies, in um; (25.088, 12.544) is that of the domain.
inline std::string middle(const char* x, const char* y) {
  return std::string("/cells/0/row/center=[\"") + x + " um\", \"" + y + " um\"]";
}

/// Cells in shear and in driven flow, over borders, beside themselves, with every correction, law and potential that
/// remembers.
inline std::vector<Case> scenes_to_cut() {
  const std::string no_strain = "/output={}", periodic_y = "/domain/y=\"periodic\"";
  const std::string bonds = R"(/interactions=[{"between": ["rbc", "rbc"], "model": "bridging", "parameters": {
    "site_density": "1e12 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "200 1/s",
    "off_rate": "10 1/s", "cutoff": "1.5 um"}}])";
  const std::string held = R"({"between": ["wall", "rbc"], "model": "morse", "parameters": {"depth": "1e-7 J/m2"}})",
                    held_alone = "/interactions=[" + held + "]", held_too = "/interactions/-=" + held;
  const std::string bonds_too = R"(/interactions/-={"between": ["rbc", "wall"], "model": "bridging", "parameters": {
    "site_density": "1e12 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "200 1/s",
    "off_rate": "10 1/s", "cutoff": "1.5 um"}})";
  const std::string slip = "/numerics/slip_correction=true", area = "/numerics/area_correction=true";
  const auto alone = [](const std::string& size, const std::string& nodes, const std::string& at) {
    return std::vector<std::string>{shear, contrast, "/domain/size=" + size, "/domain/nodes=" + nodes,
                                    R"(/cells=[{"type": "rbc", "angle": "30 deg", "at": )" + at + "}]"};
  };
  return {
      {"four cells", four_cells, {shear, contrast}},
      {"four cells, f32", four_cells, {shear, contrast, "/numerics/precision=\"f32\""}},
      {"over x", four_cells, {shear, contrast, middle("0.4", "12.544")}},
      {"over x and y", four_cells, {driven, no_strain, contrast, periodic_y, middle("47.824", "24.304")}},
      {"larger than a block", four_cells, alone(R"(["12.544 um", "12.544 um"])", "[64, 64]", R"(["6 um", "6.2 um"])")},
      {"its own neighbour", four_cells, alone(R"(["8.624 um", "25.088 um"])", "[44, 128]", R"(["4 um", "12 um"])")},
      {"driven channel", four_cells, {driven, no_strain, middle("44.688", "14.504")}},
      {"slip and area correction", four_cells, {shear, contrast, slip, area, middle("44.688", "12.544")}},
      {"semi-implicit", four_cells, {shear, semi_implicit}},
      {"bonds", four_cells, {shear, bonds, middle("46.648", "12.544")}},
      {"memory", ROULEAU_PHYSICS_SCENES "/memory.json"},
      {"viscous ring", ROULEAU_PHYSICS_SCENES "/viscous-ring.json"},
      {"oscillating", four_cells, {oscillating, no_strain, contrast, middle("44.688", "14.504")}},
      {"layers",
       four_cells,
       {shear, R"(/fluid/layers=[{"from": "3 um", "to": "12.3 um", "viscosity": "2 cP"}])",
        middle("44.688", "12.544")}},
      {"mean velocity",
       four_cells,
       {kept, no_strain, contrast, "/domain/size=[\"12.544 um\", \"12.544 um\"]", "/domain/nodes=[64, 64]",
        R"(/cells=[{"type": "rbc", "angle": "30 deg", "at": ["6 um", "6.2 um"]}])", "/numerics/tau=2",
        "/numerics/density_factor=800"}},
      {"held by a wall", four_cells, {shear, contrast, held_too, middle("44.688", "4.4")}},
      {"held by a wall alone, slip correction", four_cells, {shear, slip, held_alone, middle("25.088", "4.1")}},
      {"bonds with a wall, too", four_cells, {shear, bonds, bonds_too, middle("46.648", "4.4")}}};
}

/// A cut, who owns the cells (none: by place), and with how many threads each rank works.
template <int D>
struct Cut {
  std::string what;
  core::Decomposition<D> blocks;
  std::vector<int> owner;
  int threads;
};

/// Two cells that stick together and one alone in a channel, which drift by up to 0.05 spacings a step over the border.
inline std::vector<Case> travelling_cells() {
  const std::string quick = R"(/stages=[{"name": "driven", "pressure_gradient": "4e5 Pa/m", "duration": "1 s",
      "start": "developed"}])",
                    cells = R"(/cells=[{"type": "rbc", "row": {"count": 2, "spacing": "3.2 um", "axis": "y",
      "center": ["5 um", "6.2 um"]}}, {"type": "rbc", "angle": "70 deg", "at": ["17 um", "6 um"]}])",
                    size = R"(/domain/size=["25.088 um", "12.544 um"])", nodes = "/domain/nodes=[128, 64]",
                    density = "/numerics/density_factor=250";
  return {{"travelling, slip and area correction",
           four_cells,
           {quick, cells, size, nodes, density, "/output={}", contrast, "/numerics/slip_correction=true",
            "/numerics/area_correction=true"}},
          {"travelling with convection, f32",
           four_cells,
           {quick, cells, size, nodes, density, "/output={}", contrast, "/fluid/inertia=true",
            "/numerics/precision=\"f32\""}}};
}
/// Cuts across the way that they take, with one thread for each rank.
inline std::vector<Cut<2>> cuts_for_travellers(const core::Domain<2>& domain) {
  using Blocks = core::Decomposition<2>;
  return {{"4x1", Blocks::even(domain, {4, 1}), {}, 1}, {"3x2", Blocks::even(domain, {3, 2}), {5, 0, 2}, 1}};
}

/// Two capsules that repel each other, in a channel whose flow takes them over the border.
inline Case travelling_in_space() {
  return {
      "travelling in space",
      ROULEAU_SCENES "/../tests/physics/scenes/plain-capsule-3d.json",
      {"/numerics/precision=\"f64\"",
       R"(/domain={"size": ["15 um", "12 um", "12 um"], "nodes": [40, 32, 32], )"
       R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})",
       R"(/stages=[{"name": "driven", "pressure_gradient": "1e6 Pa/m", "duration": "1 s", "start": "developed"}])",
       "/output={}", "/cell_types/capsule/interior_viscosity=\"6 cP\"", "/numerics/area_correction=true", semi_implicit,
       R"(/interactions=[{"between": ["capsule", "capsule"], "model": "morse", "parameters": {
             "depth": "1e-7 J/m2"}}])",
       R"(/cells=[{"type": "capsule", "at": ["4 um", "6 um", "3 um"]},
                      {"type": "capsule", "at": ["5 um", "6.4 um", "9 um"]}])"}};
}
/// Cuts across the way that they take, with one thread for each rank.
inline std::vector<Cut<3>> cuts_for_travellers(const core::Domain<3>& domain) {
  using Blocks = core::Decomposition<3>;
  return {{"4x1x1", Blocks::even(domain, {4, 1, 1}), {}, 1}, {"2x1x2", Blocks::even(domain, {2, 1, 2}), {3, 0}, 2}};
}

/// Cells in three dimensions: over borders, between walls, in a tube.
inline std::vector<Case> scenes_in_space() {
  const std::string doublet = ROULEAU_SCENES "/doublet-3d.json",
                    capsule = ROULEAU_SCENES "/../tests/physics/scenes/plain-capsule-3d.json",
                    f64 = "/numerics/precision=\"f64\"", plain = "/numerics/slip_correction=false";
  const auto bonds_between = [](const std::string& whom, const std::string& at = "0") {
    return "/interactions/" + at + R"(={"model": "bridging", "parameters": {"site_density": "1e12 1/m2",
      "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "2000 1/s", "off_rate": "10 1/s",
      "cutoff": "1.5 um"}, "between": )" +
           whom + "}";
  };
  const std::string held = R"(/interactions=[{"between": ["wall", "capsule"], "model": "morse", "parameters": {
    "depth": "1e-7 J/m2"}}])";
  return {
      {"doublet over a corner, f32",
       doublet,
       {"/cell_types/rbc/interior_viscosity=\"6 cP\"", "/cells/0/row/center=[\"11.5 um\", \"0.4 um\", \"11.8 um\"]"}},
      {"bonds between cells and with walls",
       doublet,
       {f64, plain, R"(/domain/y={"lower": {"wall": {}}, "upper": {"wall": {}}})",
        R"(/domain/size=["12.5 um", "8 um", "12.5 um"])", "/domain/nodes=[50, 32, 50]",
        "/cells/0/row/center=[\"11.5 um\", \"4 um\", \"11.8 um\"]", bonds_between("[\"rbc\", \"rbc\"]"),
        bonds_between("[\"rbc\", \"wall\"]", "-")}},
      {"within cells, in layers",
       doublet,
       {f64, plain, R"(/domain={"size": ["12.5 um", "8 um", "12.5 um"], "nodes": [50, 32, 50],
                         "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})",
        "/cells/0/row/center=[\"11.5 um\", \"4 um\", \"11.8 um\"]",
        R"(/fluid/layers=[{"from": "2 um", "to": "4.1 um", "viscosity": "2 cP"}])",
        R"(/interactions/-={"between": ["rbc", "self"], "model": "repulsion", "parameters": {"strength": "3e-6 J/m2",
                            "cutoff": "1.5 um"}})",
        R"(/stages/0={"name": "shear", "shear_rate": "20 1/s", "duration": "1 s", "start": "developed"})"}},
      {"volumes kept, semi-implicit", doublet, {f64, semi_implicit, "/numerics/area_correction=true"}},
      {"slip and volumes corrected",
       capsule,
       {f64, "/domain/size=[\"12 um\", \"12 um\", \"12 um\"]", "/domain/nodes=[32, 32, 32]",
        "/cell_types/capsule/interior_viscosity=\"6 cP\"", "/numerics/slip_correction=true", "/numerics/kernel=sharp6",
        "/numerics/area_correction=true", R"(/cells=[{"type": "capsule", "at": ["11.6 um", "6 um", "0.3 um"]}])"}},
      {"capsule near a wall",
       capsule,
       {f64, held, "/domain/size=[\"15 um\", \"12 um\", \"13.5 um\"]", "/domain/nodes=[40, 32, 36]",
        "/cell_types/capsule/interior_viscosity=\"6 cP\"",
        R"(/cells=[{"type": "capsule", "at": ["14.6 um", "3.6 um", "13 um"]}])"}},
      {"in a tube",
       capsule,
       {f64, R"(/domain={"size": ["12 um", "12 um", "12 um"], "nodes": [32, 32, 32],
                         "walls": {"tube": {"radius": "6 um"}}})",
        R"(/stages=[{"name": "driven", "pressure_gradient": "1e5 Pa/m", "duration": "1 s", "start": "developed"}])",
        "/output={}", R"(/cells=[{"type": "capsule", "at": ["0.6 um", "6.3 um", "8.7 um"]}])"}}};
}

inline const plugin::Catalog& catalog() {
  static const plugin::Catalog all({ROULEAU_PLUGINS});
  return all;
}

/// Cuts by bisection at random places.
template <int D>
core::Decomposition<D> random_cuts(const core::Domain<D>& domain, int cuts, std::mt19937& random) {
  std::vector<core::Box<D>> blocks{domain.block};
  while (cuts > 0) {
    core::Box<D>& block = blocks[std::uniform_int_distribution<std::size_t>(0, blocks.size() - 1)(random)];
    const int axis = std::uniform_int_distribution<int>(0, D - 1)(random);
    if (block.size(axis) < 2) continue;
    const int at = block.begin[axis] + std::uniform_int_distribution<int>(1, block.size(axis) - 1)(random);
    core::Box<D> upper = block;
    upper.begin[axis] = at;
    block.end[axis] = at;
    blocks.push_back(upper);
    --cuts;
  }
  return {domain, blocks};
}

/// One block with two threads, even and uneven cuts, random ones with owners at random.
template <int D>
std::vector<Cut<D>> cuts_of(const core::Domain<D>& domain, int cells) {
  using Blocks = core::Decomposition<D>;
  std::vector<Cut<D>> cuts;
  if constexpr (D == 2) {
    const auto [nx, ny] = domain.size;
    const core::Box<2> strip{{0, 0}, {nx / 5, ny}}, floor{{nx / 5, 0}, {nx, 3}}, rest{{nx / 5, 3}, {nx, ny}};
    cuts = {{"1", Blocks::even(domain, {1, 1}), {}, 2},   {"2x1", Blocks::even(domain, {2, 1}), {}, 1},
            {"1x3", Blocks::even(domain, {1, 3}), {}, 2}, {"4x4", Blocks::even(domain, {4, 4}), {}, 1},
            {"8x1", Blocks::even(domain, {8, 1}), {}, 1}, {"uneven", Blocks(domain, {strip, floor, rest}), {}, 2}};
  } else {
    cuts = {{"1", Blocks::even(domain, {1, 1, 1}), {}, 2},
            {"2x1x1", Blocks::even(domain, {2, 1, 1}), {}, 1},
            {"1x3x1", Blocks::even(domain, {1, 3, 1}), {}, 2},
            {"1x1x2", Blocks::even(domain, {1, 1, 2}), {}, 1},
            {"2x3x2", Blocks::even(domain, {2, 3, 2}), {}, 1}};
  }
  auto random = generator(static_cast<unsigned>(std::random_device()()));
  for (int trial = 0; trial < 2; ++trial) {
    Cut<D> cut{"random", random_cuts(domain, 2 + trial * 3, random), {}, 1 + trial};
    for (int i = 0; i < cells; ++i) {
      cut.owner.push_back(std::uniform_int_distribution<int>(0, cut.blocks.ranks() - 1)(random));
    }
    cuts.push_back(std::move(cut));
  }
  return cuts;
}

/// Three of these, others in each run of the tests: all take so long that few scenes could be tried.
template <int D>
std::vector<Cut<D>> some_cuts_of(const core::Domain<D>& domain, int cells) {
  std::vector<Cut<D>> all = cuts_of(domain, cells), some;
  auto random = generator(static_cast<unsigned>(std::random_device()()));
  std::sample(all.begin(), all.end(), std::back_inserter(some), 3, random);
  return some;
}

/// ROULEAU_BLOCK_STEPS=2000 for a long look (docs/testing.md).
inline long block_steps(long otherwise) {
  const char* wanted = std::getenv("ROULEAU_BLOCK_STEPS");
  return wanted != nullptr ? std::strtol(wanted, nullptr, 10) : otherwise;
}

}  // namespace rouleau::test
