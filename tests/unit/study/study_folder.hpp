// A folder for one test's files, gone when the test is, and a small scene to vary.
#pragma once

#include <filesystem>
#include <string>

#include "json/json.hpp"
#include "scratch_folder.hpp"

namespace rouleau::test {

class StudyFolder : public ScratchFolder {
 public:
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path() / name; }
};

/// Couette flow, a few milliseconds of work.
inline nlohmann::json couette_scene() {
  return nlohmann::json::parse(R"({
    "rouleau": 1, "title": "walls that begin to move",
    "domain": {"size": ["4 um", "8 um"], "nodes": [8, 16], "x": "periodic",
               "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "inertia": false, "collision": {"model": "trt"}},
    "numerics": {"tau": 1.0},
    "stages": [{"name": "start", "shear_rate": "100 1/s", "duration": "10 us"}],
    "output": {"fields": {"seconds": "10 us", "quantities": ["velocity"]}, "checkpoint": "never"}})");
}

/// The same with a capsule of radius 1 um.
inline nlohmann::json capsule_scene() {
  nlohmann::json scene = couette_scene();
  scene["cell_types"] = nlohmann::json::parse(
      R"({"capsule": {"shape": {"circle": {"radius": "1 um"}}, "segments": 13, "membrane": []}})");
  scene["cells"] = nlohmann::json::parse(R"([{"type": "capsule", "at": ["2 um", "4 um"]}])");
  return scene;
}

}  // namespace rouleau::test
