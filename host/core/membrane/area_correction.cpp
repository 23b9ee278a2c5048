#include "area_correction.hpp"

#include <cmath>
#include <rouleau/dispatch.hpp>

#include "closed_outline.hpp"

namespace rouleau::core {

namespace {

template <class S>
ROULEAU_ALWAYS_INLINE double lane_sum(const S& values) {
  double total = 0;
  for (int k = 0; k < S::size; ++k) total += values.vector[k];
  return total;
}

struct AreaTask {
  int begin, end;
  const double *x, *y;
  double *velocity_x, *velocity_y;
  double rest_area;
  double gain;  // of area in this step without the correction
};

struct KeepArea {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(AreaTask* task) {
    const AreaTask t = *task;
    double area = 0, gain = 0, square = 0;
    for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S ax = S::load(t.y + after) - S::load(t.y + before), ay = S::load(t.x + before) - S::load(t.x + after);
      // Relative to the first node, so that a cell far from the origin keeps its digits.
      const S x = S::load(t.x + i) - t.x[t.begin], y = S::load(t.y + i) - t.y[t.begin];
      area += lane_sum(x * ax + y * ay);
      gain += lane_sum(S::load(t.velocity_x + i) * ax + S::load(t.velocity_y + i) * ay);
      square += lane_sum(ax * ax + ay * ay);
    });
    area /= 4, gain /= 2, square /= 4;
    task->gain = gain;
    const double factor = square > 0 ? 0.5 * ((t.rest_area - area) / area_relaxation_steps - gain) / square : 0;
    for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S ax = S::load(t.y + after) - S::load(t.y + before), ay = S::load(t.x + before) - S::load(t.x + after);
      (S::load(t.velocity_x + i) + factor * ax).store(t.velocity_x + i);
      (S::load(t.velocity_y + i) + factor * ay).store(t.velocity_y + i);
    });
  }
};

struct PressureTask {
  int begin, end;
  const double *x, *y;
  double *force_x, *force_y;
};

struct TakeOutPressure {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const PressureTask* task) {
    const PressureTask t = *task;
    double work = 0, square = 0;
    for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S ax = S::load(t.y + after) - S::load(t.y + before), ay = S::load(t.x + before) - S::load(t.x + after);
      work += lane_sum(S::load(t.force_x + i) * ax + S::load(t.force_y + i) * ay);
      square += lane_sum(ax * ax + ay * ay);
    });
    const double factor = square > 0 ? -work / square : 0;
    for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S ax = S::load(t.y + after) - S::load(t.y + before), ay = S::load(t.x + before) - S::load(t.x + after);
      (S::load(t.force_x + i) + factor * ax).store(t.force_x + i);
      (S::load(t.force_y + i) + factor * ay).store(t.force_y + i);
    });
  }
};

}  // namespace

void take_out_pressures(Worker worker, Membranes& membranes) {
  static const auto function = Dispatch<TakeOutPressure, const PressureTask*>::pick();
  for (const int c : membranes.own_cells(worker)) {
    const CellRange& cell = membranes.cells[c];
    const PressureTask task{cell.first,
                            cell.end(),
                            membranes.position[0].data(),
                            membranes.position[1].data(),
                            membranes.force[0].data(),
                            membranes.force[1].data()};
    function(&task);
  }
}

void keep_enclosed(Worker worker, Membranes& membranes, double strain) {
  const double kept = std::exp(-strain);
  static const auto function = Dispatch<KeepArea, AreaTask*>::pick();
  for (const int c : membranes.own_cells(worker)) {
    const CellRange& cell = membranes.cells[c];
    AreaTask task{cell.first,
                  cell.end(),
                  membranes.position[0].data(),
                  membranes.position[1].data(),
                  membranes.velocity[0].data(),
                  membranes.velocity[1].data(),
                  cell.rest_area,
                  0};
    function(&task);
    membranes.area_leakage[c] = kept * membranes.area_leakage[c] - task.gain / cell.rest_area;
  }
}

}  // namespace rouleau::core
