// rouleau run SCENE: simulate and write a run directory.
#include <csignal>
#include <filesystem>
#include <iostream>
#include <optional>
#include <vector>

#include "accuracy/measure_errors.hpp"
#include "command/process/command_line.hpp"
#include "command/process/crew.hpp"
#include "command/process/interruption.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "plan/estimate.hpp"
#include "ranked_run.hpp"
#include "refined_run.hpp"
#include "report/report.hpp"
#include "run/simulation.hpp"
#include "run_words.hpp"
#include "scene_options.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

namespace {

constexpr const char* run_help = R"(usage: rouleau run SCENE [options]

Simulates a scene and writes a run directory: summary.json, cells.csv, aggregates.csv, aggregate_sizes.csv, series.csv,
frames.h5 with frames.xmf (ParaView), log.jsonl, checkpoint.h5 and report.html.

Ctrl-C, SIGTERM, a closed terminal, SIGUSR1, SIGXCPU and --max-time stop a run after a checkpoint. --resume continues
from the last checkpoint of the directory (without --out: runs/NAME of the scene), however the run ended, and gives the
same results as a run without the break. If there is no checkpoint, the run begins at the beginning.

Started by mpirun or srun, its processes compute one run together, to the same bytes (docs/ranks.md).

--error-bar measures an error of every number that the run reports: cheap runs of the same scene follow, on coarser
lattices, with developed flow and with another density, and take at most about 40 % of the run's time. A scene with
"numerics": "auto" gets error bars without being asked, and where they miss its target a finer run in DIR/refined;
--no-error-bar leaves both out.

Example:
  rouleau run scenes/four-cells-shear.json --out runs/demo --threads 2
  rouleau run scenes/four-cells-shear.json --out runs/demo --overwrite --max-steps 2000
  rouleau run scenes/four-cells-shear.json --out runs/demo --resume
  rouleau run scenes/four-cells-shear.json --out runs/demo --overwrite --error-bar
  mpirun -n 4 rouleau run scenes/four-cells-shear.json --out runs/demo --overwrite --threads 2
  rouleau run scenes/four-cells-shear.json --set /interactions/0/parameters/depth="1.3e-6 J/m2"

Exit codes: 0 done, 1 the simulation failed, 2 bad input, 3 a plugin was refused, 4 input/output, 130 interrupted
)";

/// What the command line says about error bars.
struct ErrorBarChoice {
  bool asked_for = false, refused = false;
  [[nodiscard]] bool wanted(const std::optional<plan::NumericsChoice>& choice) const {
    return asked_for || (choice && !refused);
  }
};

/// Measures the errors of a run that has come to its end; `lines` gets what there is to say. False when interrupted,
/// which it says by itself.
bool add_error_bars(const std::filesystem::path& folder, const scene::Scene& scene,
                    const accuracy::MeasureOptions& options, const std::string& again,
                    std::vector<std::string>& lines) {
  const accuracy::MeasuredErrors errors = accuracy::measure_errors(folder, scene, options);
  if (errors.interrupted) {
    std::cerr << "ended by " << interruption_cause()
              << "; the run is whole, its error bars are missing\nto add them: " << again << " --error-bar\n";
    return false;
  }
  lines = in_words(errors);
  return true;
}

/// Adds error bars to a run that had ended before. Returns the exit code.
int complete_error_bars(const std::filesystem::path& folder, const scene::Scene& scene,
                        const accuracy::MeasureOptions& options, const std::string& again) {
  std::vector<std::string> lines;
  const bool whole = add_error_bars(folder, scene, options, again, lines);
  close_run(folder, lines);
  return whole ? exit_code::done : exit_code::interrupted;
}

void check_max_steps(long steps) {
  if (steps >= 0) return;
  throw Error(Cause::bad_input, "--max-steps " + std::to_string(steps) +
                                    ": wants a number of steps, zero or more; leave it out for a run without limit");
}

/// What the command line asks for.
struct Request {
  SceneOptions scene;
  std::string out, max_time;
  bool overwrite = false, resume = false;
  ErrorBarChoice bars;
  run::RunOptions run;
};

/// False: help was asked for, and shown.
bool read_request(const std::vector<std::string>& arguments, Request& request) {
  namespace options = boost::program_options;
  auto& [scene_options, out, max_time, overwrite, resume, bars, run] = request;
  options::options_description description("options");
  options::positional_options_description positional;
  scene_options.add_to(description, positional);
  description.add_options()(
      "out", options::value(&out)->value_name("DIR")->notifier(not_empty("--out")),
      "run directory (default: runs/NAME of the scene, or the first free one of runs/NAME-2, ...)")(
      "overwrite", options::bool_switch(&overwrite), "replace the run that the directory holds")(
      "resume", options::bool_switch(&resume), "go on from the directory's checkpoint")(
      "force", options::bool_switch(&run.force),
      "with --resume: also where program, plugins, outputs or later stages differ from the checkpoint's")(
      "threads", options::value(&run.threads)->default_value(1)->value_name("N"),
      "threads; results do not depend on their number")(
      "max-steps", options::value(&run.max_steps)->value_name("N")->notifier(check_max_steps),
      "stop after N steps over all stages")(
      "max-time", options::value(&max_time)->value_name("TIME")->notifier(not_empty("--max-time")), TimeLimit::help)(
      "error-bar", options::bool_switch(&bars.asked_for),
      "measure an error of every reported number, by cheap runs of the same scene")(
      "no-error-bar", options::bool_switch(&bars.refused), "not even where numerics are chosen by \"auto\"")(
      "quiet", options::bool_switch(&run.quiet), "no progress on the terminal");
  if (!parse_command_line("run", run_help, arguments, description, positional)) return false;
  std::signal(SIGPIPE, SIG_IGN);  // when who reads the progress has gone the run goes on

  if (resume && overwrite)
    throw Error(Cause::bad_input, "--resume and --overwrite: a run either goes on or is replaced; give one of them");
  if (bars.asked_for && bars.refused) throw Error(Cause::bad_input, "--error-bar and --no-error-bar: give one of them");
  if (run.force && !resume) throw Error(Cause::bad_input, "--force: only together with --resume");
  check_threads("--threads", run.threads);
  return true;
}

/// Reads and plans the scene, and says what there is to warn of.
void prepare(Request& request, const TimeLimit& limit, std::optional<PlannedScene>& planned) {
  planned.emplace(request.scene);  // before a directory is made
  const auto& [scene, numerics_choice] = planned->read;
  request.run.threads = useful_threads(scene, request.run.threads);
  const Crew* const crew = Crew::present();
  const plan::PlanReport& report = planned->report;
  require_startable(*planned, planned->blocks ? &*planned->blocks : nullptr, crew != nullptr ? crew->ranks() : 1);
  for (const std::string& warning : report.warnings) {
    {
      const Coloured yellow(std::cerr, Colour::yellow);
      std::cerr << "warning: ";
    }
    std::cerr << warning << "\n";
  }

  if (numerics_choice && request.bars.wanted(numerics_choice)) {
    const std::string may_take = say_what_auto_may_take(*numerics_choice, report.estimate.wall_s, limit);
    if (!may_take.empty()) std::cerr << "warning: " << may_take << "\n";
  }
}

/// What a process does that is alone, or the first rank. Returns the exit code.
int lead(const Request& request, const PlannedScene& planned, const TimeLimit& limit) {
  const SceneOptions& scene_options = request.scene;
  const std::string& out = request.out;
  const bool overwrite = request.overwrite, resume = request.resume;
  const ErrorBarChoice& bars = request.bars;
  const run::RunOptions& run = request.run;
  const plan::ReadScene& read = planned.read;
  const auto& [scene, numerics_choice] = read;
  const plan::PlanReport& report = planned.report;
  const Crew* const crew = Crew::present();
  const std::filesystem::path named = out.empty() ? directory_for(scene_options.scene) : std::filesystem::path(out);
  const std::filesystem::path folder = !out.empty() || overwrite || resume ? named : files::unused_directory(named);
  const std::string again = (crew != nullptr ? crew->start() : "") + "rouleau run " + scene_options.in_shell() +
                            " --out " + in_shell(folder.string()) + " --resume";
  const files::FormerRun former = resume      ? files::FormerRun::resume
                                  : overwrite ? files::FormerRun::replace
                                              : files::FormerRun::keep;
  const accuracy::MeasureOptions measure{
      .catalog = planned.catalog, .threads = run.threads, .quiet = run.quiet, .interrupted = run.interrupted};
  const bool refines = numerics_choice && bars.wanted(numerics_choice) && run.max_steps < 0;
  const auto refine = [&] {
    return refine_if_missed({scene_options, read, folder, report.estimate.wall_s, run, measure, again}, limit);
  };
  // A run that has ended gets what it lacks, whether or not it kept a checkpoint: error bars, and a finer run.
  if (resume && bars.wanted(numerics_choice) && run.max_steps < 0) {
    const accuracy::Finished finished = accuracy::finished_run(folder, scene);
    if (finished == accuracy::Finished::without_bars) {
      const int code = complete_error_bars(folder, scene, measure, again);
      return code == exit_code::done && refines ? refine() : code;
    }
    if (finished == accuracy::Finished::with_bars && refines && missed_its_target(folder, *numerics_choice))
      return refine();
  }
  run::Summary summary;
  if (!run.quiet)
    std::cerr << opening(planned.plan, report, crew != nullptr ? crew->ranks() : 1, run.threads, processors(), folder);
  {
    files::RunDirectory directory(folder, scene, former);
    if (resume && !directory.resumes())
      std::cerr << folder.string() << " holds no checkpoint: the run begins at the beginning\n";
    summary = simulate_on_all_ranks(scene_options, planned, run, directory, again);
  }
  const bool whole = summary.status == "completed" && summary.stages.back().ended_by != run::Ending::max_steps;
  std::vector<std::string> error_lines;
  bool bars_interrupted = false;
  if (bars.wanted(numerics_choice) && whole) {
    try {
      bars_interrupted = !add_error_bars(folder, scene, measure, again, error_lines);
    } catch (const Error& error) {
      report::write_report(folder);
      throw Error(
          error.cause(), error.place(), error.problem(),
          {in_options(error.remedy()) + "\n  the run is whole; to add its error bars: " + again + " --error-bar"});
    }
  } else if (bars.asked_for && !whole && !summary.failure) {
    error_lines.emplace_back("no error bars: the run has not come to its end");
  }
  close_run(folder, error_lines);
  if (bars_interrupted) return exit_code::interrupted;
  if (summary.failure) {
    say(*summary.failure);
    return exit_code::simulation_failed;
  }
  if (summary.status == "interrupted" && summary.checkpoint_step) {
    std::cerr << "ended by " << interruption_cause() << "\nto go on: " << again << "\n";
  } else if (summary.status == "interrupted") {
    std::cerr << "ended by " << interruption_cause()
              << "; no checkpoint was kept (output.checkpoint of the scene): the run can only begin again, with "
                 "--overwrite\n";
  }
  if (summary.status == "interrupted") return exit_code::interrupted;
  return refines && whole ? refine() : exit_code::done;
}

}  // namespace

int run_command(const std::vector<std::string>& arguments) {
  Request request;
  std::optional<TimeLimit> limit;
  std::optional<PlannedScene> planned;
  const auto begin = [&] {
    if (!read_request(arguments, request)) return;
    limit.emplace(request.max_time);
    prepare(request, *limit, planned);
  };
  Crew* const crew = Crew::present();
  if (crew != nullptr)
    crew->in_turn(begin);
  else
    begin();
  if (!planned) return exit_code::done;  // help was asked for
  require_same_run(arguments, *planned);
  require_threads("--threads", request.run.threads);
  request.run.interrupted = &listen_for_interruption(*limit);
  if (crew != nullptr && !crew->first()) return follow_first_rank(request.scene, *planned, request.run);
  const int code = lead(request, *planned, *limit);
  dismiss_other_ranks(code);
  return code;
}

}  // namespace rouleau::command
