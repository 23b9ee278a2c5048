#include "growth_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/membrane/motion.hpp"

namespace rouleau::monitor {

void GrowthWatch::note(long step, const core::CellNodes& membranes) {
  const double speed = core::largest_step(membranes);
  if (!std::isfinite(speed)) return;
  const auto fastest = std::max_element(membranes.largest_step.begin(), membranes.largest_step.end());
  Excursion excursion;
  excursion.step = step;
  excursion.cell = static_cast<int>(fastest - membranes.largest_step.begin());
  excursion.speed = speed;
  const core::CellRange& cell = membranes.cells[excursion.cell];
  const auto part = [&cell](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + cell.first, values.begin() + cell.end());
  };
  excursion.x = part(membranes.x);
  excursion.y = part(membranes.y);
  excursion.velocity_x = part(membranes.velocity_x);
  excursion.velocity_y = part(membranes.velocity_y);
  excursions_.push_back(std::move(excursion));
  level_ = 2 * speed;
}

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
