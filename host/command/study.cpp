// rouleau study STUDY: error against run time over a matrix of settings.
#include <iostream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/interruption.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "study/analysis_json.hpp"
#include "study/study_run.hpp"

namespace rouleau::command {

namespace {

constexpr const char* study_help = R"(usage: rouleau study STUDY [options]

Runs a scene over a matrix of settings (resolution, time step, models, any value of the scene), and measures results and
run time of each. Writes study.json, study.csv and study.html: error against run time, the fastest setting for a given
error, and how certain that is. A run that fails, hangs or is refused is a result too.

Timed runs of all studies on a machine take turns. Finished runs are kept: after Ctrl-C, or with more axes, values or
quantities, the same command continues in the same directory.

Example:
  rouleau study studies/couette.json
  rouleau study studies/couette.json --budget 5min --out runs/couette
  rouleau study studies/poiseuille.json --repeats 5

Exit codes: 0 done (also where points failed), 1 a repeated run gave other results, 2 bad input, 4 input/output,
130 interrupted
)";

/// What was left out, what was found; false where a repeated run gave other results.
bool tell_end(const study::StudyState& state) {
  bool same = true;
  std::vector<std::string> left_out;
  for (const study::MatrixPoint& point : state.points) {
    const std::string name = trial::name_of(state.study->axes, point.point);
    if (!point.record) left_out.push_back(name + ", " + point.left_out);
    if (!point.record || point.record->difference.empty()) continue;
    std::cerr << "not deterministic: " << name << ", " << point.record->difference << "\n";
    same = false;
  }
  constexpr std::size_t few = 3;
  if (left_out.size() > few) {
    std::cerr << "left out: " << left_out.size() << " of " << state.points.size()
              << " points, each with its reason in study.html; the first: " << left_out.front() << "\n";
  } else {
    for (const std::string& point : left_out) std::cerr << "left out: " << point << "\n";
  }
  const nlohmann::json study = study::study_json(state);
  std::string said;
  for (const auto& sentence : study["sentences"]) said += sentence["text"].get<std::string>() + "\n";
  std::cout << folded(said, text_width());
  return same;
}

}  // namespace

int study_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string file, out, budget, max_time;
  int repeats = 0;
  study::StudyOptions chosen;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("study", options::value(&file)->required(), "STUDY file (JSON)")(
      "out", options::value(&out)->value_name("DIR")->notifier(not_empty("--out")),
      "study's directory (default: runs/NAME of the study)")(
      "budget", options::value(&budget)->value_name("TIME"),
      "time for all runs, as 5min: the fastest points are run first, and those that do not fit are left out")(
      "repeats", options::value(&repeats)->value_name("N"), "timed runs of each point (default: the study's, or 3)")(
      "max-time", options::value(&max_time)->value_name("TIME")->notifier(not_empty("--max-time")), TimeLimit::help)(
      "quiet", options::bool_switch(&chosen.quiet), "no lines on what is being run");
  positional.add("study", 1);
  if (!parse_command_line("study", study_help, arguments, description, positional)) return 0;

  study::Study study = study::read_study(file);
  if (repeats < 0 || repeats > 100)
    throw Error(Cause::bad_input, "--repeats " + std::to_string(repeats) + ": wants a number from 1 to 100");
  if (repeats > 0) study.repeats = repeats;
  if (!budget.empty()) chosen.budget_s = seconds_in("--budget", budget);
  chosen.directory = out.empty() ? directory_for(file) : std::filesystem::path(out);
  chosen.interrupted = &listen_for_interruption(TimeLimit(max_time));

  study::StudyRun run(study, chosen);
  const bool ended = run.run();
  std::cout << (chosen.directory / "study.html").string() << "\n";
  if (!ended) {
    std::cerr << "ended by " << interruption_cause() << "; the same command goes on\n";
    return exit_code::interrupted;
  }
  return tell_end(run.state()) ? exit_code::done : exit_code::simulation_failed;
}

}  // namespace rouleau::command
