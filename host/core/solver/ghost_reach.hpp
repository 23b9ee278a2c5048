// How near a cell has to come for another rank to be told of it.
#pragma once

#include "core/contact/cutoffs.hpp"
#include "solver_setup.hpp"

namespace rouleau::core {

/// Spacings.
struct GhostReach {
  double lattice;      ///< of its nodes to a block: stencil, marks and viscosity
  double contact = 0;  ///< of its nodes to those of another cell; 0: cells do not act on each other
};

constexpr double lattice_reach = 8;  ///< a stencil reaches two nodes, marks and viscosity a few more, and what is
                                     ///< remembered of them is somewhat older

/// How much farther from a node its force may act than that of a kernel of four points at the node itself, spacings.
template <int D>
double extra_reach(const BasicSolverSetup<D>& setup);

template <int D>
GhostReach ghost_reach(const BasicSolverSetup<D>& setup) {
  return {.lattice = lattice_reach + extra_reach(setup), .contact = contact_reach(setup.interactions)};
}

}  // namespace rouleau::core
