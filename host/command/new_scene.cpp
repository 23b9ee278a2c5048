#include "new_scene.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <regex>
#include <string_view>

#include "base/error.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "files/file.hpp"
#include "scene_options.hpp"
#include "templates.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

struct SceneTemplate {
  const char* name;
  const std::string_view& text;
  const std::string_view* picture = nullptr;  ///< that it names NAME.png, NAME being the template's; null: none
};

const std::array scene_templates{
    SceneTemplate{"demo", demo_scene},
    SceneTemplate{"channel", channel_scene},
    SceneTemplate{"suspension", suspension_scene},
    SceneTemplate{"suspension-3d", suspension_3d_scene},
    SceneTemplate{"capsule", capsule_scene},
    SceneTemplate{"red-cell-3d", red_cell_3d_scene},
    SceneTemplate{"doublet-3d", doublet_3d_scene},
    SceneTemplate{"tube-3d", tube_3d_scene},
    SceneTemplate{"vessel", vessel_scene},
    SceneTemplate{"drawing", drawing_scene, &drawing_picture},
};

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const SceneTemplate& entry : scene_templates) names.emplace_back(entry.name);
  return names;
}

bool is_template(const std::string& name) {
  const auto names = template_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

const SceneTemplate& template_called(const std::string& name) {
  const std::vector<std::string> names = template_names();
  for (const SceneTemplate& entry : scene_templates)
    if (name == entry.name) return entry;
  throw Error(Cause::bad_input, "rouleau new scene: there is no template " + in_quotes(name) +
                                    did_you_mean(name, names) + "\n  the templates are: " + listed(names));
}

fs::path file_of(const fs::path& folder, std::string name) {
  if (name.ends_with(".json")) name.resize(name.size() - 5);
  static const std::regex pattern("[A-Za-z0-9][A-Za-z0-9._-]{0,99}");
  if (!std::regex_match(name, pattern) || name.ends_with(".lock")) {
    throw Error(Cause::bad_input,
                "rouleau new scene: " + in_quotes(name) +
                    " cannot be the name of a scene: letters, digits, '-', '_' and '.', beginning with "
                    "a letter or digit, 100 characters at most, and not ending in .lock, as locks do"
                    "\n  another folder is chosen with --dir");
  }
  return (folder / (name + ".json")).lexically_normal();
}

void require_new(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(file, ignored))) return;
  throw Error(Cause::bad_input, Place{file.string()},
              "exists already and is left as it is; choose another name, or another place with --dir");
}

/// "three dimensions, 14 cells, about 3 min on one core": of the time nothing where models are missing.
std::string about(const fs::path& file) {
  SceneOptions options;
  options.scene = file.string();
  try {
    const PlannedScene planned(options);
    const std::size_t cells = planned.plan.scene->cells.size();
    return std::string(planned.plan.scene->domain.words().number) + " dimensions, " +
           (cells == 0 ? "no" : std::to_string(cells)) + (cells == 1 ? " cell" : " cells") + ", about " +
           time_in_words(planned.report.estimate.wall_s) + " on one core";
  } catch (const std::exception&) {
    return "not planned, because a model is missing here";
  }
}

}  // namespace

SceneWords scene_words(const std::optional<std::string>& first, const std::string& second, const std::string& name) {
  const std::string word = first.value_or("demo");
  if (!name.empty()) {
    if (!second.empty())
      throw Error(Cause::bad_input, "rouleau new scene: " + in_quotes(second) + " is one word too many beside --name");
    return {name, word};
  }
  if (second.empty()) return is_template(word) ? SceneWords{word, word} : SceneWords{word, "demo"};
  if (is_template(word) && !is_template(second)) return {second, word};
  if (is_template(word) && word != second)
    throw Error(Cause::bad_input, "rouleau new scene: both " + in_quotes(word) + " and " + in_quotes(second) +
                                      " are templates\n  write: rouleau new scene " + second + " --name " + word);
  return {word, second};
}

void new_scene(const fs::path& folder, const std::string& name, const std::string& template_name) {
  const SceneTemplate& made_from = template_called(template_name);
  const fs::path file = file_of(folder, name);
  fs::path picture = file;
  picture.replace_extension(".png");
  std::string text(made_from.text);
  if (made_from.picture != nullptr) {
    require_new(picture);
    const std::string shipped = template_name + ".png", made = picture.filename().string();
    for (std::size_t at = 0; (at = text.find(shipped, at)) != std::string::npos; at += made.size())
      text.replace(at, shipped.size(), made);
  }
  require_new(file);
  if (made_from.picture != nullptr) files::write_file(picture, std::string(*made_from.picture));
  files::write_file(file, text);
  const std::string scene = in_shell(file.string());
  std::cout << "Made " << file.string() << (made_from.picture != nullptr ? " and " + picture.string() : "")
            << " from the template " << template_name << ": " << about(file) << ". It runs as it is.\n";
  if (file.stem().string().ends_with("-3d") && !std::string_view(template_name).ends_with("-3d"))
    std::cout << "Its name ends in -3d, but it has two dimensions: rouleau new --help lists the templates in three.\n";
  const std::string meant = likely(file.stem().string(), template_names());
  if (template_name == "demo" && !meant.empty() && meant != template_name)
    std::cout << "That is its name. If a template was meant: rouleau new scene " << meant << '\n';
  std::cout << "Next:\n"
            << "  rouleau plan " << scene << "\n  rouleau run " << scene << " --out "
            << in_shell("runs/" + file.stem().string()) << '\n';
}

}  // namespace rouleau::command
