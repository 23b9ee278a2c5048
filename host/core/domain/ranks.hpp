// The ranks of one simulation, and what they find out together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decomposition.hpp"
#include "exact_sum.hpp"
#include "transport.hpp"

namespace rouleau::core {

/// How the lattice is cut, and how this rank speaks to the others. Belongs to the caller.
template <int D>
struct Ranks {
  const Decomposition<D>* blocks = nullptr;
  Transport* transport = nullptr;

  [[nodiscard]] bool several() const { return blocks != nullptr && blocks->ranks() > 1; }
  /// Whether this rank is the one that what concerns the whole is gathered on.
  [[nodiscard]] bool first() const { return !several() || transport->rank() == 0; }
};

/// Values that are copied bit by bit, as a message.
template <class V>
Message message_of(std::span<const V> values) {
  Message message(values.size_bytes());
  if (!message.empty()) std::memcpy(message.data(), values.data(), message.size());
  return message;
}
template <class V>
std::vector<V> values_of(const Message& message) {
  std::vector<V> values(message.size() / sizeof(V));
  if (!message.empty()) std::memcpy(static_cast<void*>(values.data()), message.data(), message.size());
  return values;
}

// All ranks call each of these, one thread of each, in the same order. With one rank there is nothing to do.

/// Every rank's values, by rank.
template <class V, int D>
std::vector<std::vector<V>> all_of(const Ranks<D>& ranks, std::vector<V> mine) {
  if (!ranks.several()) return {std::move(mine)};
  const int own = ranks.transport->rank(), count = ranks.blocks->ranks();
  for (int to = 0; to < count; ++to) {
    if (to != own) ranks.transport->send(to, message_of(std::span<const V>(mine)));
  }
  std::vector<std::vector<V>> all(static_cast<std::size_t>(count));
  for (int from = 0; from < count; ++from) {
    if (from != own) all[from] = values_of<V>(ranks.transport->receive(from));
  }
  all[own] = std::move(mine);
  return all;
}

/// The largest of all ranks' values, one by one; infinite where one is no number. In as many rounds as the number of
/// ranks has binary digits: after round k everybody knows of 2^k ranks below (dissemination).
template <std::size_t count, int D>
std::array<double, count> largest(const Ranks<D>& ranks, std::array<double, count> values) {
  for (double& value : values) value = std::isnan(value) ? INFINITY : value;
  if (!ranks.several()) return values;
  const int own = ranks.transport->rank(), all = ranks.blocks->ranks();
  for (int far = 1; far < all; far *= 2) {
    ranks.transport->send((own + far) % all, message_of(std::span<const double>(values)));
    const std::vector<double> others = values_of<double>(ranks.transport->receive((own + all - far) % all));
    for (std::size_t k = 0; k < count; ++k) values[k] = std::max(values[k], others[k]);
  }
  return values;
}

/// Whether it is so on any rank.
template <int D>
bool any(const Ranks<D>& ranks, bool mine) {
  return largest(ranks, std::array{mine ? 1.0 : 0.0}).front() > 0;
}

/// The values of one rank, on all: down a binary tree of ranks.
template <class V, int D>
std::vector<V> of_rank(const Ranks<D>& ranks, int root, std::vector<V> mine) {
  if (!ranks.several()) return mine;
  const int all = ranks.blocks->ranks(), own = (ranks.transport->rank() - root + all) % all;  // counted from the root
  int step = 1;
  while (step < all && own % (2 * step) == 0) step *= 2;
  if (own != 0) mine = values_of<V>(ranks.transport->receive((own - step + root) % all));
  for (step /= 2; step > 0; step /= 2) {
    if (own + step < all) ranks.transport->send((own + step + root) % all, message_of(std::span<const V>(mine)));
  }
  return mine;
}
/// The text of one rank, on all.
template <int D>
std::string text_of_rank(const Ranks<D>& ranks, int root, const std::string& mine) {
  const std::vector<char> text = of_rank(ranks, root, std::vector<char>(mine.begin(), mine.end()));
  return {text.begin(), text.end()};
}
/// The values of the first rank, or its number.
template <class V, int D>
std::vector<V> of_first(const Ranks<D>& ranks, std::vector<V> mine) {
  return of_rank(ranks, 0, std::move(mine));
}
template <int D>
double of_first(const Ranks<D>& ranks, double mine) {
  return of_rank(ranks, 0, std::vector<double>{mine}).front();
}

/// That of all ranks' values which no other is better than: better(a, b) orders them. In rounds, as largest().
template <class V, int D, class Better>
V best_of_all(const Ranks<D>& ranks, V mine, Better better) {
  if (!ranks.several()) return mine;
  const int own = ranks.transport->rank(), all = ranks.blocks->ranks();
  for (int far = 1; far < all; far *= 2) {
    ranks.transport->send((own + far) % all, message_of(std::span<const V>(&mine, 1)));
    const V other = values_of<V>(ranks.transport->receive((own + all - far) % all)).front();
    if (better(other, mine)) mine = other;
  }
  return mine;
}

/// Every rank's values, one rank's after another's, on the first; nothing on the others.
template <class V, int D>
std::vector<V> to_first(const Ranks<D>& ranks, std::vector<V> mine) {
  if (!ranks.several()) return mine;
  if (!ranks.first()) {
    ranks.transport->send(0, message_of(std::span<const V>(mine)));
    return {};
  }
  for (int from = 1; from < ranks.blocks->ranks(); ++from) {
    const std::vector<V> theirs = values_of<V>(ranks.transport->receive(from));
    mine.insert(mine.end(), theirs.begin(), theirs.end());
  }
  return mine;
}

/// Up the tree to the first rank, whose values are then those of all: take_in(mine, other) makes one of two, in
/// whatever order. All have as many.
template <class V, int D, class TakeIn>
void join(const Ranks<D>& ranks, std::vector<V>& values, TakeIn take_in) {
  if (!ranks.several()) return;
  const int own = ranks.transport->rank(), all = ranks.blocks->ranks();
  int step = 1;
  for (; step < all && own % (2 * step) == 0; step *= 2) {
    if (own + step >= all) continue;
    const std::vector<V> others = values_of<V>(ranks.transport->receive(own + step));
    for (std::size_t k = 0; k < values.size(); ++k) take_in(values[k], others[k]);
  }
  if (own != 0) ranks.transport->send(own - step, message_of(std::span<const V>(values)));
}

/// Each sum over what all ranks have: up the tree to the first, and down again.
template <int D>
void add_up(const Ranks<D>& ranks, std::vector<ExactSum>& sums) {
  join(ranks, sums, [](ExactSum& sum, const ExactSum& part) { sum.add(part); });
  sums = of_first(ranks, std::move(sums));
}

/// Calls function(at, count) for each row of what a box has in common with another, in their order: where it begins
/// among the nodes of the box, row after row, and how long it is.
template <int D, class Function>
void for_common_rows(const Box<D>& box, const Box<D>& other, Function function) {
  if (!box.meets(other)) return;
  const Box<D> common = box.common(other);
  for (int i = 0; i < row_count(common); ++i) {
    const std::array<int, D - 1> row = row_of(common, i);
    std::ptrdiff_t at = 0;
    for (int k = D - 1; k > 0; --k) at = at * box.size(k) + common.begin[k] + row[k - 1] - box.begin[k];
    function(at * box.size(0) + common.begin[0] - box.begin[0], common.size(0));
  }
}

/// From the values of each block's nodes, row after row, those of each block of another cut of the same lattice.
template <class V, int D>
std::vector<V> rearrange(const Ranks<D>& ranks, const Decomposition<D>& blocks, const std::vector<V>& values) {
  const int own = ranks.transport->rank();
  const Box<D> before = ranks.blocks->domain(own).block, after = blocks.domain(own).block;
  for (const int to : blocks.meeting(before)) {
    std::vector<V> part;
    for_common_rows(before, blocks.domain(to).block, [&](std::ptrdiff_t at, int count) {
      part.insert(part.end(), values.begin() + at, values.begin() + at + count);
    });
    ranks.transport->send(to, message_of(std::span<const V>(part)));
  }
  long nodes = 1;
  for (int k = 0; k < D; ++k) nodes *= after.size(k);
  std::vector<V> rearranged(static_cast<std::size_t>(nodes));
  for (const int from : ranks.blocks->meeting(after)) {
    const std::vector<V> part = values_of<V>(ranks.transport->receive(from));
    auto next = part.begin();
    for_common_rows(after, ranks.blocks->domain(from).block, [&](std::ptrdiff_t at, int count) {
      std::copy_n(next, count, rearranged.begin() + at);
      next += count;
    });
  }
  return rearranged;
}

}  // namespace rouleau::core
