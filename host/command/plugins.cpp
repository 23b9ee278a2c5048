// rouleau plugins [ID]: what models were found, and everything their manifests say; --lock SCENE binds a scene to them,
// --install DIR puts more of them into the user's own folder.
#include <algorithm>
#include <iostream>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "json/json.hpp"
#include "manage_plugins.hpp"
#include "plugin/catalog.hpp"
#include "plugin/parameters.hpp"
#include "scene/named_files.hpp"

namespace rouleau::command {

namespace {

using Json = nlohmann::json;

constexpr const char* plugins_help = R"(usage: rouleau plugins [ID] [options]

Lists every model that was found, its manifest, and why others were refused.
With the ID of a model: its parameters, units, defaults and limits. No library is opened.

With --install DIR: copies the plugins of DIR, manifest and library of each, into your own folder, rouleau/plugins in
XDG_DATA_HOME or ~/.local/share, where every run finds them. They must pass the checks of "rouleau conform --level
interface", and an id must not be taken. To take one out again, delete its folder.

With --cells: lists the cells that are shipped, which a cell type takes by "from"; with the name of one its values, and
the source and the spread of each.

With --lock SCENE: writes SCENE's lock, NAME.lock.json beside NAME.json: id, kind, version and SHA-256 of library and
manifest of each plugin that the scene names. Runs and plans of the scene then refuse every other plugin.

Example:
  rouleau plugins morse
  rouleau plugins --cells human-red-cell
  rouleau plugins --lock scenes/four-cells-shear.json
  rouleau plugins --install yukawa/build
)";

/// A value as the manifest writes it: in the parameter's unit, or the word of a choice.
Json written(double si, const plugin::Parameter& parameter, const units::Units& units) {
  if (!parameter.choices.empty()) return parameter.choices.at(static_cast<std::size_t>(si));
  // Six digits hide the rounding of the way to SI and back.
  return Json::parse(number(si / units.scale(parameter.unit)));
}

Json describe(const plugin::Parameter& parameter, const units::Units& units) {
  Json entry = {{"name", parameter.name}, {"doc", parameter.doc}};
  if (parameter.choices.empty())
    entry["unit"] = parameter.unit;
  else
    entry["choices"] = parameter.choices;
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) entry[key] = written(*value, parameter, units);
  };
  add("default", parameter.default_value);
  add("minimum", parameter.minimum);
  add("exclusiveMinimum", parameter.exclusive_minimum);
  add("maximum", parameter.maximum);
  add("exclusiveMaximum", parameter.exclusive_maximum);
  if (parameter.role) entry["role"] = plugin::facts_of(*parameter.role).name;
  if (parameter.usual) {
    const auto [low, high] = *parameter.usual;
    entry["usual"] = Json::array({written(low, parameter, units), written(high, parameter, units)});
  }
  return entry;
}

std::vector<std::string> state_names(const plugin::Manifest& manifest) {
  std::vector<std::string> names;
  for (const plugin::StateVariable& variable : manifest.state) names.push_back(variable.name);
  return names;
}

Json describe(const plugin::Manifest& manifest, const units::Units& units) {
  Json parameters = Json::array();
  for (const plugin::Parameter& parameter : manifest.parameters) parameters.push_back(describe(parameter, units));
  return {{"id", manifest.id},
          {"kind", plugin::to_string(manifest.kind)},
          {"version", manifest.version},
          {"title", manifest.title},
          {"reference", manifest.reference},
          {"author", manifest.author},
          {"license", manifest.license},
          {"manifest", manifest.file.string()},
          {"library", manifest.library.string()},
          {"parameters", parameters},
          {"dimensions", manifest.dimensions},
          {"needs", manifest.needs},
          {"gives", manifest.gives},
          {"in_3d", manifest.in_3d ? Json{{"needs", manifest.in_3d->needs}, {"gives", manifest.in_3d->gives}} : Json()},
          {"state", state_names(manifest)},
          {"inactive_when", manifest.inactive_when},
          {"stands_for", manifest.stands_for},
          {"claims", manifest.claims}};
}

std::string value_text(const Json& value) { return value.is_number() ? number(value.get<double>()) : value.dump(); }

std::string limits_text(const Json& parameter) {
  std::string text;
  const auto add = [&](const char* key, const char* sign) {
    if (parameter.contains(key)) text += (text.empty() ? "" : ", ") + std::string(sign) + value_text(parameter[key]);
  };
  add("minimum", ">= ");
  add("exclusiveMinimum", "> ");
  add("maximum", "<= ");
  add("exclusiveMaximum", "< ");
  if (parameter.contains("usual")) {
    const Json& usual = parameter["usual"];
    text += (text.empty() ? "usually " : "; usually ") + value_text(usual[0]) + " to " + value_text(usual[1]);
  }
  return text;
}

void print(const plugin::Parameter& parameter, const units::Units& units) {
  const Json entry = describe(parameter, units);
  std::cout << "    " << parameter.name;
  if (!parameter.choices.empty())
    std::cout << ", one of " << listed(parameter.choices);
  else
    std::cout << (parameter.unit == "1" ? ", a number" : " in " + printable(parameter.unit));
  std::cout << (entry.contains("default") ? ", default " + value_text(entry["default"]) : ", must be given");
  if (parameter.role) std::cout << ", role " << plugin::facts_of(*parameter.role).name;
  std::cout << '\n';
  if (const std::string limits = limits_text(entry); !limits.empty()) std::cout << "        " << limits << '\n';
  if (!parameter.doc.empty()) std::cout << "        " << printable(parameter.doc) << '\n';
}

void print(const plugin::Manifest& manifest, const units::Units& units) {
  const auto line = [](const char* name, const std::string& text) {
    if (text.empty()) return;
    std::string label = name;
    label.resize(15, ' ');
    std::cout << "  " << label << printable(text) << '\n';
  };
  std::cout << manifest.id << ' ' << manifest.version << ": " << printable(manifest.title) << '\n';
  line("kind", plugin::to_string(manifest.kind));
  line("reference", manifest.reference);
  line("author", manifest.author);
  line("license", manifest.license);
  line("manifest", manifest.file.string());
  line("library", manifest.library.filename().string());
  line("dimensions", !manifest.works_in(3) ? "2" : manifest.works_in(2) ? "2 and 3" : "3");
  line("needs", listed(manifest.needs));
  line("gives", listed(manifest.gives));
  if (manifest.in_3d) {
    line("needs in 3D", listed(manifest.in_3d->needs));
    line("gives in 3D", listed(manifest.in_3d->gives));
  }
  if (!manifest.state.empty()) line("state", listed(state_names(manifest)));
  if (manifest.inactive_when.is_object()) line("inactive when", manifest.inactive_when.dump());
  if (manifest.stands_for.is_object()) line("stands for", manifest.stands_for.dump());
  if (!manifest.claims.empty()) line("claims", manifest.claims.dump());
  std::cout << "  parameters" << (manifest.parameters.empty() ? "     none\n" : "\n");
  for (const plugin::Parameter& parameter : manifest.parameters) print(parameter, units);
}

Json list(const plugin::Catalog& catalog, const std::vector<std::filesystem::path>& named, const units::Units& units) {
  Json plugins = Json::array(), refused = Json::array(), folders = Json::array();
  for (const auto& manifest : catalog.manifests()) {
    plugins.push_back(describe(manifest, units));
    plugins.back()["origin"] = plugin::origin_of(manifest.file, named);
  }
  for (const auto& entry : catalog.refused())
    refused.push_back({{"manifest", entry.file.string()}, {"id", entry.id}, {"reason", entry.reason}});
  for (const auto& folder : catalog.folders()) folders.push_back(folder.string());
  return {{"plugins", plugins}, {"refused", refused}, {"folders", folders}};
}

void print(const plugin::Catalog& catalog, const std::vector<std::filesystem::path>& named, bool paths) {
  for (const plugin::ModelKind kind :
       {plugin::ModelKind::collision, plugin::ModelKind::membrane, plugin::ModelKind::interaction}) {
    const auto ids = catalog.ids(kind);
    std::cout << plugin::to_string(kind) << (ids.empty() ? ": none\n" : "\n");
    for (const std::string& id : ids) {
      const plugin::Manifest& manifest = catalog.find(kind, id, {});
      std::string name = id + ' ' + manifest.version;
      name.resize(std::max<std::size_t>(name.size(), 24), ' ');
      std::cout << folded("  " + name + "  " + printable(manifest.title), text_width()) << '\n';
      if (paths) std::cout << "      " << manifest.file.string() << '\n';
    }
  }
  if (!catalog.refused().empty()) std::cout << "refused\n";
  for (const auto& entry : catalog.refused()) {
    std::cout << "  " << entry.file.string() << (entry.id.empty() ? "" : " (" + printable(entry.id) + ')') << '\n';
    std::string reason = "    " + entry.reason;
    for (auto end = reason.find('\n'); end != std::string::npos; end = reason.find('\n', end + 1))
      reason.insert(end + 1, "    ");
    std::cout << reason << '\n';
  }
  std::cout << "folders searched" << (catalog.folders().empty() ? ": none\n" : "\n");
  for (const auto& folder : catalog.folders())
    std::cout << "  " << folder.string() << " (" << plugin::origin_of(folder, named) << ")\n";
}

/// The manifest with an id, of any kind.
const plugin::Manifest& find(const plugin::Catalog& catalog, const std::string& id) {
  std::vector<std::string> ids;
  for (const auto& manifest : catalog.manifests()) {
    if (manifest.id == id) return manifest;
    ids.push_back(manifest.id);
  }
  const auto& refused = catalog.refused();
  if (std::any_of(refused.begin(), refused.end(), [&](const auto& entry) { return entry.id == id; }))
    return catalog.find(plugin::ModelKind::collision, id, {"rouleau plugins", {}, 0, 0});
  throw Error(Cause::bad_input, "rouleau plugins: no plugin has the id " + in_quotes(id) + did_you_mean(id, ids) +
                                    "\n  there are: " + listed(ids));
}

/// The shipped cells, or one of them with its sources.
void list_cells(const std::string& wanted, bool as_json) {
  Json all = Json::array();
  for (const std::string& name : wanted.empty() ? scene::cell_names() : std::vector{wanted}) {
    const auto [file, content] = scene::shipped_cell(name, {"rouleau plugins --cells", {}, 0, 0});
    all.push_back(content);
    all.back().update({{"name", name}, {"file", file.string()}});
    if (as_json) continue;
    std::string padded = name;
    padded.resize(std::max<std::size_t>(name.size(), 18), ' ');
    std::cout << folded(padded + printable(content["title"].get<std::string>()), text_width()) << '\n';
    if (wanted.empty()) continue;
    const Json sources = content["sources"], values = content["cell_type"];
    for (const auto& [pointer, from] : sources.items()) {
      std::cout << "  " << pointer << "  " << values.at(Json::json_pointer(pointer)).dump() << '\n';
      for (const char* key : {"source", "spread"}) {
        const std::string line = std::string("      ") + key + ": " + printable(from.at(key).get<std::string>());
        std::cout << folded(line, text_width()) << '\n';
      }
    }
  }
  if (as_json) std::cout << all.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

/// What the command is asked for, of which there can be one at a time.
void require_one(const std::vector<std::pair<std::string, bool>>& asked) {
  std::vector<std::string> given;
  for (const auto& [name, is_given] : asked)
    if (is_given) given.push_back(name);
  if (given.size() > 1) throw Error(Cause::bad_input, "rouleau plugins: give one of these alone: " + listed(given));
}

}  // namespace

int plugins_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string id, scene, out, install;
  std::vector<std::string> plugin_dirs;
  bool as_json = false, overwrite = false, paths = false, cells = false;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("id", options::value(&id), "a model, or with --cells a cell; without it all are listed");
  description.add_options()("cells", options::bool_switch(&cells), "the cells that are shipped, with their sources");
  description.add_options()("plugin-dir", options::value(&plugin_dirs)->composing()->value_name("DIR"),
                            "search this folder for plugins first (repeatable)");
  description.add_options()("paths", options::bool_switch(&paths), "also the manifest's path of each model");
  description.add_options()("json", options::bool_switch(&as_json), "print JSON for programs");
  description.add_options()("lock", options::value(&scene)->value_name("SCENE"), "write the lock of this scene")(
      "out", options::value(&out)->value_name("FILE")->notifier(not_empty("--out")), "with --lock: write it there");
  description.add_options()("install", options::value(&install)->value_name("DIR")->notifier(not_empty("--install")),
                            "copy the plugins of this folder into your own")(
      "overwrite", options::bool_switch(&overwrite), "with --install: replace those of the same id there");
  positional.add("id", 1);
  if (!parse_command_line("plugins", plugins_help, arguments, description, positional)) return 0;

  const std::vector<std::filesystem::path> named(plugin_dirs.begin(), plugin_dirs.end());
  if (cells && scene.empty() && install.empty()) {
    list_cells(id, as_json);
    return exit_code::done;
  }
  require_one({{"the ID of a model", !id.empty()},
               {"--lock", !scene.empty()},
               {"--install", !install.empty()},
               {"--cells", cells}});
  if (overwrite && install.empty())
    throw Error(Cause::bad_input, "rouleau plugins: --overwrite goes with --install DIR");
  if (!scene.empty()) {
    if (as_json)
      throw Error(Cause::bad_input, "rouleau plugins --lock SCENE goes with --plugin-dir and --out, not with --json");
    lock_scene(scene, named, out);
    return exit_code::done;
  }
  if (!out.empty()) throw Error(Cause::bad_input, "rouleau plugins: --out goes with --lock SCENE");
  const plugin::Catalog catalog(plugin::plugin_search_path(named, {}));
  if (!install.empty()) {
    install_plugins(install, catalog, overwrite);
    return exit_code::done;
  }
  const units::Units units;
  if (id.empty()) {
    if (as_json) {
      // Names of folders need not be UTF-8.
      std::cout << list(catalog, named, units).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    } else {
      print(catalog, named, paths);
    }
    return exit_code::done;
  }
  const plugin::Manifest& manifest = find(catalog, id);
  if (as_json)
    std::cout << describe(manifest, units).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  else
    print(manifest, units);
  return exit_code::done;
}

}  // namespace rouleau::command
