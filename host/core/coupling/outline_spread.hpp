// The loop that spreads the forces of one outline's nodes.
#pragma once

#include "stencils.hpp"

namespace rouleau::core {

/// The loop for a kernel and the processor.
template <class Kernel, class T>
void (*pick_outline_spread())(const SpreadTask<T, 2>*);

}  // namespace rouleau::core
