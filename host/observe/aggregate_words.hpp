// Aggregates as a reader says them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rouleau::observe {

/// "rouleaux of 3 and 2 cells and 1 single cell", the largest first; of more than four rouleaux the number and range;
/// "4 single cells" where there is none. sizes: number of cells of each aggregate, in any order, single cells included.
std::string aggregates_in_words(std::vector<std::size_t> sizes);

}  // namespace rouleau::observe
