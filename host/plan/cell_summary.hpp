// What a plan and a summary say about the cells of a scene: their hematocrit, and which were packed at random.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/scene.hpp"

namespace rouleau::plan {

/// Share of the domain's area that all cells enclose at rest.
double hematocrit(const scene::Scene& scene);

/// [{cells, type, pointer, count, hematocrit_asked (null: a count was), hematocrit, seed, gap_m}], one for each entry
/// with "random"; cells: numbers of the first and the last.
nlohmann::json packing_table(const scene::Scene& scene);

}  // namespace rouleau::plan
