#include "shared_keys.hpp"

#include <cmath>

#include "input/scene.hpp"
#include "input/units.hpp"
#include "input/wording.hpp"
#include "matrix.hpp"

namespace rouleau::host {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path scene_file_of(const Document& document, const fs::path& file) {
  const json& given = document.root()["scene"];
  return given.is_string() ? file.parent_path() / given.get<std::string>() : file;
}

json read_changed_scene(const Document& document, const fs::path& scene_file, const std::string& whose) {
  json scene = document.root()["scene"];
  if (scene.is_string()) {
    if (!fs::exists(scene_file))
      throw Error(ExitCode::bad_input, document.place("/scene"),
                  "there is no scene " + scene_file.string() + "; the path begins with the " + whose + " folder");
    (void)read_unpacked_scene(scene_file);
    scene = Document::read(scene_file).root();
  }
  if (document.root().contains("set")) put_changes(scene, document, "/set");
  return scene;
}

double read_time_limit(const Document& document, const std::string& example) {
  const json& given = document.root()["time_limit"];
  double seconds = NAN;
  try {
    seconds = given.is_number() ? given.get<double>() : Units().to_si(given.get<std::string>(), "s", "time_limit");
  } catch (const UnitError& error) {
    throw Error(ExitCode::bad_input, document.place("/time_limit"), error.what());
  }
  if (!(seconds >= 0.001 && seconds <= 1e8))
    throw Error(ExitCode::bad_input, document.place("/time_limit"),
                number(seconds) + " s is out of range; write 1 ms to 1e8 s, for example " + in_quotes(example));
  return seconds;
}

}  // namespace rouleau::host
