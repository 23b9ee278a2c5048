#include "shared_keys.hpp"

#include <cmath>

#include "base/text.hpp"
#include "matrix.hpp"
#include "scene/scene.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path scene_file_of(const json::Document& document, const fs::path& file) {
  const Json& given = document.root()["scene"];
  return given.is_string() ? file.parent_path() / given.get<std::string>() : file;
}

Json read_changed_scene(const json::Document& document, const fs::path& scene_file, const std::string& whose) {
  Json scene = document.root()["scene"];
  if (scene.is_string()) {
    if (!fs::exists(scene_file))
      throw Error(ExitCode::bad_input, document.place("/scene"),
                  "there is no scene " + scene_file.string() + "; the path begins with the " + whose + " folder");
    (void)scene::read_unpacked_scene(scene_file);
    scene = json::Document::read(scene_file).root();
  }
  if (document.root().contains("set")) put_changes(scene, document, "/set");
  return scene;
}

double read_time_limit(const json::Document& document, const std::string& example) {
  const Json& given = document.root()["time_limit"];
  double seconds = NAN;
  try {
    seconds =
        given.is_number() ? given.get<double>() : units::Units().to_si(given.get<std::string>(), "s", "time_limit");
  } catch (const units::UnitError& error) {
    throw Error(ExitCode::bad_input, document.place("/time_limit"), error.what());
  }
  if (!(seconds >= 0.001 && seconds <= 1e8))
    throw Error(ExitCode::bad_input, document.place("/time_limit"),
                number(seconds) + " s is out of range; write 1 ms to 1e8 s, for example " + in_quotes(example));
  return seconds;
}

}  // namespace rouleau::trial
