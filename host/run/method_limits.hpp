// Limits of the method that more than the plan needs to know.
#pragma once

namespace rouleau::host {

/// Longest mean segment, in lattice spacings, whose nodes still hold the fluid back: beyond it the 4-point kernel lets
/// fluid pass between them, ten times more with every half spacing (measured, docs/accuracy.md).
inline constexpr double longest_segment = 2.0;

}  // namespace rouleau::host
