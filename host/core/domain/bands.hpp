// What all ranks have of the lattice, on the first rank, a few rows at a time: so that nobody holds all of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <set>
#include <vector>

#include "ranks.hpp"

namespace rouleau::core {

/// Rows of the lattice that are wanted at once: boxes that reach all along its first axis. Their nodes count box after
/// box, and in a box row after row.
template <int D>
using Band = std::vector<Box<D>>;

/// One band after another; the same on all ranks.
template <int D>
struct Bands {
  int count = 0;
  std::function<Band<D>(int b)> band;  ///< number b of them; they may overlap
};

/// What the values of a band take, about.
inline constexpr std::size_t band_bytes = std::size_t{1} << 21;
/// How many rows of so many bytes make a band: at least one.
inline int rows_of_band(std::size_t bytes_of_row, std::size_t bytes_of_band = band_bytes) {
  return static_cast<int>(std::max<std::size_t>(1, bytes_of_band / std::max<std::size_t>(1, bytes_of_row)));
}

/// These rows of a lattice of that size, numbered over its second axis, then over the third; in rising order.
template <int D>
Band<D> band_of_rows(const std::array<int, D>& size, const std::vector<int>& rows) {
  const Box<D> lattice{{}, size};
  Band<D> band;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::array<int, D - 1> row = row_of(lattice, rows[i]);
    if (i > 0 && rows[i] == rows[i - 1] + 1 && row[0] > 0) {
      ++band.back().end[1];
      continue;
    }
    Box<D>& box = band.emplace_back();
    box.end[0] = size[0];
    for (int k = 1; k < D; ++k) box.begin[k] = row[k - 1], box.end[k] = row[k - 1] + 1;
  }
  return band;
}

/// The whole lattice, some rows at a time: as many as make a band of values that take so many bytes in each node.
template <int D>
Bands<D> bands_of_all(const std::array<int, D>& size, std::size_t bytes_of_node,
                      std::size_t bytes_of_band = band_bytes) {
  const int rows = rows_of_band(static_cast<std::size_t>(size[0]) * bytes_of_node, bytes_of_band);
  const int all = row_count(Box<D>{{}, size});
  return {(all - 1) / rows + 1, [=](int b) {
            std::vector<int> wanted;
            for (int i = b * rows; i < all && i - b * rows < rows; ++i) wanted.push_back(i);
            return band_of_rows<D>(size, wanted);
          }};
}

/// Bands for which a rank gives its part before the first rank has asked for more.
inline constexpr int bands_ahead = 3;

/// Calls take(b, values) for one band after another on the first rank, with a vector<V> of the values of all its nodes,
/// which is used again for the next band. copy(i, to) writes row i of the rank's block, a value for each of its nodes.
/// All ranks call it together, one thread of each; `domain` is this rank's, as in Ranks::blocks. No rank holds more
/// than some bands at a time: one that computes faster than the first rank writes waits for it.
template <class V, int D, class Copy, class Take>
void gather_bands(const Ranks<D>& ranks, const Domain<D>& domain, const Bands<D>& bands, Copy copy, Take take) {
  const Box<D>& own = domain.block;
  std::vector<V> values;
  if (!ranks.first()) {
    int sent = 0;
    for (int b = 0; b < bands.count; ++b) {
      values.clear();
      for (const Box<D>& box : bands.band(b)) {
        for_common_rows(own, box, [&](std::ptrdiff_t at, int count) {
          values.resize(values.size() + static_cast<std::size_t>(count));
          copy(static_cast<int>(at / count), values.data() + values.size() - count);
        });
      }
      if (values.empty()) continue;
      if (++sent > bands_ahead) static_cast<void>(ranks.transport->receive(0));
      ranks.transport->send(0, message_of(std::span<const V>(values)));
    }
    for (int k = std::min(sent, bands_ahead); k > 0; --k) static_cast<void>(ranks.transport->receive(0));
    return;
  }
  for (int b = 0; b < bands.count; ++b) {
    const Band<D> band = bands.band(b);
    std::vector<std::size_t> first{0};  // node of each box
    std::set<int> others;
    for (const Box<D>& box : band) {
      first.push_back(first.back() + static_cast<std::size_t>(box.size(0)) * static_cast<std::size_t>(row_count(box)));
      if (!ranks.several()) continue;
      for (const int rank : ranks.blocks->meeting(box)) others.insert(rank);
    }
    values.resize(first.back());
    for (std::size_t k = 0; k < band.size(); ++k) {
      std::vector<int> rows;
      for_common_rows(own, band[k],
                      [&](std::ptrdiff_t at, int count) { rows.push_back(static_cast<int>(at / count)); });
      auto row = rows.begin();
      for_common_rows(band[k], own, [&](std::ptrdiff_t at, int) { copy(*row++, values.data() + first[k] + at); });
    }
    for (const int rank : others) {
      if (rank == 0) continue;
      const std::vector<V> part = values_of<V>(ranks.transport->receive(rank));
      auto from = part.begin();
      for (std::size_t k = 0; k < band.size(); ++k) {
        for_common_rows(band[k], ranks.blocks->domain(rank).block, [&](std::ptrdiff_t at, int count) {
          std::copy_n(from, count, values.begin() + static_cast<std::ptrdiff_t>(first[k]) + at);
          from += count;
        });
      }
      ranks.transport->send(rank, {});
    }
    take(b, static_cast<const std::vector<V>&>(values));
  }
}

}  // namespace rouleau::core
