#include "checkpoint_match.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <rouleau/dispatch.hpp>
#include <vector>

#include "json/document.hpp"
#include "observe/observables.hpp"
#include "observe/observer.hpp"
#include "plan/placed_cells.hpp"
#include "plugin/library.hpp"
#include "provenance.hpp"

namespace rouleau::run {

namespace {

using Json = nlohmann::json;

Json plugin_facts(const plugin::Manifest& m) {
  Json state = Json::array();
  for (const plugin::StateVariable& variable : m.state)
    state.push_back({{"name", variable.name}, {"unit", variable.unit}});
  return {{"id", m.id},
          {"version", m.version},
          {"kind", plugin::to_string(m.kind)},
          {"sha256", plugin::library_sha256(m)},
          {"state", state}};
}

std::string in_short(const Json& value) {
  constexpr std::size_t most = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

/// A part of the scene that decides what is written or when a stage ends, and not what a state means.
bool is_harmless(const std::string& pointer, int stage) {
  for (const char* part :
       {"/title", "/notes", "/expected", "/output", "/checks", "/at_rest", "/equilibrium", "/plugin_dirs"})
    if (pointer == part || pointer.starts_with(std::string(part) + "/")) return true;
  if (pointer.ends_with("/file")) return true;  // its hash stands beside it
  const std::string stages = "/stages/";
  if (!pointer.starts_with(stages)) return false;
  if (pointer == stages + "-") return true;
  const std::size_t end = pointer.find('/', stages.size());
  const int changed = std::stoi(pointer.substr(stages.size(), end - stages.size()));
  if (changed != stage) return changed > stage;
  const std::string key = end == std::string::npos ? "" : pointer.substr(end + 1);
  return key == "name" || key == "duration" || key == "strain" || key == "until";
}

void compare_scenes(const Json& then, const Json& now, int stage, std::vector<Difference>& differences) {
  for (const Json& change : Json::diff(then, now)) {
    const std::string pointer = change.at("path"), operation = change.at("op");
    const Json::json_pointer place(pointer);
    std::string what = pointer + ": ";
    what += operation == "add" ? "not in the checkpoint's scene" : in_short(then.at(place)) + " in the checkpoint";
    what += operation == "remove" ? ", not there now" : ", " + in_short(change.at("value")) + " now";
    differences.push_back({what, is_harmless(pointer, stage)});
  }
}

void compare_plugins(const Json& then, const plan::Plan& plan, std::vector<Difference>& differences) {
  std::map<std::string, Json> now;
  for (const plan::PlannedModel* model : plan.active_models())
    now[model->manifest->id] = plugin_facts(*model->manifest);
  for (const Json& plugin : then) {
    const std::string id = plugin.at("id");
    const auto found = now.find(id);
    if (found == now.end()) continue;  // then the scenes differ too
    const Json& present = found->second;
    if (plugin.at("sha256") == present.at("sha256")) continue;
    const auto named = [](const Json& p) {
      return p.at("version").get<std::string>() + " (sha256 " + p.at("sha256").get<std::string>().substr(0, 12) +
             "...)";
    };
    const bool same_state = plugin.at("state") == present.at("state");
    differences.push_back({"plugin " + id + ": " + named(plugin) + " in the checkpoint, " + named(present) + " now" +
                               (same_state ? "" : ", which remembers other things"),
                           same_state});
  }
}

Error refusal(const std::filesystem::path& file, const Json& facts, const std::vector<Difference>& differences,
              bool harmless) {
  std::string text = "belongs to a run that differs from this one (step " +
                     std::to_string(facts.at("step").get<long>()) + ", written " +
                     facts.at("written").get<std::string>() + "):";
  for (const Difference& difference : differences)
    text += "\n    " + difference.what + (harmless || difference.harmless ? "" : "   [changes what the state means]");
  Remedy remedy{"none of this changes what the state means: the run can go on all the same", {Way::accept}};
  if (!harmless)
    remedy = {"go on with what the checkpoint was made with (its scene is " +
                  (file.parent_path() / "scene.json").string() + "), choose another directory, or begin anew",
              {Way::elsewhere, Way::anew}};
  return {Cause::bad_input, Place{file.string()}, text, remedy};
}

template <int D>
Json markers(const plan::Plan& plan) {
  observe::Observer observer(*plan.scene);
  plan::for_each_cell<D>(*plan.scene, scene::lattice_spacing(*plan.scene),
                         [&](std::size_t, const core::Cells<D>& cell) { observer.begin_with(cell); });
  return Json(observer).at("marker_");
}

/// Whether the means of a column have been kept since there are openings.
bool is_new(const observe::Observable& column) { return column.at_openings || column.name == "discharge_hematocrit"; }

void complete_values(Json& values) {
  std::vector<double> complete;
  std::size_t next = 0, columns = 0;
  for (const observe::Observable& column : observe::table("series").observables) {
    if (!column.has_means) continue;
    ++columns;
    const bool missing = is_new(column) || next >= values.size();
    complete.push_back(missing ? std::numeric_limits<double>::quiet_NaN() : values[next++].get<double>());
  }
  if (values.size() < columns && next == values.size()) values = complete;
}

/// Takes note of how the checkpoint's run differs from this one, or refuses it.
void accept_differences(Resumption& resumption, const plan::Plan& plan, bool force) {
  const files::CheckpointReader& checkpoint = *resumption.checkpoint;
  const Json facts = checkpoint.facts();
  const std::vector<Difference> found = differences(facts, plan, facts.at("stage"));
  const bool harmless = std::all_of(found.begin(), found.end(), [](const Difference& d) { return d.harmless; });
  if (!found.empty() && !(harmless && force)) throw refusal(checkpoint.path(), facts, found, harmless);
  for (const Difference& difference : found) resumption.accepted.push_back(difference.what);
}

}  // namespace

Json checkpoint_facts(const plan::Plan& plan, const RunState& state, int threads) {
  const scene::StageSetting& setting = plan.stages[state.stage];
  Json plugins = Json::array();
  for (const plan::PlannedModel* model : plan.active_models()) plugins.push_back(plugin_facts(*model->manifest));
  return {{"program", program_version()},
          {"written", present_time()},
          {"threads", threads},
          {"instruction_set", name_of(instruction_set())},
          {"stage", state.stage},
          {"stage_name", setting.stage->name},
          {"step", state.steps},
          {"time_s", state.time_at(setting)},
          {"strain", state.strain_at(setting)},
          {"scene", plan.scene->document->root()},
          {"plugins", plugins}};
}

std::vector<Difference> differences(const Json& facts, const plan::Plan& plan, int stage) {
  std::vector<Difference> found;
  compare_scenes(facts.at("scene"), plan.scene->document->root(), stage, found);
  const std::string program = facts.at("program");
  if (program != program_version())
    found.push_back({"program: " + program + " in the checkpoint, " + program_version() + " now", true});
  const std::string present = name_of(instruction_set()), set = facts.value("instruction_set", present);
  if (set != present)
    found.push_back({"instruction set: " + set + " in the checkpoint, " + present + " now: last digits differ", true});
  compare_plugins(facts.at("plugins"), plan, found);
  return found;
}

Resumption open_checkpoint(const std::filesystem::path& directory, const plan::Plan& plan, bool force) {
  Resumption resumption;
  const Remedy begin_anew{"begin anew", {Way::anew}};
  const auto last = files::checkpoint_file(directory), previous = files::previous_checkpoint_file(directory);
  try {
    resumption.checkpoint = std::make_unique<files::CheckpointReader>(last);
  } catch (const Error& error) {
    if (error.cause() != Cause::input_output) throw;
    resumption.damage = error.what();
    if (!std::filesystem::exists(previous)) {
      throw Error(error.cause(), error.place(), error.words() + "\n  and there is none before it to go on from",
                  begin_anew);
    }
    try {
      resumption.checkpoint = std::make_unique<files::CheckpointReader>(previous);
    } catch (const Error& second) {
      throw Error(error.cause(), error.place(), error.words() + "\n" + second.what() + "\n  no checkpoint can be used",
                  begin_anew);
    }
  }
  try {
    accept_differences(resumption, plan, force);
  } catch (const Json::exception& error) {
    resumption.checkpoint->refuse(error.what());
  }
  return resumption;
}

void complete_former_traffic(Json& run, Json& traffic) {
  Json& cells = traffic.at("cells");
  if (cells.contains("before_")) return;
  run.at("observer")["initial_mass_"] = std::numeric_limits<double>::quiet_NaN();
  cells["before_"] = {Json::array(), Json::array()};
  if (cells.at("stages_").empty()) return;
  for (const int end : {0, 1})
    for (const Json& opening : cells["stages_"].back().at("ends").at(end))
      cells["before_"][end].push_back(opening.at("flow"));
}

template <int D>
void complete_former_state(Json& run, const plan::Plan& plan) {
  Json &observer = run.at("observer"), &history = run.at("history");
  if (!observer.contains("marker_")) observer["marker_"] = markers<D>(plan);
  if (!history.contains("count_")) {
    const Json& events = history.at("events_");
    history["count_"] = events.empty() ? Json(0) : events.back().at("count");
  }
  for (Json& stage : run.at("rheology").at("stages_")) {
    for (Json& instant : stage.at("instants")) {
      complete_values(instant.at("values"));
      if (instant.contains("cell")) continue;
      std::vector<int> cells(instant.at("label").size());
      std::iota(cells.begin(), cells.end(), 0);
      instant["cell"] = cells;
    }
  }
}

template void complete_former_state<2>(Json&, const plan::Plan&);
template void complete_former_state<3>(Json&, const plan::Plan&);

}  // namespace rouleau::run
