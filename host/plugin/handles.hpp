// Plugins as the core takes them.
#pragma once

#include <vector>

#include "core/model/model.hpp"
#include "model.hpp"

namespace rouleau::plugin {

/// Instances of models, made for one stage. `values`: parameters in SI in the manifest's order. Throws what
/// ModelInstance throws, and Error(plugin_refused) for a law that needs what this program does not give.
core::CollisionOperator make_collision_operator(const Manifest& manifest, const std::vector<double>& values,
                                                const ModelSetting& setting);
core::MembraneLaw make_membrane_law(const Manifest& manifest, const std::vector<double>& values,
                                    const ModelSetting& setting);
core::Potential make_potential(const Manifest& manifest, const std::vector<double>& values,
                               const ModelSetting& setting);

}  // namespace rouleau::plugin
