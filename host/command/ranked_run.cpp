#include "ranked_run.hpp"

#include <gnu/libc-version.h>

#include <optional>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "command/process/crew.hpp"
#include "command/process/program.hpp"
#include "files/checkpoint_file.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "plugin/library.hpp"
#include "trial/point_record.hpp"

namespace rouleau::command {

namespace {

using Json = nlohmann::json;

/// Names of files need not be UTF-8; such a one would not be found, and says so.
std::string in_one_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// What the C library chooses its variants of mathematical functions by, whose last digits differ.
std::string mathematics() {
  std::string words = std::string("glibc ") + ::gnu_get_libc_version();
#if defined(__x86_64__)
  words += __builtin_cpu_supports("fma") ? " on a processor with fma" : " on a processor without fma";
  words += __builtin_cpu_supports("avx2") ? " and avx2" : "";
#endif
  return words;
}

std::vector<Crew::Fact> facts_of(const PlannedScene& planned) {
  std::vector<Crew::Fact> facts{{"the program", trial::program_sha256()},
                                {"the C library", mathematics()},
                                {"the scene", sha256_of(files::scene_text(*planned.read.scene.document))}};
  for (const plan::PlannedModel* model : planned.plan.active_models()) {
    const plugin::Manifest& manifest = *model->manifest;
    facts.push_back({"the manifest of plugin " + manifest.id, manifest.sha256, Cause::plugin_refused});
    facts.push_back({"the library of plugin " + manifest.id, plugin::library_sha256(manifest), Cause::plugin_refused});
  }
  return facts;
}

/// This process' part. `directory`: null on all ranks but the first.
run::Summary take_part(const PlannedScene& planned, run::RunOptions options, files::RunDirectory* directory,
                       const std::filesystem::path& folder, const std::string& again) {
  run::Ranks ranks;
  if (Crew* const crew = Crew::present()) {
    options.message_library = crew->library();
    std::visit(
        [&]<int D>(const core::Decomposition<D>& blocks) {
          ranks = core::Ranks<D>{&blocks, &crew->transport()};
        },
        *planned.blocks);
  }
  try {
    return run::simulate(planned.plan, planned.report, options, directory, ranks);
  } catch (const Error& error) {
    if (error.cause() != Cause::input_output || (directory != nullptr && !directory->is_open())) throw;
    const std::string next = std::filesystem::exists(files::checkpoint_file(folder))
                                 ? "what was computed up to the last checkpoint is kept; to go on from there: "
                                 : "no checkpoint was written yet; to begin again: ";
    const std::string remedy = in_options(error.remedy());
    throw Error(error.cause(), error.place(), error.problem(),
                {remedy + (remedy.empty() ? "" : "\n  ") + next + again});
  }
}

}  // namespace

void require_same_run(const std::vector<std::string>& arguments, const PlannedScene& planned) {
  Crew* const crew = Crew::present();
  if (crew == nullptr) return;
  std::vector<Crew::Fact> facts{{"the command line", in_one_line(arguments)}};
  for (Crew::Fact& fact : facts_of(planned)) facts.push_back(std::move(fact));
  crew->require_same(facts);
}

run::Summary simulate_on_all_ranks(const SceneOptions& scene, const PlannedScene& planned,
                                   const run::RunOptions& options, files::RunDirectory& directory,
                                   const std::string& again) {
  const std::filesystem::path& folder = directory.path();
  if (Crew* const crew = Crew::present()) {
    crew->told(in_one_line({{"overrides", scene.overrides}, {"folder", folder.string()}, {"again", again}}));
    crew->require_same(facts_of(planned));
  }
  return take_part(planned, options, &directory, folder, again);
}

int follow_first_rank(const SceneOptions& scene, const PlannedScene& planned, const run::RunOptions& options) {
  Crew& crew = *Crew::present();
  while (true) {
    const Json order = Json::parse(crew.told({}));
    if (order.contains("exit_code")) return order.at("exit_code");
    std::optional<PlannedScene> other;
    SceneOptions changed = scene;
    order.at("overrides").get_to(changed.overrides);
    if (changed.overrides != scene.overrides) other.emplace(changed);
    const PlannedScene& wanted = other ? *other : planned;
    crew.require_same(facts_of(wanted));
    take_part(wanted, options, nullptr, order.at("folder").get<std::string>(), order.at("again"));
  }
}

void dismiss_other_ranks(int exit_code) {
  if (Crew* const crew = Crew::present()) crew->told(Json{{"exit_code", exit_code}}.dump());
}

}  // namespace rouleau::command
