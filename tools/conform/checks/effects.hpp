// What a parameter of a model changes.
#pragma once

#include "trials.hpp"

namespace rouleau::conform {

/// Whether two instances give the same at inputs that are the same, for any of several time steps.
bool alike(const Subject& subject, const plugin::ModelInstance& one, const plugin::ModelInstance& other,
           Random& random);

/// Parameters and words of choices ("transverse = free") that were seen to change nothing in this dimension.
std::vector<std::string> idle_parameters_here(const Subject& subject);
/// The same, but for those for which a membrane law has a use in its other dimension, where its elements are others.
std::vector<std::string> idle_parameters(const Subject& subject);

/// Whether the check of roles measures the number itself: such a parameter needs no reference number.
bool is_measured(const plugin::Manifest& manifest, plugin::Role role);

}  // namespace rouleau::conform
