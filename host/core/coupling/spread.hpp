// The loop that spreads the forces of one cell's nodes.
#pragma once

#include <cstddef>

#include "core/domain/domain.hpp"

namespace rouleau::core {

constexpr int outside = -1000000;  // row of a node whose stencil is not on the lattice

/// Base nodes and what is kept of the weights (kernel.hpp): written by Locate, read by the others.
template <class Integer, class Number>
struct Stencils {
  Integer *column, *row;
  Number *p_x, *q_x, *p_y, *q_y;
};
template <class T>
using KnownStencils = Stencils<const int, const T>;

template <class T>
struct SpreadTask {
  KnownStencils<T> at;
  const double *force_x, *force_y;
  int begin, end;  // nodes of one cell
  const Domain<2>* domain;
  int row_begin, row_end;  // the rows of the lattice that are added to
  T *origin_x, *origin_y;  // where node (0, 0) of the lattice lies, or would lie if it belonged to the block
  std::ptrdiff_t stride;   // from one row to the next, the same in both
};

/// The loop for a kernel and the processor.
template <class Kernel, class T>
void (*pick_spread())(const SpreadTask<T>*);

}  // namespace rouleau::core
