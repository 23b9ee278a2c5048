#include "scene_bench.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/run_directory.hpp"
#include "json/json.hpp"
#include "measure.hpp"
#include "plan/estimate.hpp"
#include "plan/read_scene.hpp"
#include "run/simulation.hpp"
#include "space_bench.hpp"

namespace rouleau::bench {

namespace {

/// A folder that is gone when it is no longer needed.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / ("rouleau-bench-" + std::to_string(getpid()))) {}
  ~Scratch() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A scene that is taken apart by pass.
struct Subject {
  const char *title, *file;
};
const Subject four_cells{"Four cells in shear, viscosity ratio 5, Morse potential",
                         ROULEAU_SCENES "/four-cells-shear.json"};
const Subject doublet{"Two red cells that stick together, in three dimensions", ROULEAU_SCENES "/doublet-3d.json"};

run::Summary run(const Subject& subject, const std::vector<std::string>& overrides, int threads, long max_steps) {
  const scene::Scene scene = plan::read_scene(subject.file, overrides);
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const plan::Plan plan = plan::make_plan(scene, catalog);
  const Scratch scratch;
  files::RunDirectory directory(scratch.path(), scene);
  run::RunOptions options;
  options.threads = threads;
  options.max_steps = max_steps;
  options.quiet = true;
  run::Summary summary = simulate(plan, {}, options, &directory);
  if (summary.status != "completed") throw std::runtime_error("the scene did not complete: " + summary.status);
  return summary;
}

double microseconds(const run::Summary& s) { return s.wall_s / static_cast<double>(s.steps) * 1e6; }
double microseconds(const run::Summary& s, const std::string& pass) {
  for (const run::PassCost& cost : s.passes) {
    if (cost.name == pass) return cost.wall_s / static_cast<double>(s.steps) * 1e6;
  }
  return 0;
}

/// `steps`: -1: the whole run. The runs, with one and two threads in both precisions.
std::vector<run::Summary> pass_table(const Subject& subject, const char* part, long steps) {
  std::printf("\n%s (%s), microseconds a step\n", subject.title, part);
  struct Column {
    const char* precision;
    int threads;
  };
  const std::vector<Column> columns{{"f64", 1}, {"f32", 1}, {"f64", 2}, {"f32", 2}};
  std::vector<run::Summary> runs;
  for (const Column& column : columns)
    runs.push_back(run(subject, {std::string("/numerics/precision=") + column.precision}, column.threads, steps));
  std::printf("  %-20s", "pass");
  for (const Column& column : columns)
    std::printf("  %s, %d thread%s", column.precision, column.threads, column.threads > 1 ? "s" : " ");
  std::printf("\n");
  for (const run::PassCost& pass : runs[0].passes) {
    std::printf("  %-20s", pass.name.c_str());
    for (const run::Summary& s : runs) std::printf("  %14.2f", microseconds(s, pass.name));
    std::printf("\n");
  }
  std::printf("  %-20s", "whole step");
  for (const run::Summary& s : runs) std::printf("  %14.2f", microseconds(s));
  std::printf("\n  %-20s", "run, s");
  for (const run::Summary& s : runs) std::printf("  %14.2f", s.wall_s);
  std::printf("\n  %-20s", "ns/node, not fluid");
  const double nodes = plan::membrane_nodes(plan::read_scene(subject.file, {}));
  for (const run::Summary& s : runs)
    std::printf("  %14.1f", (microseconds(s) - microseconds(s, "fluid")) / nodes * 1e3);
  std::printf("\n  speed-up by the second thread: f64 %.2f, f32 %.2f; peak memory of the process %.1f MB\n",
              runs[0].wall_s / runs[2].wall_s, runs[1].wall_s / runs[3].wall_s,
              static_cast<double>(runs.back().peak_rss_bytes) / 1e6);
  std::fflush(stdout);
  return runs;
}

}  // namespace

void nodes_table() {
  struct Scheme {
    const char *name, *coupling;
    int density_factor;
    bool corrected;
  };
  const std::vector<Scheme> schemes{{"plain", "explicit", 2000, false},
                                    {"corrected", "explicit", 2000, true},
                                    {"semi-implicit", "semi-implicit", 2000, true},
                                    {"as in the scene", "semi-implicit", 8000, true}};
  constexpr long steps = 1500;
  constexpr int rounds = 5;
  std::printf(
      "\nA membrane node in three dimensions: %s, cutoff 6 spacings, f32, one thread, its first %ld steps;\n"
      "nanoseconds a node and step, without fluid and outputs, and how fast the machine was: TRT alone in 64^3, "
      "million nodes a second before and after, mean\n  %-6s",
      doublet.title, steps, "round");
  for (const Scheme& scheme : schemes) std::printf(" %20s", scheme.name);
  const double nodes = plan::membrane_nodes(plan::read_scene(doublet.file, {}));
  struct Column {
    std::vector<double> cost, speed;
  };
  std::vector<Column> columns(schemes.size());
  const auto print = [](double cost, double speed) {
    std::printf(" %14.0f (%3.0f)", cost, speed);
    std::fflush(stdout);
  };
  double before = space_speed(0.2);
  for (int round = 0; round < rounds; ++round) {
    std::printf("\n  %-6d", round + 1);
    for (std::size_t s = 0; s < schemes.size(); ++s) {
      nlohmann::json numerics{
          {"precision", "f32"}, {"coupling", schemes[s].coupling}, {"density_factor", schemes[s].density_factor}};
      if (schemes[s].corrected)
        numerics.update({{"kernel", "sharp6"}, {"slip_correction", true}, {"area_correction", true}});
      const run::Summary summary = run(doublet, {"/numerics=" + numerics.dump()}, 1, steps);
      double all = 0;
      for (const run::PassCost& pass : summary.passes) all += microseconds(summary, pass.name);
      for (const char* other : {"fluid", "observe and check", "checkpoint"}) all -= microseconds(summary, other);
      const double after = space_speed(0.2);
      columns[s].cost.push_back(all / nodes * 1e3), columns[s].speed.push_back((before + after) / 2);
      before = after;
      print(columns[s].cost.back(), columns[s].speed.back());
    }
  }
  std::printf("\n  %-6s", "median");
  for (const Column& column : columns) print(median(column.cost), median(column.speed));
  std::printf("\n");
}

void scene_table(bool whole) {
  const auto runs = whole ? pass_table(four_cells, "the whole scene: contact, tumbling, separation", -1)
                          : pass_table(four_cells, "its first 20 000 steps", 20000);
  // The answer, too: how many aggregates the scene ends with is known when it has run to its end.
  for (const run::Summary& s : runs) {
    if (whole && s.aggregates_final != 4) throw std::runtime_error("the rouleau did not break up");
  }
  pass_table(doublet, "its first 1 000 steps", 1000);
}

void cells_table() {
  std::printf(
      "\nMore cells at the same volume fraction (tiles of 256x128 nodes with four cells; one cell: a single one), one "
      "thread\n  %-6s %-12s %-4s %12s %18s %14s %20s %18s\n",
      "cells", "nodes", "", "us a step", "us per four cells", "fluid MLUPS", "ns/node, not fluid",
      "output / 200 steps");
  struct Tiles {
    int cells, across, up;
    long steps;
  };
  for (const Tiles& tiles : {Tiles{1, 1, 1, 4000}, Tiles{4, 1, 1, 4000}, Tiles{64, 4, 4, 800}, Tiles{256, 8, 8, 240},
                             Tiles{1024, 16, 16, 80}, Tiles{4096, 32, 32, 40}}) {
    const int nx = 256 * tiles.across, ny = 128 * tiles.up;
    const double spacing = 0.196;  // um
    std::string list;
    for (int k = 0; k < tiles.cells; ++k) {
      const int tile = k / 4;
      const double x = (tile % tiles.across) * 256 * spacing + 25.088 + 3.52 * (k % 4 - 1.5);
      const double y = (tile / tiles.across) * 128 * spacing + 12.544;
      list += (k > 0 ? "," : "") + std::string("{\"at\":[\"") + std::to_string(x) + " um\",\"" + std::to_string(y) +
              " um\"],\"angle\":\"90 deg\"}";
    }
    const auto micrometres = [&](int nodes) { return "\"" + std::to_string(nodes * spacing) + " um\""; };
    // The walls move as fast as in the scene: with many tiles the shear is weaker.
    const double shear = 20.0 / tiles.up;
    for (const char* precision : {"f64", "f32"}) {
      std::vector<std::string> changes{
          std::string("/numerics/precision=") + precision,
          "/domain/nodes=[" + std::to_string(nx) + "," + std::to_string(ny) + "]",
          "/domain/size=[" + micrometres(nx) + "," + micrometres(ny) + "]",
          "/cells=[{\"type\":\"rbc\",\"list\":[" + list + "]}]",
          "/stages=[{\"name\":\"shear\",\"shear_rate\":\"" + std::to_string(shear) + " 1/s\",\"strain\":50}]",
          R"(/output={"checkpoint":"never"})"};
      const run::Summary s = run(four_cells, changes, 1, tiles.steps);
      // What an output takes: of a run that writes one after every step, the first and what it sets up left out.
      changes.back() = R"(/output={"checkpoint":"never","cells":{"seconds":"1 ns"}})";
      const auto observed = [&](long steps) {
        return microseconds(run(four_cells, changes, 1, steps), "observe and check") * static_cast<double>(steps);
      };
      constexpr long few = 5, more = 25;
      const double output = (observed(more) - observed(few)) / static_cast<double>(more - few);
      const double nodes = static_cast<double>(nx) * ny, us = microseconds(s) - microseconds(s, "observe and check");
      const double fluid = microseconds(s, "fluid");
      std::printf("  %-6d %5dx%-6d %-4s %12.1f %18.1f %14.0f %20.1f %16.2f %%\n", tiles.cells, nx, ny, precision, us,
                  us * 4 / tiles.cells, nodes / fluid, (us - fluid) / (100.0 * tiles.cells) * 1e3,
                  output / (200 * us) * 100);
      std::fflush(stdout);
    }
  }
}

}  // namespace rouleau::bench
