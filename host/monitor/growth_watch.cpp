#include "growth_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/membrane/motion.hpp"

namespace rouleau::monitor {

template <int D>
void GrowthWatch::note(long step, const core::CellNodes& cells, const core::Ranks<D>& ranks) {
  const double speed = core::largest_step(cells);
  if (!std::isfinite(speed)) return;
  struct Fastest {
    double step;
    int cell, rank;
  };
  Fastest fastest{-1, -1, ranks.several() ? ranks.transport->rank() : 0};
  for (const int c : cells.own_cells()) {
    if (cells.largest_step[c] > fastest.step) fastest.step = cells.largest_step[c], fastest.cell = c;
  }
  fastest = core::best_of_all(ranks, fastest, [](const Fastest& a, const Fastest& b) {
    return a.step != b.step ? a.step > b.step : a.cell < b.cell;
  });
  Excursion excursion;
  excursion.step = step;
  excursion.cell = fastest.cell;
  excursion.speed = speed;
  const core::CellRange& cell = cells.cells[excursion.cell];
  const auto part = [&](const std::vector<double>& values) {
    return core::of_rank(ranks, fastest.rank,
                         std::vector<double>(values.begin() + cell.first, values.begin() + cell.end()));
  };
  excursion.x = part(cells.position[0]);
  excursion.y = part(cells.position[1]);
  excursion.velocity_x = part(cells.velocity[0]);
  excursion.velocity_y = part(cells.velocity[1]);
  excursions_.push_back(std::move(excursion));
  level_ = 2 * speed;
}

template void GrowthWatch::note(long, const core::CellNodes&, const core::Ranks<2>&);
template void GrowthWatch::note(long, const core::CellNodes&, const core::Ranks<3>&);

void GrowthWatch::check(long step, const core::CellNodes& membranes) {
  if (membranes.largest_step.empty()) return;
  speeds_.push_back(core::largest_step(membranes));
  steps_.push_back(step);
  if (speeds_.size() > checks_kept) {
    speeds_.erase(speeds_.begin());
    steps_.erase(steps_.begin());
    std::erase_if(excursions_, [this](const Excursion& e) { return e.step < steps_.front(); });
  }
  const double calm = 2 * *std::min_element(speeds_.begin(), speeds_.end());
  const double noted = excursions_.empty() ? 0 : 2 * excursions_.back().speed;
  level_ = std::max({least_level, calm, noted});
}

bool GrowthWatch::fits(const core::CellNodes& membranes) const {
  const auto of_a_cell = [&](const Excursion& e) {
    if (e.cell < 0 || e.cell >= static_cast<int>(membranes.cells.size())) return false;
    const auto nodes = static_cast<std::size_t>(membranes.cells[e.cell].count);
    return e.x.size() == nodes && e.y.size() == nodes && e.velocity_x.size() == nodes && e.velocity_y.size() == nodes;
  };
  return steps_.size() == speeds_.size() && std::all_of(excursions_.begin(), excursions_.end(), of_a_cell);
}

}  // namespace rouleau::monitor
