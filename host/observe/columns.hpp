// The columns of a run's tables, an entry for each.
#pragma once

#include <vector>

#include "observable.hpp"

namespace rouleau::observe {

// Of each table (observables.hpp), in their order.
std::vector<Observable> columns_of_cells();
std::vector<Observable> columns_of_aggregates();
std::vector<Observable> columns_of_series();
/// Those of series.csv that runs between openings have, and those where cells may come or leave (cell_traffic.hpp).
std::vector<Observable> columns_at_openings();
std::vector<Observable> columns_of_traffic();
std::vector<Observable> columns_of_aggregate_sizes();

}  // namespace rouleau::observe
