// The same run directory from any number of ranks: whole runs cut into blocks, and checkpoints that other cuts go on
// from.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>

#include "files/checkpoint_file.hpp"
#include "hdf5/hdf5_file.hpp"
#include "plan/solver_setup.hpp"
#include "run/simulation.hpp"
#include "scratch_folder.hpp"
#include "unit/blocks_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// Outputs every 7 steps, fields every 30, checks every 16; what is left open is as in the scene's file.
struct Planned {
  explicit Planned(const Case& c)
      : scene(plan::read_scene(c.file, c.overrides)), plan(plan::make_plan(scene, catalog())) {
    const double step = plan.stages.front().units.time;
    scene.output.cells = {.strain = {}, .seconds = 7 * step};
    scene.output.fields = {.strain = {}, .seconds = 30 * step};
    scene.output.quantities = {"velocity", "density", "viscosity", "vorticity"};
    scene.checks.every_steps = 16;
    report = plan::make_report(plan);
  }
  [[nodiscard]] int cell_count() const { return static_cast<int>(scene.cells.size()); }

  scene::Scene scene;
  plan::Plan plan;
  plan::PlanReport report;
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  REQUIRE(stream.is_open());
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A summary without what is measured of the machine and what depends on who wrote the last checkpoint.
nlohmann::json summary(const std::filesystem::path& directory) {
  nlohmann::json content = nlohmann::json::parse(bytes_of(directory / "summary.json"));
  for (const char* key :
       {"wall_s", "steps_per_s", "mlups", "peak_rss_bytes", "threads", "ranks", "started", "resumed"}) {
    REQUIRE(content.erase(key) == 1);
  }
  // Checksums of files that are compared by themselves, and of those with times in them.
  for (const char* key : {"passes", "files", "summary_xxh3"}) REQUIRE(content.erase(key) == 1);
  for (nlohmann::json& stage : content["stages"]) stage.erase("wall_s");
  return content;
}

using Arrays = std::map<std::string, std::string>;  // bytes by name

void add_arrays(const hdf5::File& file, const std::string& group, Arrays& arrays) {
  if (!file.has(group)) return;
  for (const std::string& name : file.names(group)) {
    const std::string path = group + "/" + name;
    if (path == "/membranes/state") continue;  // a group
    const std::vector<double> values = file.read(path);
    arrays[path] = {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
  }
}

/// What a checkpoint holds, but for times and in which pieces frames have been written.
Arrays checkpoint(const std::filesystem::path& directory) {
  const files::CheckpointReader reader(files::checkpoint_file(directory));
  nlohmann::json state = reader.state();
  for (const char* key : {"wall", "stage_wall", "costs", "resumed"}) REQUIRE(state["run"].erase(key) == 1);
  for (nlohmann::json& stage : state["run"]["stages"]) stage.erase("wall_s");
  for (const char* key : {"log_s", "frames"}) REQUIRE(state["directory"].erase(key) == 1);
  const std::vector<std::uint8_t> cbor = nlohmann::json::to_cbor(state);
  Arrays arrays{{"state", {cbor.begin(), cbor.end()}}};
  const hdf5::File file(reader.path(), hdf5::File::Mode::read);
  for (const char* group : {"/populations", "/membranes", "/membranes/state", "/indicator"}) {
    add_arrays(file, group, arrays);
  }
  REQUIRE(arrays.size() > 9);
  return arrays;
}

Arrays frames(const std::filesystem::path& directory) {
  const hdf5::File file(directory / "frames.h5", hdf5::File::Mode::read);
  Arrays arrays;
  for (const std::string& frame : file.names("/frames")) {
    for (const char* group : {"/membranes", "/fields"}) add_arrays(file, "/frames/" + frame + group, arrays);
  }
  return arrays;
}

void compare(const char* what, const Arrays& expected, const Arrays& found) {
  for (const auto& [name, values] : expected) {
    INFO(what << " " << name);
    CHECK((found.contains(name) && found.at(name) == values));
  }
  CHECK(found.size() == expected.size());
}

void compare(const std::filesystem::path& whole, const std::filesystem::path& cut) {
  for (const char* file :
       {"cells.csv", "series.csv", "aggregates.csv", "aggregate_sizes.csv", "frames.xmf", "scene.json"}) {
    const std::string expected = bytes_of(whole / file), found = bytes_of(cut / file);
    const auto at = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end()).first;
    const auto line = std::find(std::make_reverse_iterator(at), expected.rend(), '\n').base();
    INFO(file << ", first difference in: " << std::string(line, std::find(at, expected.end(), '\n')));
    CHECK((expected == found));
  }
  CHECK(summary(whole) == summary(cut));
  compare("checkpoint", checkpoint(whole), checkpoint(cut));
  compare("frames", frames(whole), frames(cut));
}

run::RunOptions options(long steps, int threads) {
  run::RunOptions chosen;
  chosen.threads = threads;
  chosen.max_steps = steps;
  chosen.quiet = true;
  return chosen;
}

void run_whole(const Planned& planned, long steps, const std::filesystem::path& folder) {
  files::RunDirectory directory(folder, planned.scene);
  run::simulate(planned.plan, planned.report, options(steps, 1), &directory);
}

template <int D>
void run_cut(const Planned& planned, const Cut<D>& cut, const run::RunOptions& options,
             const std::filesystem::path& folder, files::FormerRun former = files::FormerRun::keep) {
  on_all_ranks(cut.blocks, [&](const Ranks<D>& ranks) {
    try {
      std::optional<files::RunDirectory> directory;
      if (ranks.first()) directory.emplace(folder, planned.scene, former);
      run::simulate(planned.plan, planned.report, options, directory ? &*directory : nullptr, ranks, cut.owner);
    } catch (...) {
      ranks.transport->abandon();
      throw;
    }
  });
}

template <int D>
std::vector<Cut<D>> cuts_of(const Planned& planned) {
  return test::cuts_of(scene::lattice_domain<D>(planned.scene), planned.cell_count());
}

template <int D>
void compare_cuts(const Case& c, long steps) {
  const Planned planned(c);
  const ScratchFolder folder;
  run_whole(planned, steps, folder.path() / "whole");
  for (const Cut<D>& cut : some_cuts_of(scene::lattice_domain<D>(planned.scene), planned.cell_count())) {
    CAPTURE(c.what, cut.what, cut.owner);
    run_cut(planned, cut, options(steps, cut.threads), folder.path() / "cut");
    compare(folder.path() / "whole", folder.path() / "cut");
    CHECK((bytes_of(folder.path() / "whole/frames.h5") == bytes_of(folder.path() / "cut/frames.h5")));
    std::filesystem::remove_all(folder.path() / "cut");
  }
}

template <int D>
void compare_continued(const Case& c, long steps) {
  Planned planned(c);
  const ScratchFolder folder;
  const auto cut = folder.path() / "cut";
  run_whole(planned, steps, folder.path() / "whole");
  const std::vector<Cut<D>> cuts = cuts_of<D>(planned);
  planned.scene.output.checkpoint_seconds = 0.02;  // some in between, when a clock says so
  run_cut(planned, cuts[1], options(steps / 3, 1), cut);
  run_cut(planned, cuts[2], options(steps * 2 / 3, 2), cut, files::FormerRun::resume);
  run_cut(planned, cuts.back(), options(steps, 1), cut, files::FormerRun::resume);
  CAPTURE(c.what);
  compare(folder.path() / "whole", cut);
}

/// The four cells at rest, then in shear with another time step.
const Case two_stages{"two stages",
                      four_cells,
                      {contrast,
                       R"(/stages=[{"name": "rest", "duration": "2 ms", "density_factor": 13000},
                                   {"name": "shear", "shear_rate": "50 1/s", "strain": 5}])"}};

}  // namespace

TEST_CASE("a run cut into any blocks writes the same directory", "[optimised]") {
  std::vector<Case> cases = scenes_to_cut();
  cases.push_back(two_stages);
  cases.push_back({"no cells", four_cells, {driven, "/output={}", "/cells=[]", "/interactions=[]"}});
  for (const Case& c : cases) compare_cuts<2>(c, block_steps(36));
}

TEST_CASE("a run in three dimensions cut into any blocks writes the same directory", "[optimised]") {
  for (const Case& c : scenes_in_space()) {
    compare_cuts<3>(c, block_steps(12));
    compare_continued<3>(c, block_steps(12));
  }
}

namespace {

/// At every check ranks get other blocks, which depend on how long they have computed.
template <int D>
void compare_cut_again(const Case& c, const Cut<D>& cut, long steps) {
  const Planned planned(c);
  const ScratchFolder folder;
  CAPTURE(c.what, cut.what);
  run_whole(planned, steps, folder.path() / "whole");
  run::RunOptions chosen = options(steps, cut.threads);
  chosen.cut_at_checks = true;
  run_cut(planned, cut, chosen, folder.path() / "cut");
  compare(folder.path() / "whole", folder.path() / "cut");
  const std::string log = bytes_of(folder.path() / "cut/log.jsonl");
  CHECK(log.find("\"event\":\"cut\"") != std::string::npos);
}

}  // namespace

TEST_CASE("a run whose ranks get other blocks on the way writes the same directory") {
  std::vector<Case> cases = scenes_to_cut();
  std::erase_if(cases, [](const Case& c) {  // one for each kind of state
    return c.what != "slip and area correction" && c.what != "memory" && c.what != "bonds with a wall, too" &&
           c.what != "oscillating" && c.what != "mean velocity" && c.what != "over x and y";
  });
  REQUIRE(cases.size() == 6);
  cases.push_back(two_stages);
  cases.push_back({"no cells", four_cells, {driven, "/output={}", "/cells=[]", "/interactions=[]"}});
  for (const Case& c : cases) {
    const core::Domain<2> domain = scene::lattice_domain<2>(Planned(c).scene);
    const auto [nx, ny] = domain.size;
    const core::Box<2> strip{{0, 0}, {nx / 5, ny}}, floor{{nx / 5, 0}, {nx, 3}}, rest{{nx / 5, 3}, {nx, ny}};
    compare_cut_again<2>(c, {"uneven", Decomposition<2>(domain, {strip, floor, rest}), {}, 1}, block_steps(70));
  }
}

TEST_CASE("a run into which cells come and from which they leave gets other blocks on the way and writes the same",
          "[optimised]") {
  const Case c{"fed",
               four_cells,
               {contrast, "/output={}", "/numerics/area_correction=true", "/cell_types/rbc/segments=60",
                R"(/cells=[{"type": "rbc", "at": ["30 um", "8 um"], "angle": "1 rad"}])",
                R"(/domain={"size": ["60 um", "16 um"], "nodes": [120, 32],
                    "x": {"lower": {"inlet": {"mean_velocity": "1 mm/s",
                                              "cells": {"type": "rbc", "hematocrit": 0.2, "seed": 3}}},
                          "upper": {"outlet": {"pressure": "0 Pa"}}},
                    "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})",
                R"(/interactions=[{"between": ["rbc", "rbc"], "model": "repulsion",
                                   "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}},
                                  {"between": ["rbc", "wall"], "model": "repulsion",
                                   "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}}])",
                R"(/stages=[{"name": "flow", "duration": "1 s", "density_factor": 100}])"}};
  const core::Domain<2> domain = scene::lattice_domain<2>(Planned(c).scene);
  compare_cut_again<2>(c, {"even", Decomposition<2>::even(domain, {3, 1}), {}, 1}, 6000);
}

TEST_CASE("a run in three dimensions whose ranks get other blocks on the way writes the same directory") {
  const Case c = scenes_in_space().front();
  const core::Domain<3> domain = scene::lattice_domain<3>(Planned(c).scene);
  compare_cut_again<3>(c, {"even", Decomposition<3>::even(domain, {1, 3, 1}), {}, 2}, block_steps(40));
}

TEST_CASE("a run that fails, fails the same in any blocks") {
  using Row = std::pair<std::string, std::vector<std::string>>;
  const Row row = GENERATE(Row{"mach", {"/checks/mach=0.04"}},
                           Row{"node_step", {"/checks/node_step=0.01", "/stages/1/start=\"developed\""}});
  Case failing = two_stages;
  failing.overrides.push_back("/numerics/area_correction=true");
  failing.overrides.insert(failing.overrides.end(), row.second.begin(), row.second.end());
  const Planned planned(failing);
  const ScratchFolder folder;
  run_whole(planned, 200, folder.path() / "whole");
  const nlohmann::json expected = summary(folder.path() / "whole");
  REQUIRE(expected.at("failure").at("reason") == row.first);
  REQUIRE(expected.at("stages").size() == 2);
  for (const Cut<2>& cut : cuts_of<2>(planned)) {
    CAPTURE(cut.what, cut.owner);
    run_cut(planned, cut, options(200, cut.threads), folder.path() / "cut");
    CHECK(summary(folder.path() / "cut") == expected);
    std::filesystem::remove_all(folder.path() / "cut");
  }
}

TEST_CASE("any cut goes on from the checkpoint of any other") {
  for (const Case& c : {two_stages, scenes_to_cut()[7], scenes_to_cut()[9], scenes_to_cut()[12], scenes_to_cut()[13],
                        scenes_to_cut()[16]}) {
    compare_continued<2>(c, block_steps(130));
  }
}

TEST_CASE("all ranks stop at the same step when one of them is asked to") {
  const Planned planned(two_stages);
  const ScratchFolder folder;
  const Cut<2> cut = cuts_of<2>(planned)[2];
  const std::atomic<bool> asked = true;
  std::vector<run::Summary> ends(3);
  on_all_ranks(cut.blocks, [&](const Ranks<2>& ranks) {
    run::RunOptions chosen = options(1000, cut.threads);
    if (!ranks.first()) chosen.interrupted = &asked;
    std::optional<files::RunDirectory> directory;
    if (ranks.first()) directory.emplace(folder.path() / "run", planned.scene);
    ends[ranks.transport->rank()] =
        run::simulate(planned.plan, planned.report, chosen, directory ? &*directory : nullptr, ranks, {});
  });
  for (const run::Summary& end : ends) {
    CHECK(end.status == "interrupted");
    CHECK(end.steps == ends.front().steps);
  }
}

TEST_CASE("a rank that throws ends the others, whatever they wait for") {
  const Planned planned(two_stages);
  const ScratchFolder folder;
  for (const Cut<2>& cut : cuts_of<2>(planned)) {
    if (cut.blocks.ranks() == 1) continue;
    CAPTURE(cut.what);
    files::RunDirectory directory(folder.path() / "run", planned.scene, files::FormerRun::replace);
    std::filesystem::remove_all(folder.path() / "run");  // where the checkpoint cannot be written then
    std::atomic<int> lost = 0;
    CHECK_THROWS_AS(on_all_ranks(cut.blocks,
                                 [&](const Ranks<2>& ranks) {
                                   try {
                                     run::simulate(planned.plan, planned.report, options(40, cut.threads),
                                                   ranks.first() ? &directory : nullptr, ranks, cut.owner);
                                   } catch (const RankLost&) {
                                     ++lost;
                                     throw;
                                   }
                                 }),
                    Error);
    CHECK(lost == cut.blocks.ranks() - 1);
  }
}
