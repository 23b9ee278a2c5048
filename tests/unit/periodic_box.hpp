// Boxes for tests in which only periods matter.
#pragma once

#include "core/domain/domain.hpp"

namespace rouleau::test {

/// Periodic along x after nx spacings, and along y where `ny` is given.
inline core::Domain<2> periodic_box(int nx, int ny = 0) { return {{nx, ny > 0 ? ny : 1}, {true, ny > 0}}; }

}  // namespace rouleau::test
