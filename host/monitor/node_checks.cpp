#include "node_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/membrane/motion.hpp"
#include "json/json.hpp"
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
  for (const int c : cells.known_cells())
    if (node >= cells.cells[c].first && node < cells.cells[c].end()) found.cell = c;
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

/// What a check says of a failure; mode and time come later. CBOR holds every number to its last bit.
std::vector<std::uint8_t> packed(const Failure& f) {
  const std::vector<double> place(f.place.begin(), f.place.end());
  return nlohmann::json::to_cbor({f.reason, place, f.cell, f.value, f.limit, f.message, f.remedy});
}

Failure unpacked(const std::vector<std::uint8_t>& bytes) {
  const nlohmann::json text = nlohmann::json::from_cbor(bytes);
  Failure f;
  f.reason = text.at(0), f.cell = text.at(2), f.value = text.at(3), f.limit = text.at(4);
  f.message = text.at(5), f.remedy = text.at(6);
  const std::vector<double> place = text.at(1);
  f.place = scene::Vector::filled(static_cast<int>(place.size()), 0);
  std::copy(place.begin(), place.end(), f.place.begin());
  return f;
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

template <int D>
std::optional<Failure> first_failure(const core::Ranks<D>& ranks, std::optional<Failure> mine,
                                     std::array<double, 2> order) {
  if (!ranks.several()) return mine;
  struct Found {
    bool any;
    std::array<double, 2> order;
    int rank;
  };
  const Found first =
      core::best_of_all(ranks, Found{mine.has_value(), order, ranks.transport->rank()},
                        [](const Found& a, const Found& b) { return a.any && (!b.any || a.order < b.order); });
  if (!first.any) return std::nullopt;
  return unpacked(core::of_rank(ranks, first.rank, mine ? packed(*mine) : std::vector<std::uint8_t>{}));
}

template std::optional<Failure> first_failure(const core::Ranks<2>&, std::optional<Failure>, std::array<double, 2>);
template std::optional<Failure> first_failure(const core::Ranks<3>&, std::optional<Failure>, std::array<double, 2>);

}  // namespace rouleau::monitor
