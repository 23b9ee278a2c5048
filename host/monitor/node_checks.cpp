#include "node_checks.hpp"

#include <cmath>

#include "core/membrane/motion.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::monitor {

void locate_failure(Failure& f, const core::CellNodes& membranes, int node, double spacing) {
  const auto k = static_cast<std::size_t>(node);
  f.place = {units::coordinate(membranes.x[k] - membranes.velocity_x[k], spacing),
             units::coordinate(membranes.y[k] - membranes.velocity_y[k], spacing)};
  if (!membranes.z.empty()) f.place_z = units::coordinate(membranes.z[k] - membranes.velocity_z[k], spacing);
  for (std::size_t c = 0; c < membranes.cells.size(); ++c) {
    if (node >= membranes.cells[c].first && node < membranes.cells[c].end()) f.cell = static_cast<int>(c);
  }
}

std::optional<Failure> check_nodes(const core::CellNodes& membranes, double limit, int escaped,
                                   const plan::StageSetting& setting) {
  if (membranes.cells.empty()) return std::nullopt;
  Failure f;
  if (!(core::largest_step(membranes) <= limit)) {
    const core::FarthestNode farthest = core::farthest_node(membranes);
    const bool finite = std::isfinite(farthest.step);
    f.reason = finite ? "node_step" : "non_finite";
    f.value = farthest.step;
    f.limit = limit;
    f.message = finite ? "a membrane node moved further in one step than its limit (in lattice spacings)"
                       : "the velocity of a membrane node is no number";
    locate_failure(f, membranes, farthest.node, setting.units.length);
  } else if (escaped >= 0) {
    f.reason = "escaped";
    f.message = "a membrane node has left the domain through a wall";
    locate_failure(f, membranes, escaped, setting.units.length);
  } else {
    return std::nullopt;
  }
  f.remedy = blown_up_remedy(*setting.stage);
  return f;
}

}  // namespace rouleau::monitor
