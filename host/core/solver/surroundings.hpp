// What the owners of cells see of the cells around them, where the state is observed.
#pragma once

#include <vector>

#include "cell_exchange.hpp"

namespace rouleau::core {

/// Besides the cells that a step needs owners get to see those within any reach, until this is over. Made by one worker
/// on all ranks, where the state may be observed; with one rank it knows all cells anyway, and nothing is done.
template <int D>
class Surroundings {
 public:
  using Cells = typename CellExchange<D>::Cells;

  /// Of the only rank.
  explicit Surroundings(const Cells& cells) : cells_(cells), boxes_(boxes_of_known<D>(cells)) {}
  /// `exchange` of these cells, whose messages have been taken. Both outlive this.
  Surroundings(Cells& cells, const CellExchange<D>& exchange);
  /// This rank forgets the cells that it does not need.
  ~Surroundings();
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

  /// After it this rank knows every cell whose box comes within the reach of that of one of its own which is open, on
  /// all ranks together; along each axis (distance_along_axes). `open`: of each own cell; empty: all are. False, and
  /// nothing done, where no cell of any rank is open.
  bool show(double reach, const std::vector<char>& open = {});

  [[nodiscard]] const Cells& cells() const { return cells_; }
  /// Of all cells.
  [[nodiscard]] const std::vector<BoundingBox<D>>& boxes() const { return boxes_; }
  /// Many, or the only one.
  [[nodiscard]] Ranks<D> ranks() const { return exchange_ != nullptr ? exchange_->ghosts().ranks() : Ranks<D>{}; }

 private:
  const Cells& cells_;
  Cells* seen_ = nullptr;  ///< the same
  const CellExchange<D>* exchange_ = nullptr;
  std::vector<BoundingBox<D>> boxes_;
  std::vector<int> shown_;  ///< cells that this rank does not know without it
};

extern template class Surroundings<2>;
extern template class Surroundings<3>;

}  // namespace rouleau::core
