// Limits of the method that more than the plan needs to know.
#pragma once

namespace rouleau::plan {

struct Plan;

/// Limit over value, the smallest over stages, of the stretching and bending stiffness that explicit coupling bears.
/// Infinite without membrane laws. Opens the libraries of active laws.
double explicit_margin(const Plan& plan);

/// Whether the semi-implicit step bears more than the explicit one at the scene's relaxation time.
bool semi_implicit_gains(const Plan& plan);

/// With a margin below this one `"coupling": "auto"` takes the semi-implicit step.
inline constexpr double comfortable_margin = 1.3;

/// Longest mean segment, in lattice spacings, whose nodes still hold the fluid back: beyond it the 4-point kernel lets
/// fluid pass between them, ten times more with every half spacing (measured, docs/accuracy.md).
inline constexpr double longest_segment = 2.0;

}  // namespace rouleau::plan
