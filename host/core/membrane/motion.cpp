#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <rouleau/dispatch.hpp>
#include <utility>

namespace rouleau::core {

namespace {

template <int D>
struct MoveTask {
  std::array<double*, D> place;
  std::array<const double*, D> velocity;
  int begin, end;
  double largest_square;
};

template <int D>
struct Move {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(MoveTask<D>* task) {
    using S = Pack<double, register_bytes / 8>;
    const MoveTask<D> t = *task;
    S largest = 0.0, zero = 0.0;  // zero becomes NaN with the first velocity that is not finite
    int i = t.begin;
    for (; i + S::size <= t.end; i += S::size) {
      S square = S::load(t.velocity[0] + i) * S::load(t.velocity[0] + i);
      for (int k = 1; k < D; ++k) square = square + S::load(t.velocity[k] + i) * S::load(t.velocity[k] + i);
      for (int k = 0; k < D; ++k) (S::load(t.place[k] + i) + S::load(t.velocity[k] + i)).store(t.place[k] + i);
      largest = max(largest, square);
      zero += square - square;
    }
    double most = 0;
    for (int k = 0; k < S::size; ++k) most = max(most, largest.vector[k]) + zero.vector[k];
    for (; i < t.end; ++i) {
      double square = t.velocity[0][i] * t.velocity[0][i];
      for (int k = 1; k < D; ++k) square = square + t.velocity[k][i] * t.velocity[k][i];
      for (int k = 0; k < D; ++k) t.place[k][i] += t.velocity[k][i];
      most = max(most, square) + (square - square);
    }
    task->largest_square = most;
  }
};

template <int D>
void move(Worker worker, CellNodes& nodes) {
  static const auto function = Dispatch<Move<D>, MoveTask<D>*>::pick();
  for (const int c : nodes.own_cells(worker)) {
    const CellRange& cell = nodes.cells[c];
    MoveTask<D> task{.place = pointers<D>(nodes.position),
                     .velocity = pointers<D>(std::as_const(nodes.velocity)),
                     .begin = cell.first,
                     .end = cell.end(),
                     .largest_square = 0};
    function(&task);
    nodes.largest_step[c] = std::sqrt(task.largest_square);
  }
}

}  // namespace

void move_nodes(Worker worker, CellNodes& cells) {
  if (cells.position[2].empty())
    move<2>(worker, cells);
  else
    move<3>(worker, cells);
}

template <int D>
std::array<double, 3> mean_velocity(const CellNodes& cells, const Ranks<D>& ranks) {
  std::vector<ExactSum> sums(D);
  for (const int c : cells.own_cells()) {
    const CellRange& cell = cells.cells[c];
    for (std::size_t k = 0; k < D; ++k)
      sums[k].add(cells.velocity[k].data() + cell.first, static_cast<std::size_t>(cell.count));
  }
  add_up(ranks, sums);
  // Who asks on several ranks has openings nowhere, and all cells somewhere.
  const int nodes = ranks.several() ? cells.node_count() : cells.known_node_count();
  std::array<double, 3> mean{};
  for (std::size_t k = 0; k < D; ++k) mean[k] = sums[k].value() / std::max(1, nodes);
  return mean;
}

template std::array<double, 3> mean_velocity(const CellNodes&, const Ranks<2>&);
template std::array<double, 3> mean_velocity(const CellNodes&, const Ranks<3>&);

FarthestNode farthest_node(const CellNodes& cells) {
  FarthestNode farthest{0, -1};
  for (const int c : cells.own_cells()) {
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double along_z = cells.position[2].empty() ? 0 : cells.velocity[2][k];
      const double step = std::hypot(std::hypot(cells.velocity[0][k], cells.velocity[1][k]), along_z);
      if (std::isnan(step)) return {step, i};
      if (farthest.node < 0 || step > farthest.step) farthest = {step, i};
    }
  }
  return farthest;
}

double largest_step(const CellNodes& cells) {
  double largest = cells.largest_step_of_others;
  if (cells.largest_step.empty()) return largest;
  for (const int c : cells.known_cells()) {
    const double step = cells.largest_step[c];
    if (!(step <= largest)) largest = step;
    if (std::isnan(largest)) break;
  }
  return largest;
}

}  // namespace rouleau::core
