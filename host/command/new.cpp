// rouleau new KIND NAME: a folder with a small model that works, or a scene, to begin one's own from.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <regex>
#include <string_view>

#include "base/installation.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "commands.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "plugin/catalog.hpp"
#include "scene_options.hpp"
#include "templates.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

constexpr const char* new_help = R"(usage: rouleau new KIND NAME [options]
       rouleau new scene [TEMPLATE] [--name NAME] [options]

Makes a folder with the source, the manifest and the CMakeLists.txt of a new model: a small one that works and passes
its conformance tests as it is, to be changed into yours. Prints the commands that build, test and use it.
KIND is collision, membrane or interaction. NAME is the model's id, a reverse domain name such as org.example.yukawa, or
a plain name; folder and files have the name of its last part. Nothing is ever overwritten. A membrane law is of
segments, in two dimensions, or with --dimensions of triangles in three, or of both.

With the KIND scene: writes a scene that runs as it is, TEMPLATE.json or NAME.json. A word that is no template's is the
name of a scene like demo. TEMPLATE is, in two dimensions,
  demo           two red cells gather and are sheared (what is taken when left out)
  channel        red cells in a channel that a pressure gradient drives
  suspension     red cells packed at random between walls that shear them
  capsule        one circular capsule in shear flow
  vessel         red cells in a vessel of any shape, which narrows
  drawing        red cells in a vessel that is drawn: beside the scene a picture, NAME.png, to draw over
and in three
  red-cell-3d    a red cell in shear flow
  doublet-3d     two red cells that stick together and are sheared
  suspension-3d  red cells packed at random between walls that shear them
  tube-3d        red cells in a tube, carried along by the flow

Example:
  rouleau new interaction org.example.yukawa
  rouleau new membrane org.example.stiff --dimensions both
  rouleau new scene suspension-3d
  rouleau new scene channel --name first
)";

struct Template {
  const char* kind;
  const char* dimensions;  ///< of a membrane law, as the option has them; others have one template
  const std::string_view& source;
  const std::string_view& manifest;
  const char* scene;
  const char* setting;  ///< of a run of that scene that uses the model
};

const std::array templates{
    Template{"collision", "", collision_source, collision_manifest, "four-cells-shear.json",
             R"(/fluid/collision={"model": "model-id"})"},
    Template{"membrane", "2", membrane_source, membrane_manifest, "four-cells-shear.json",
             R"(/cell_types/rbc/membrane/0={"model": "model-id"})"},
    Template{"membrane", "3", membrane_3d_source, membrane_3d_manifest, "capsule-3d.json",
             R"(/cell_types/capsule/membrane/0={"model": "model-id"})"},
    Template{"membrane", "both", membrane_both_source, membrane_both_manifest, "four-cells-shear.json",
             R"(/cell_types/rbc/membrane/0={"model": "model-id"})"},
    Template{"interaction", "", interaction_source, interaction_manifest, "four-cells-shear.json",
             "/interactions/0/model=model-id"},
};

/// `dimensions`: the option, empty where it is not given.
const Template& template_of(const std::string& kind, const std::string& dimensions) {
  std::vector<std::string> kinds;
  for (const Template& entry : templates) {
    if (kind == entry.kind && (dimensions.empty() || dimensions == entry.dimensions)) return entry;
    if (kinds.empty() || kinds.back() != entry.kind) kinds.emplace_back(entry.kind);
  }
  if (kind == "membrane")
    throw Error(Cause::bad_input, "rouleau new membrane: --dimensions is 2, 3 or both, not " + in_quotes(dimensions));
  kinds.emplace_back("scene");
  throw Error(Cause::bad_input, "rouleau new: there is no kind " + in_quotes(kind) + did_you_mean(kind, kinds) +
                                    "\n  there are: " + listed(kinds));
}

/// A model's id, and what its last part becomes in the files.
struct Name {
  std::string id;
  std::string file;  ///< name of folder, files and CMake target
  std::string type;  ///< name of the C++ type
};

Name checked_name(const std::string& id) {
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::bad_input, "rouleau new: " + in_quotes(id) + ' ' + problem);
  };
  // As in the schema of manifests; there a part after the first may begin with a digit, which no C++ type can.
  static const std::regex pattern("[a-z][a-z0-9]*(-[a-z0-9]+)*(\\.[a-z0-9]+(-[a-z0-9]+)*)*");
  if (id.size() > 100 || !std::regex_match(id, pattern)) {
    refuse(
        "cannot be the id of a model: lower-case letters, digits and '-', beginning with a letter, 100 characters at "
        "most; a reverse domain name has '.' between its parts, such as org.example.yukawa");
  }
  Name name{id, id.substr(id.rfind('.') + 1), {}};
  if (std::isdigit(static_cast<unsigned char>(name.file.front())) != 0)
    refuse("must have a last part that begins with a letter, because the C++ type is named after it");
  for (const char* reserved : {"all", "clean", "help", "install", "package", "rouleau", "test"})
    if (name.file == reserved) refuse("cannot be built: CMake has a target " + in_quotes(name.file) + " of its own");
  bool begins = true;
  for (const char c : name.file) {
    if (c != '-') name.type += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '-';
  }
  if (name.type.size() < 3) name.type += "Model";  // the formula's own letters
  const plugin::Catalog installed(plugin::plugin_search_path({}, {}));
  for (const plugin::Manifest& manifest : installed.manifests())
    if (manifest.id == id) refuse("is the id of a model that is installed already: " + manifest.file.string());
  return name;
}

std::string filled(std::string_view text, const Name& name) {
  std::string result(text);
  const auto replace = [&](std::string_view mark, const std::string& word) {
    for (auto at = result.find(mark); at != std::string::npos; at = result.find(mark, at + word.size()))
      result.replace(at, mark.size(), word);
  };
  replace("model-id", name.id);
  replace("model-name", name.file);
  replace("ModelType", name.type);
  return result;
}

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw Error(
      Cause::input_output, Place{path.string()},
      what + ": " + std::strerror(error) + "\n  choose a folder that exists and that you may write to with --dir");
}

/// Makes the folder with all its files, or nothing: they are written into one beside it, which then gets its name.
void make_folder(const fs::path& folder, const Template& model, const Name& name) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error))) {
    throw Error(Cause::bad_input, Place{folder.string()},
                "exists already and is left as it is; choose another name, or another place with --dir");
  }
  const fs::path partial = folder.parent_path() / ("." + name.file + '.' + std::to_string(::getpid()) + ".partial");
  if (!fs::create_directory(partial, error)) fail(folder, "cannot be made", error ? error.value() : EEXIST);
  try {
    files::write_file(partial / (name.file + ".cpp"), filled(model.source, name));
    files::write_file(partial / (name.file + ".json"), filled(model.manifest, name));
    files::write_file(partial / "CMakeLists.txt", filled(plugin_build_file, name));
    fs::rename(partial, folder, error);  // replaces nothing but an empty folder that was made in this moment
    if (error) fail(folder, "cannot be made", error.value());
  } catch (...) {
    fs::remove_all(partial, error);
    throw;
  }
}

void print_next_steps(const fs::path& folder, const Template& model, const Name& name) {
  std::error_code error;
  const fs::path& shared = installation().data;
  const bool has_sdk = fs::exists(shared / "cmake/Rouleau/RouleauConfig.cmake", error);
  const fs::path installed_scene = shared / "rouleau/scenes" / model.scene;
  const std::string scene = fs::exists(installed_scene, error) ? in_shell(installed_scene.string()) : "SCENE.json";
  const std::string source = in_shell(folder.string()), build = in_shell((folder / "build").string());
  std::cout << "Made " << folder.string() << " with " << name.file << ".cpp, " << name.file
            << ".json and CMakeLists.txt: a model that works, to be changed into yours.\n";
  if (name.id.find('.') == std::string::npos) {
    std::cout << "The id " << in_quotes(name.id)
              << " is a plain name, as shipped models have; for one that others are to use take a reverse domain name, "
                 "such as org.example."
              << name.file << ", which nobody else will choose.\n";
  }
  std::cout << "Next:\n  cmake -S " << source << " -B " << build
            << (has_sdk ? " -DCMAKE_PREFIX_PATH=" + in_shell(installation().folder.string()) : "")
            << "\n  cmake --build " << build << "\n  ctest --test-dir " << build
            << " --output-on-failure\n  rouleau run " << scene << " --plugin-dir " << build << " --set "
            << in_shell(filled(model.setting, name)) << '\n';
  if (!has_sdk) {
    std::cout << "The SDK is not beside this program: if cmake does not find Rouleau, add "
                 "-DCMAKE_PREFIX_PATH=FOLDER, where it is installed.\n";
  }
}

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
  names.reserve(scene_templates.size());
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

/// What a new scene is called, and the template it is made from.
struct SceneWords {
  std::string name, from;
};

/// What is meant by up to two words and a --name, which may be empty: a word that is a template's is the template.
/// Throws Error(bad_input) where both words are.
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

/// Writes folder/NAME.json, the template of that name, and prints what it holds and what comes next.
/// Throws Error(bad_input) for a name that is no file's, a template that there is not, and a file that is there
/// already; Error(input_output).
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

}  // namespace

int new_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string kind, second, name, dimensions, directory = ".";
  std::optional<std::string> id;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("kind", options::value(&kind)->required(),
                            "KIND (collision, membrane, interaction or scene)");
  description.add_options()("id", options::value<std::string>()->notifier([&](const std::string& word) { id = word; }),
                            "NAME, or TEMPLATE of a scene");
  description.add_options()("second", options::value(&second), "TEMPLATE of a scene whose name stands before it");
  description.add_options()("name", options::value(&name)->value_name("NAME")->notifier(not_empty("--name")),
                            "of a scene: its file's, without the ending");
  description.add_options()("dimensions", options::value(&dimensions)->value_name("N"),
                            "of a membrane law: 2 (when left out), 3 or both");
  description.add_options()("dir", options::value(&directory)->value_name("DIR")->notifier(not_empty("--dir")),
                            "make folder or scene in this folder instead of the working directory");
  positional.add("kind", 1).add("id", 1).add("second", 1);
  if (!parse_command_line("new", new_help, arguments, description, positional)) return 0;

  if (!dimensions.empty() && kind != "membrane") {
    throw Error(Cause::bad_input,
                "rouleau new " + kind + ": --dimensions is for membrane laws, whose elements differ; leave it out");
  }
  if (kind == "scene") {
    const SceneWords words = scene_words(id, second, name);
    new_scene(directory, words.name, words.from);
    return exit_code::done;
  }
  const Template& model = template_of(kind, dimensions);
  if (!id) throw Error(Cause::bad_input, "a NAME is missing", {"rouleau new --help lists the options"});
  if (!second.empty() || !name.empty()) {
    throw Error(Cause::bad_input, "rouleau new " + kind + " NAME: a template or --name, here " +
                                      in_quotes(second.empty() ? name : second) +
                                      ", is for scenes only: rouleau new scene [TEMPLATE] [--name NAME]");
  }
  const Name named = checked_name(*id);
  const fs::path folder = (fs::path(directory) / named.file).lexically_normal();
  make_folder(folder, model, named);
  print_next_steps(folder, model, named);
  return exit_code::done;
}

}  // namespace rouleau::command
