// Reads a scene whole: scene/ converts what is written, numerics that it leaves open are chosen here, and shape/ places
// the cells that it wants at random.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "numerics_choice.hpp"
#include "plugin/catalog.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"
#include "shape/packing.hpp"

namespace rouleau::plan {

struct ReadScene {
  scene::Scene scene;
  std::optional<NumericsChoice> numerics_choice;  ///< what was chosen where the scene leaves its numerics open
};

/// A scene with all values and cells; those that are placed at random have no place yet, which may take a while to
/// find. `overrides` are as for scene::read_document(). Throws Error(bad_input), or Error(input_output) when the file
/// cannot be read.
ReadScene read_unpacked_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// That scene with all cells in their places.
scene::Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same with ever tighter bounds on what is chosen until no limit is exceeded that a lower density_factor or a
/// higher resolution would keep, or the bounds do not change any more. The file is read once. `catalog_of` finds the
/// plugins of a scene that has been read. What is wrong with the models of a scene is thrown with its other faults, or
/// else by make_plan(). `watch`: told while cells are packed.
ReadScene read_within_limits(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             const std::function<plugin::Catalog(const scene::Scene&)>& catalog_of,
                             const shape::PackingWatch& watch = {});

}  // namespace rouleau::plan
