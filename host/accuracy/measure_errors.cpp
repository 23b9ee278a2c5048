#include "measure_errors.hpp"

#include <algorithm>
#include <iostream>
#include <memory>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/stopwatch.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "files/verify.hpp"
#include "json/document.hpp"
#include "plan/limits.hpp"
#include "plan/plan_report.hpp"
#include "run/simulation.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_reader.hpp"
#include "shape/passages.hpp"
#include "shape/random_cells.hpp"
#include "shape/walls.hpp"
#include "trial/trial.hpp"

namespace rouleau::accuracy {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// How a companion ended.
struct Ended {
  std::string end;      ///< completed, diverged, refused or interrupted
  std::string message;  ///< why it did not complete
  fs::path directory;
  double wall_s = 0;
};

/// A companion's scene; what it says of files is said from where the run's scene was.
scene::Scene read(const Companion& companion, const std::string& file) {
  Faults faults;
  scene::Scene scene = scene::read_scene(
      std::make_shared<json::Document>(json::Document::parse(companion.scene.dump(2) + "\n", file)), faults);
  if (faults.empty()) shape::build_walls(scene, faults);
  faults.raise();
  shape::survey_walls(scene);
  shape::add_random_cells(scene);
  shape::pack_cells(scene);
  return scene;
}

/// A companion with its plan, which refers to scene and catalog: they stay where they are.
struct Prepared {
  explicit Prepared(const plugin::Catalog& models) : catalog(models) {}

  const plugin::Catalog& catalog;
  std::optional<scene::Scene> scene;
  std::optional<plan::Plan> plan;  ///< none: the companion is refused
  std::string refused;             ///< why
  double wall_s = 0;

  void read_and_plan(const Companion& companion, const std::string& scene_file) {
    const Stopwatch watch;
    plan.reset();
    refused.clear();
    try {
      scene.emplace(read(companion, scene_file));
      plan.emplace(plan::make_plan(*scene, catalog));
    } catch (const Error& error) {
      if (error.cause() == Cause::input_output) throw;
      refused = error.problem();
    }
    wall_s += watch.seconds();
  }
};

/// All companions with their plans. If one of them takes the semi-implicit step, all do: on a coarse lattice its own
/// error shows, and pairs would differ by it.
std::vector<std::unique_ptr<Prepared>> prepare(Companions& companions, const std::string& scene_file,
                                               const plugin::Catalog& catalog) {
  std::vector<std::unique_ptr<Prepared>> all;
  for (const Companion& companion : companions.runs) {
    all.push_back(std::make_unique<Prepared>(catalog));
    all.back()->read_and_plan(companion, scene_file);
  }
  const auto semi_implicit = [](const auto& one) { return one->plan && one->plan->semi_implicit; };
  if (std::none_of(all.begin(), all.end(), semi_implicit)) return all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (semi_implicit(all[i])) continue;
    companions.runs[i].scene["numerics"]["coupling"] = "semi-implicit";
    all[i]->read_and_plan(companions.runs[i], scene_file);
  }
  return all;
}

/// Runs a companion, or finds that it has been run.
Ended run_companion(const Companion& companion, const Prepared& prepared, const fs::path& folder,
                    const MeasureOptions& options) {
  const Stopwatch watch;
  Ended ended{"refused", prepared.refused, folder / name_of(companion.role)};
  try {
    if (prepared.scene && finished_run(ended.directory, *prepared.scene) != Finished::no &&
        files::verify(ended.directory).differences.empty())  // nothing of it had to wait for the disk
      return {"completed", {}, ended.directory, trial::read_summary(ended.directory).at("wall_s")};
    if (!options.quiet) std::cerr << "error bar: " << companion.differs << std::endl;
    if (prepared.plan) {
      run::RunOptions run{.threads = std::clamp(prepared.scene->domain.nodes[1] / 4, 1, options.threads),
                          .quiet = true};
      run.interrupted = options.interrupted;
      files::RunDirectory directory(ended.directory, *prepared.scene, files::FormerRun::replace,
                                    files::DataFiles::tables);
      const run::Summary summary = run::simulate(*prepared.plan, {}, run, &directory);
      ended.end = summary.status;
      if (summary.failure) ended.message = summary.failure->message;
    }
  } catch (const Error& error) {
    if (error.cause() == Cause::input_output) throw;
    ended.end = "refused";
    ended.message = error.problem();
  }
  ended.wall_s = prepared.wall_s + watch.seconds();
  return ended;
}

/// Why a companion says nothing; empty: it does.
std::string why_useless(const Companion& companion, const Ended& ended) {
  if (ended.end == "completed") return {};
  return "the companion with " + companion.differs + " did not complete (" + ended.end + "): " + ended.message;
}

/// What the companions of a choice have given, one after another, until one of them says nothing.
struct Round {
  Companions companions;
  std::vector<Measured> measured;
  std::string missing;  ///< why there are no bars; empty: there are
  bool diverged = false, interrupted = false;
};

/// `listed` gets a line for each companion, `wall_s` the time that they took.
Round run_all(Companions companions, const scene::Scene& scene, const fs::path& folder, const MeasureOptions& options,
              Json& listed, double& wall_s) {
  Round round{std::move(companions), {}, {}};
  const auto prepared = prepare(round.companions, scene.document->file(), options.catalog);
  round.missing = round.companions.why_none;
  for (std::size_t i = 0; i < round.companions.runs.size() && round.missing.empty(); ++i) {
    const Companion& companion = round.companions.runs[i];
    const Ended ended = run_companion(companion, *prepared[i], folder, options);
    if (ended.end == "interrupted") {
      round.interrupted = true;
      round.missing = "interrupted";
      break;
    }
    wall_s += ended.wall_s;
    listed.push_back({{"role", name_of(companion.role)},
                      {"differs", companion.differs},
                      {"end", ended.end},
                      {"wall_s", ended.wall_s},
                      {"message", ended.message}});
    round.missing = why_useless(companion, ended);
    round.diverged = ended.end == "diverged";
    if (round.missing.empty())
      round.measured.push_back(
          {companion.role, companion.differs, reported_quantities(ended.directory, companion.beyond)});
  }
  return round;
}

/// On coarse lattices stiff cells may diverge where the fluid gives way to the shear more than a plan allows a run
/// (docs/accuracy.md, "Error bars"): companions that did are followed by others that do not let it.
Round run_until_stable(const scene::Scene& scene, const RunCost& cost, const fs::path& folder,
                       const MeasureOptions& options, Json& listed, double& wall_s) {
  Round round = run_all(choose_companions(scene, cost), scene, folder, options, listed, wall_s);
  if (!round.diverged) return round;
  Companions stiffer = choose_companions(scene, cost, plan::largest_compression_by_shear);
  const bool others = stiffer.why_none.empty() && stiffer.runs.front().scene != round.companions.runs.front().scene;
  return others ? run_all(std::move(stiffer), scene, folder, options, listed, wall_s) : round;
}

}  // namespace

Finished finished_run(const fs::path& directory, const scene::Scene& scene) {
  const Json summary = trial::read_summary(directory);
  if (!summary.is_object() || summary.value("status", "") != "completed") return Finished::no;
  if (summary.value("scene_sha256", "") != sha256_of(files::scene_text(*scene.document))) return Finished::no;
  const Json stages = summary.value("stages", Json::array());
  if (stages.empty() || stages.back().value("ended_by", "") == "max_steps") return Finished::no;
  return summary.contains("error_bars") ? Finished::with_bars : Finished::without_bars;
}

MeasuredErrors measure_errors(const fs::path& directory, const scene::Scene& scene, const MeasureOptions& options) {
  files::FileLock lock(directory);
  if (!lock.take()) {
    throw Error(Cause::bad_input, Place{directory.string()}, "another process is working in this directory",
                {"wait for it, then go on", {Way::resume}});
  }
  const Json summary = trial::read_summary(directory);
  const double run_s = summary.at("wall_s");
  RunCost cost{.run_s = run_s};
  for (const Json& pass : summary.at("passes")) {
    if (pass.at("name") == "observe and check") {
      cost.outputs_s = pass.at("wall_s");
      cost.outputs = pass.at("calls");
    }
  }
  const fs::path folder = directory / files::companions_folder;
  std::vector<Quantity> quantities = reported_quantities(directory);
  cost.moments = std::any_of(quantities.begin(), quantities.end(), [](const Quantity& q) { return q.moment; });
  MeasuredErrors errors;
  Json listed = Json::array();
  const Round round = run_until_stable(scene, cost, folder, options, listed, errors.wall_s);
  errors.missing = round.missing;
  errors.interrupted = round.interrupted;
  if (errors.interrupted) return errors;
  if (errors.missing.empty())
    errors.bars = error_bars(quantities, round.companions, round.measured);
  else
    for (Quantity& quantity : quantities) errors.bars.push_back({std::move(quantity), {}, 0, {}, errors.missing});
  errors.share = errors.wall_s / run_s;
  Json sections = {{"error_bars", to_json(errors.bars)},
                   {"error_bar_runs",
                    {{"wall_s", errors.wall_s},
                     {"share_of_run", errors.share},
                     {"missing", errors.missing.empty() ? Json() : Json(errors.missing)},
                     {"companions", listed}}},
                   {"numerics_choice", summary.value("numerics_choice", Json())}};
  add_measured(sections["numerics_choice"], worst(errors.bars));
  files::amend_summary(directory, sections);
  fs::remove_all(folder);
  return errors;
}

double refined_target(const plan::NumericsChoice& choice, const Worst& worst) {
  constexpr double spared = 0.8, least = 0.001;  // the least that a scene may ask for
  const double measured = worst.error - worst.uncertainty, left = choice.target - worst.uncertainty;
  if (!(left > 0)) return 0;
  return std::max(least, spared * std::min(choice.expected.total(), choice.target) * left / measured);
}

void add_measured(nlohmann::json& choice, const std::optional<Worst>& worst) {
  if (!choice.is_object()) return;
  choice["measured_error"] = worst ? nlohmann::json(worst->error) : nlohmann::json();
  choice["measured_of"] = worst ? nlohmann::json(worst->name) : nlohmann::json();
  if (!worst) return;
  choice["measured_shares"] = {{"resolution", worst->shares.lattice},
                               {"inertia", worst->shares.inertia},
                               {"start", worst->shares.start},
                               {"outputs", worst->uncertainty}};
}

std::optional<Worst> measured(const nlohmann::json& choice) {
  if (!choice.is_object() || !choice.contains("measured_shares")) return std::nullopt;
  const nlohmann::json& shares = choice.at("measured_shares");
  return Worst{choice.at("measured_error"),
               choice.at("measured_of"),
               {shares.at("resolution"), shares.at("start"), shares.at("inertia")},
               shares.at("outputs")};
}

}  // namespace rouleau::accuracy
