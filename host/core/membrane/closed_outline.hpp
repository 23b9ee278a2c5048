// Loops over the nodes of one cell, where every node sees the one before and the one after it.
#pragma once

#include <rouleau/pack.hpp>

namespace rouleau::core {

/// Calls body(S, i, before, after) for packs of nodes of the outline [begin, end): S is a pack that tells how many
/// nodes from i on are meant; `before` and `after` are the neighbours of the first of them.
template <int register_bytes, class Body>
ROULEAU_ALWAYS_INLINE void for_closed_outline(int begin, int end, Body body) {
  using S = Pack<double, register_bytes / 8>;
  using One = Pack<double, 1>;
  body(One(0.0), begin, end - 1, begin + 1);
  int i = begin + 1;
  for (; i + S::size < end; i += S::size) body(S(0.0), i, i - 1, i + 1);
  for (; i + 1 < end; ++i) body(One(0.0), i, i - 1, i + 1);
  body(One(0.0), end - 1, end - 2, begin);
}

}  // namespace rouleau::core
