#include "new_scene.hpp"

#include <array>
#include <iostream>
#include <regex>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "files/file.hpp"
#include "templates.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

struct SceneTemplate {
  const char* name;
  const std::string_view& text;
};

const std::array scene_templates{
    SceneTemplate{"demo", demo_scene},
    SceneTemplate{"channel", channel_scene},
    SceneTemplate{"suspension", suspension_scene},
    SceneTemplate{"suspension-3d", suspension_3d_scene},
    SceneTemplate{"capsule", capsule_scene},
};

std::string_view text_of(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneTemplate& entry : scene_templates) {
    if (name == entry.name) return entry.text;
    names.emplace_back(entry.name);
  }
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

}  // namespace

void new_scene(const fs::path& folder, const std::string& name, const std::string& template_name) {
  const std::string_view text = text_of(template_name);
  const fs::path file = file_of(folder, name);
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(file, ignored))) {
    throw Error(Cause::bad_input, Place{file.string()},
                "exists already and is left as it is; choose another name, or another place with --dir");
  }
  files::write_file(file, std::string(text));
  const std::string scene = in_shell(file.string());
  std::cout << "Made " << file.string() << ": a scene that runs as it is, with notes on what to change.\nNext:\n"
            << "  rouleau plan " << scene << "\n  rouleau run " << scene << " --out "
            << in_shell("runs/" + file.stem().string()) << '\n';
}

}  // namespace rouleau::command
