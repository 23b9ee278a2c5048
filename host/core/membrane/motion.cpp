#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <rouleau/dispatch.hpp>

namespace rouleau::core {

namespace {

struct MoveTask {
  double *x, *y;
  const double *velocity_x, *velocity_y;
  int begin, end;
  double largest_square;
};

struct Move {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(MoveTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const MoveTask t = *task;
    S largest = 0.0, zero = 0.0;  // zero becomes NaN with the first velocity that is not finite
    int i = t.begin;
    for (; i + S::size <= t.end; i += S::size) {
      const S u = S::load(t.velocity_x + i), v = S::load(t.velocity_y + i), square = u * u + v * v;
      (S::load(t.x + i) + u).store(t.x + i);
      (S::load(t.y + i) + v).store(t.y + i);
      largest = max(largest, square);
      zero += square - square;
    }
    double most = 0;
    for (int k = 0; k < S::size; ++k) most = max(most, largest.vector[k]) + zero.vector[k];
    for (; i < t.end; ++i) {
      const double u = t.velocity_x[i], v = t.velocity_y[i], square = u * u + v * v;
      t.x[i] += u;
      t.y[i] += v;
      most = max(most, square) + (square - square);
    }
    task->largest_square = most;
  }
};

}  // namespace

void move_nodes(Worker worker, Membranes& membranes) {
  static const auto function = Dispatch<Move, MoveTask*>::pick();
  const Range cells = worker.share(membranes.cell_count());
  for (int c = cells.begin; c < cells.end; ++c) {
    if (!membranes.owns(c)) continue;
    const CellRange& cell = membranes.cells[c];
    MoveTask task{membranes.x.data(),
                  membranes.y.data(),
                  membranes.velocity_x.data(),
                  membranes.velocity_y.data(),
                  cell.first,
                  cell.end(),
                  0};
    function(&task);
    membranes.largest_step[c] = std::sqrt(task.largest_square);
  }
}

std::array<double, 2> mean_velocity(const Membranes& membranes) {
  double u = 0, v = 0;
  for (std::size_t i = 0; i < membranes.x.size(); ++i) u += membranes.velocity_x[i], v += membranes.velocity_y[i];
  const double nodes = std::max(1, membranes.node_count());
  return {u / nodes, v / nodes};
}

FarthestNode farthest_node(const Membranes& membranes) {
  FarthestNode farthest{0, -1};
  for (int i = 0; i < membranes.node_count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double step = std::hypot(membranes.velocity_x[k], membranes.velocity_y[k]);
    if (std::isnan(step)) return {step, i};
    if (farthest.node < 0 || step > farthest.step) farthest = {step, i};
  }
  return farthest;
}

double largest_step(const Membranes& membranes) {
  double largest = 0;
  for (const double step : membranes.largest_step) {
    if (!(step <= largest)) largest = step;
    if (std::isnan(largest)) break;
  }
  return largest;
}

}  // namespace rouleau::core
