// The kernels that couple membranes and lattice.
#pragma once

#include "core/membrane/node_mobility.hpp"

namespace rouleau::core {

enum class KernelKind { peskin4, cosine4, roma3, linear2, sharp6 };

/// How far above the node below its place a membrane node's stencil reaches, and one less below it.
int stencil_above(KernelKind kernel);

/// Whether the share of a node that cells cover is smoothed before it sets the viscosity there. With the sharp kernel
/// it is not in three dimensions: what is left of the errors at viscosity ratio 5 is then half. In two, viscosities of
/// suspensions would be worse.
constexpr bool smooths_edges(KernelKind kernel, int dimension) {
  return kernel != KernelKind::sharp6 || dimension == 2;
}

/// Of the kernels for which there is a semi-implicit step; others count as peskin4.
KernelResponse kernel_response(KernelKind kernel);

}  // namespace rouleau::core
