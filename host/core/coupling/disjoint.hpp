// Intervals of a row that stay apart from each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rouleau::core {

/// Adds an interval {begin, end} to others that do not touch each other; those that it touches become one with it.
template <class Interval>
void add_disjoint(std::vector<Interval>& row, Interval added) {
  for (std::size_t k = 0; k < row.size();) {
    if (row[k].end < added.begin || added.end < row[k].begin) {
      ++k;
      continue;
    }
    added = {std::min(added.begin, row[k].begin), std::max(added.end, row[k].end)};
    row[k] = row.back();
    row.pop_back();
  }
  row.push_back(added);
}

}  // namespace rouleau::core
