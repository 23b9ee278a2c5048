#include "ghost_reach.hpp"

#include <algorithm>
#include <cmath>

#include "core/coupling/slip_constants.hpp"

namespace rouleau::core {

template <int D>
double extra_reach(const BasicSolverSetup<D>& setup) {
  double largest = 0;
  for (const CellType& type : setup.cell_types) {
    if (setup.slip_correction)
      largest = std::max(largest, std::abs(slip_constants(setup.kernel, type.viscosity_ratio, D).shift));
  }
  return largest + stencil_above(setup.kernel) - 2;
}

template double extra_reach(const BasicSolverSetup<2>&);
template double extra_reach(const BasicSolverSetup<3>&);

}  // namespace rouleau::core
