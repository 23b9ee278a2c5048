#include "refined_run.hpp"

#include <iostream>

#include "base/text.hpp"
#include "command/process/program.hpp"
#include "files/checkpoint_file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "ranked_run.hpp"
#include "run_words.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

namespace {

/// A refined run may take so many times what the first one took; more is for the user to decide.
constexpr double most_growth = 10;
constexpr double with_error_bars = 1.4;

std::string percent(double share) { return number(100 * share, 2) + " %"; }
std::string seconds(double time) { return number(time, 2) + " s"; }

/// What the scene says of its numerics, with another target.
nlohmann::json numerics_for(const FirstRun& first, double target) {
  nlohmann::json numerics = first.read.scene.document->root().at("numerics");
  const std::string prefix = "/numerics/";
  for (const plan::ChosenValue& value : first.read.numerics_choice->values)
    if (value.pointer.starts_with(prefix)) numerics.erase(value.pointer.substr(prefix.size()));
  numerics["auto"]["error"] = target;
  return numerics;
}

SceneOptions with_target(const FirstRun& first, double target) {
  SceneOptions scene = first.scene;
  scene.overrides.push_back("/numerics=" + numerics_for(first, target).dump());
  return scene;
}

/// The run with numerics that are chosen with what the first run has shown.
struct Refined {
  Refined(const FirstRun& first, double target)
      : scene(with_target(first, target)), planned(scene), growth(planned.report.estimate.wall_s / first.estimated_s) {}

  SceneOptions scene;
  PlannedScene planned;
  double growth;  ///< of the run's time
};

/// Why no refined run follows; empty: one does.
std::string why_not(const FirstRun& first, const Refined& refined, double took_s, const TimeLimit& limit) {
  if (!refined.planned.read.numerics_choice->doubt.empty()) return refined.planned.read.numerics_choice->doubt;
  if (plan::to_json(refined.planned.read.numerics_choice).at("values") ==
      plan::to_json(first.read.numerics_choice).at("values"))
    return "numerics that would keep it are pinned by the scene";
  const std::string expected = "one is expected to take " + seconds(refined.growth * took_s);
  if (refined.growth > most_growth)
    return expected + ", " + number(refined.growth, 2) + " times as long as this one; to have it, set " +
           "/numerics/auto/error to " + number(refined.planned.read.numerics_choice->target, 2);
  if (limit.is_set() && with_error_bars * refined.growth * took_s > limit.left())
    return expected + ", more than --max-time leaves; to have it: " + first.again;
  return {};
}

/// What is to be said of a refined run once it has error bars.
std::vector<std::string> refined_in_words(const accuracy::MeasuredErrors& errors, double target) {
  std::vector<std::string> lines = in_words(errors);
  if (const std::optional<accuracy::Worst> worst = accuracy::worst(errors.bars)) {
    lines.push_back("numerics.auto: in the refined run the error of " + worst->name + " is estimated as " +
                    percent(worst->error) + (worst->error <= target ? ", within " : ", still more than ") +
                    percent(target));
  }
  return lines;
}

int run_refined(const FirstRun& first, const Refined& refined) {
  const scene::Scene& scene = refined.planned.read.scene;
  const std::filesystem::path folder = first.folder / files::refined_folder;
  const accuracy::Finished finished = accuracy::finished_run(folder, scene);
  if (finished == accuracy::Finished::with_bars) {
    close_run(folder, {});
    return exit_code::done;
  }
  if (finished == accuracy::Finished::no) {
    plan::require_memory(refined.planned.report.estimate.memory_bytes, "the refined run");
    const bool goes_on = std::filesystem::exists(files::checkpoint_file(folder)) ||
                         std::filesystem::exists(files::previous_checkpoint_file(folder));
    const files::FormerRun former = goes_on ? files::FormerRun::resume : files::FormerRun::replace;
    const run::Summary summary = [&] {
      files::RunDirectory directory(folder, scene, former);
      return simulate_on_all_ranks(refined.scene, refined.planned, first.options, directory, first.again);
    }();
    if (summary.status == "interrupted") {
      std::cerr << "ended by " << interruption_cause() << "\nto go on: " << first.again << "\n";
      return exit_code::interrupted;
    }
    if (summary.failure) {
      close_run(folder, {"the refined run failed; what the first one found stands"});
      say(*summary.failure);
      return exit_code::simulation_failed;
    }
  }
  const accuracy::MeasuredErrors errors = accuracy::measure_errors(folder, scene, first.measure);
  if (errors.interrupted) {
    std::cerr << "ended by " << interruption_cause()
              << "; the refined run lacks its error bars\nto add them: " << first.again << "\n";
    return exit_code::interrupted;
  }
  close_run(folder, refined_in_words(errors, first.read.numerics_choice->target));
  return exit_code::done;
}

/// The worst error of the run in the folder, where it is larger than the target.
std::optional<accuracy::Worst> miss(const std::filesystem::path& folder, const plan::NumericsChoice& choice) {
  const nlohmann::json summary = trial::read_summary(folder);
  std::optional<accuracy::Worst> worst = accuracy::measured(summary.at("numerics_choice"));
  if (worst && worst->error <= choice.target) worst.reset();
  return worst;
}

}  // namespace

bool missed_its_target(const std::filesystem::path& folder, const plan::NumericsChoice& choice) {
  return miss(folder, choice).has_value();
}

std::string say_what_auto_may_take(const plan::NumericsChoice& choice, double estimated_s, const TimeLimit& limit) {
  const double bars = with_error_bars * estimated_s, all = (1 + most_growth) * bars;
  if (!limit.is_set() || all < limit.left()) return {};
  const std::string target = "numerics.auto: for an error of " + percent(choice.target) + " ";
  if (bars > limit.left())
    return target + "a run with its error bars is expected to take " + seconds(bars) +
           ", more than --max-time; allow a larger error, or go on later with --resume";
  return target + "a run with its error bars is expected to take " + seconds(bars) +
         "; should they show that the target is missed, --max-time may leave no time for a finer run (up to " +
         seconds(all - bars) + ")";
}

int refine_if_missed(const FirstRun& first, const TimeLimit& limit) {
  const plan::NumericsChoice& choice = *first.read.numerics_choice;
  const std::optional<accuracy::Worst> worst = miss(first.folder, choice);
  if (!worst) return exit_code::done;
  const std::string missed = "numerics.auto has missed its target: the error of " + worst->name + " is estimated as " +
                             percent(worst->error) + ", more than " + percent(choice.target);
  const double target = accuracy::refined_target(choice, *worst);
  if (!(target > 0)) {
    std::cout << missed << "; no finer run follows: outputs are too far apart to tell, make output.cells closer\n";
    return exit_code::done;
  }
  const Refined refined(first, target);
  const std::string reason = why_not(first, refined, trial::read_summary(first.folder).at("wall_s"), limit);
  if (!reason.empty()) {
    std::cout << missed << "; no finer run follows: " << reason << "\n";
    return exit_code::done;
  }
  std::cout << missed << "; a finer run follows in " << (first.folder / files::refined_folder).string() << " ("
            << number(refined.growth, 2) << " times the time)" << std::endl;
  return run_refined(first, refined);
}

}  // namespace rouleau::command
