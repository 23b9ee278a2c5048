// A scene that leaves its numerics open, read so that it keeps the limits of its plan.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "plugin/catalog.hpp"
#include "scene/scene.hpp"

namespace rouleau::plan {

/// read_scene() with ever tighter bounds until no limit is exceeded that a lower density_factor or a higher resolution
/// would keep, or the bounds do not change any more. A scene that pins its numerics is read once. `catalog_of` finds
/// the plugins of a scene that has been read.
scene::Scene read_within_limits(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                                const std::function<plugin::Catalog(const scene::Scene&)>& catalog_of);

}  // namespace rouleau::plan
