// The matrix of a study: axes of settings that change a scene, crossed with each other.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "json/document.hpp"
#include "json/json.hpp"

namespace rouleau::trial {

struct Setting {
  std::string label;
  std::vector<std::pair<std::string, nlohmann::json>> set;  ///< JSON pointer of the scene, value
  double position;  ///< number that the label stands for (SI for a quantity), NaN where it is none
  int threads = 0;  ///< of a setting that changes their number; 0: it does not
};

struct Axis {
  std::string name;
  std::vector<Setting> settings;
  bool refines = false;  ///< made by "refine" of the lattice, with or without the membranes
};

/// One index of Axis::settings for each axis.
struct Point {
  std::vector<int> setting;
};

/// The axes at `pointer` of a document that fits the schema. Settings are tried on `base_scene`, and
/// "refine" takes its nodes, segments and radii. Throws Error(bad_input) at the place of a fault, and where there would
/// be more than 10 000 points.
std::vector<Axis> read_axes(const json::Document& document, const std::string& pointer,
                            const nlohmann::json& base_scene);

/// All combinations; the last axis changes first. One point without settings where there is no axis.
std::vector<Point> cross(const std::vector<Axis>& axes);

/// The scene of a point: settings are put in in the order of the axes, so that a later one prevails. Throws
/// Error(bad_input) where one axis has taken away what another wants to change.
nlohmann::json scene_of(const nlohmann::json& base, const std::vector<Axis>& axes, const Point& point);

/// Threads that a point is run with.
int threads_of(const std::vector<Axis>& axes, const Point& point, int otherwise);

/// {"resolution": "20", "scheme": "plain"}
nlohmann::json labels_of(const std::vector<Axis>& axes, const Point& point);
/// "resolution 20, scheme plain"; "the scene" where there is no axis.
std::string name_of(const std::vector<Axis>& axes, const Point& point);

/// {"/pointer": value, ...} at `pointer` of the document put into a scene, in the text's order. Throws
/// Error(bad_input).
void put_changes(nlohmann::json& scene, const json::Document& document, const std::string& pointer);

/// The settings of the axis at `pointer`, which has "refine" (schema): factors of nodes, segments and, squared,
/// triangles, labelled by the first cell type's radius in lattice spacings, by the number of nodes across where there
/// is none, or, of membranes alone, by its segments or triangles.
std::vector<Setting> refined_settings(const json::Document& document, const std::string& pointer,
                                      const nlohmann::json& base_scene);

}  // namespace rouleau::trial
