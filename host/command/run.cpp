// rouleau run SCENE: simulate and write a run directory.
#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <thread>

#include "cell/membranes.hpp"
#include "command_line.hpp"
#include "commands.hpp"
#include "output/report.hpp"
#include "run/simulation.hpp"
#include "scene_options.hpp"

namespace rouleau::host {

namespace {

std::atomic<bool> interrupted = false;
void interrupt(int) { interrupted = true; }

constexpr const char* help = R"(usage: rouleau run SCENE [options]

Simulates a scene and writes a run directory: summary.json, cells.csv, aggregates.csv, aggregate_sizes.csv, series.csv,
frames.h5 with frames.xmf (ParaView), log.jsonl and report.html.

Example:
  rouleau run scenes/four-cells-shear.json --out runs/demo --threads 2
  rouleau run scenes/four-cells-shear.json --out runs/demo --overwrite --max-steps 2000
  rouleau run scenes/four-cells-shear.json --set /interactions/0/parameters/depth='"1.3e-6 J/m2"'

Exit codes: 0 done, 1 the simulation failed, 2 bad input, 3 a plugin was refused, 4 input/output, 130 interrupted
)";

std::string last_words(const Summary& summary) {
  std::string text = outcome(summary);
  if (summary.aggregate_history.empty()) return text;
  return text + ", " + std::to_string(summary.aggregates_final) +
         (summary.aggregates_final == 1 ? " aggregate" : " aggregates");
}

void check_max_steps(long steps) {
  if (steps >= 0) return;
  throw Error(ExitCode::bad_input, "--max-steps " + std::to_string(steps) +
                                       ": wants a number of steps, zero or more; leave it out for a run without limit");
}

}  // namespace

int run_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  SceneOptions scene_options;
  std::string out;
  bool overwrite = false;
  RunOptions run;
  options::options_description description("options");
  options::positional_options_description positional;
  scene_options.add_to(description, positional);
  description.add_options()(
      "out", options::value(&out)->value_name("DIR"),
      "run directory (default: runs/NAME of the scene, or the first free one of runs/NAME-2, ...)")(
      "overwrite", options::bool_switch(&overwrite), "replace the run that the directory holds")(
      "threads", options::value(&run.threads)->default_value(1)->value_name("N"),
      "threads; results do not depend on their number")(
      "max-steps", options::value(&run.max_steps)->value_name("N")->notifier(check_max_steps),
      "stop after N steps over all stages")("quiet", options::bool_switch(&run.quiet), "no progress on the terminal");
  if (!parse_command_line("run", help, arguments, description, positional)) return 0;

  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (run.threads < 1 || run.threads > 1024) {
    throw Error(ExitCode::bad_input, "--threads " + std::to_string(run.threads) +
                                         ": wants a number from 1 to 1024 (this machine has " +
                                         std::to_string(processors) + " processors)");
  }
  const Scene scene = scene_options.read();
  run.threads = std::min(run.threads, std::max(1, scene.domain.nodes[1] / 4));
  const Catalog catalog = scene_options.catalog(scene);
  const Plan plan = make_plan(scene, catalog);
  // Placing the cells finds overlaps before a directory is made.
  if (plan.has_cells) make_membranes(scene, lattice_spacing(scene));
  for (const std::string& warning : plan.warnings) std::cerr << "warning: " << warning << "\n";

  run.interrupted = &interrupted;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  const std::filesystem::path named = std::filesystem::path("runs") / std::filesystem::path(scene_options.scene).stem();
  const std::filesystem::path folder = !out.empty() ? std::filesystem::path(out)
                                       : overwrite  ? named
                                                    : unused_directory(named);
  Summary summary;
  {
    RunDirectory directory(folder, scene, overwrite ? FormerRun::replace : FormerRun::keep);
    summary = simulate(plan, run, directory);
  }
  const std::filesystem::path report = write_report(folder);
  std::cout << report.string() << "\n" << last_words(summary) << "\n";
  if (summary.failure) {
    const Failure& f = *summary.failure;
    std::cerr << f.reason << " at step " << f.step << ", strain " << f.strain;
    if (f.cell >= 0) std::cerr << ", cell " << f.cell;
    std::cerr << ", place (" << f.place[0] * 1e6 << ", " << f.place[1] * 1e6 << ") um\n  " << f.message << "\n  found "
              << f.value << ", limit " << f.limit << "\n  " << f.remedy << "\n";
  }
  if (summary.failure) return static_cast<int>(ExitCode::simulation_failed);
  return static_cast<int>(summary.status == "interrupted" ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace rouleau::host
