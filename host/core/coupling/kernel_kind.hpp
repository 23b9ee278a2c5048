// The kernels that couple membranes and lattice.
#pragma once

namespace rouleau::core {

enum class KernelKind { peskin4, cosine4, roma3, linear2 };

}  // namespace rouleau::core
