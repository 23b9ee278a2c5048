#include "node_checks.hpp"

#include <cmath>

#include "core/membrane/motion.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::monitor {

namespace {

/// The node of one of this rank's cells, before its last step; -1: none.
FoundNode found(const core::CellNodes& cells, int node, double step) {
  FoundNode found{.step = step, .node = node, .cell = -1, .place = {}};
  if (node < 0) return found;
  const auto k = static_cast<std::size_t>(node);
  found.place = {cells.position[0][k] - cells.velocity[0][k], cells.position[1][k] - cells.velocity[1][k],
                 cells.position[2].empty() ? 0 : cells.position[2][k] - cells.velocity[2][k]};
  for (const int c : cells.known_cells()) {
    if (node >= cells.cells[c].first && node < cells.cells[c].end()) found.cell = c;
  }
  return found;
}

bool is_node(const FoundNode& found) { return found.node >= 0; }

/// The first node that has left the domain.
template <int D>
FoundNode escaped_node(const core::AnySolver<D>& solver) {
  return core::best_of_all(
      solver.ranks(), found(solver.cells(), solver.escaped_node(), 0),
      [](const FoundNode& a, const FoundNode& b) { return is_node(a) && (!is_node(b) || a.node < b.node); });
}

}  // namespace

template <int D>
FoundNode farthest_node(const core::CellNodes& cells, const core::Ranks<D>& ranks) {
  const core::FarthestNode own = core::farthest_node(cells);
  // Of steps that are no numbers, and of equal ones, the first.
  return core::best_of_all(ranks, found(cells, own.node, own.step), [](const FoundNode& a, const FoundNode& b) {
    if (!is_node(a) || !is_node(b)) return is_node(a) && !is_node(b);
    if (std::isnan(a.step) || std::isnan(b.step)) return std::isnan(a.step) && (!std::isnan(b.step) || a.node < b.node);
    return a.step != b.step ? a.step > b.step : a.node < b.node;
  });
}

template FoundNode farthest_node(const core::CellNodes&, const core::Ranks<2>&);
template FoundNode farthest_node(const core::CellNodes&, const core::Ranks<3>&);

template <int D>
void locate_failure(Failure& f, const FoundNode& node, double spacing) {
  f.place = in_metres(node.place, D, spacing);
  f.cell = node.cell;
}

template void locate_failure<2>(Failure&, const FoundNode&, double);
template void locate_failure<3>(Failure&, const FoundNode&, double);

template <int D>
std::optional<Failure> check_nodes(const core::AnySolver<D>& solver, double limit, const scene::StageSetting& setting) {
  const core::CellNodes& cells = solver.cells();
  if (cells.cells.empty()) return std::nullopt;
  Failure f;
  if (!(core::largest_step(cells) <= limit)) {
    const FoundNode farthest = farthest_node(cells, solver.ranks());
    const bool finite = std::isfinite(farthest.step);
    f.reason = finite ? "node_step" : "non_finite";
    f.value = farthest.step;
    f.limit = limit;
    f.message = finite ? "a membrane node moved further in one step than its limit (in lattice spacings)"
                       : "the velocity of a membrane node is no number";
    locate_failure<D>(f, farthest, setting.units.length);
  } else if (solver.escaped()) {
    f.reason = "escaped";
    f.message = "a membrane node has left the domain through a wall";
    locate_failure<D>(f, escaped_node(solver), setting.units.length);
  } else {
    return std::nullopt;
  }
  f.remedy = blown_up_remedy(*setting.stage);
  return f;
}

template std::optional<Failure> check_nodes(const core::AnySolver<2>&, double, const scene::StageSetting&);
template std::optional<Failure> check_nodes(const core::AnySolver<3>&, double, const scene::StageSetting&);

}  // namespace rouleau::monitor
