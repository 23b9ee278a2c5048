// The columns of series.csv that runs between openings have.
#pragma once

#include <vector>

#include "observable.hpp"

namespace rouleau::observe {

std::vector<Observable> columns_at_openings();

}  // namespace rouleau::observe
