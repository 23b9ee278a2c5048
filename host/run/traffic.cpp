#include "traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "shape/extent.hpp"

namespace rouleau::run {

namespace {

constexpr int lower_end = 0, upper_end = 1;
constexpr int most_looks_in_vain = 100;

}  // namespace

template <int D>
Traffic<D>::Traffic(const plan::Plan& plan, Engine<D>& engine, RunState& state)
    : plan_(plan), engine_(engine), state_(state) {
  if (!is_open()) return;
  state.traffic.cells_of_scene = plan.scene->cells.size();
  for (const scene::CellType& type : plan.scene->cell_types) content_.push_back(shape::enclosed_by(type));
  for (std::size_t c = 0; c < plan.scene->placed().size(); ++c) {
    state.traffic.cells.came(static_cast<int>(c), content_[plan.scene->cells[c].type], 0,
                             observe::CellTraffic::no_opening);
  }
}

template <int D>
const Inflow<D>& Traffic<D>::inflow() {
  if (!inflow_ || of_stage_ != state_.stage) inflow_.emplace(plan_, state_.stage, engine_.solver().setup());
  of_stage_ = state_.stage;
  return *inflow_;
}

template <int D>
bool Traffic<D>::due() {
  TrafficState& traffic = state_.traffic;
  if (!is_open() || state_.steps < traffic.next) return false;
  traffic.next = state_.steps + steps_to_next();
  change_ = {};
  find_gone();
  find_come(state_.time_at(plan_.stages[state_.stage]));
  return change_.any();
}

template <int D>
void Traffic<D>::find_gone() {
  constexpr double below_arrivals = 1.5;  // spacings: what has just come does not go
  std::vector<int> mine;
  const auto& cells = engine_.cells();
  for (const int c : cells.own_cells()) {
    const core::BoundingBox<D> box = core::box_of<D>(cells, c);
    const bool at_upper = box.most[0] > inflow().highest(),
               at_lower = box.least[0] < inflow().lowest() - below_arrivals;
    if (at_upper || at_lower) mine.push_back(at_upper ? c : ~c);
  }
  for (const std::vector<int>& of_rank : core::all_of(engine_.ranks(), std::move(mine)))
    for (const int c : of_rank) change_.gone.push_back({c < 0 ? ~c : c, c < 0 ? lower_end : upper_end});
  std::sort(change_.gone.begin(), change_.gone.end(), [](auto& a, auto& b) { return a.cell < b.cell; });
}

template <int D>
void Traffic<D>::find_come(double time) {
  const int first = static_cast<int>(plan_.scene->placed().size());
  for (int k = static_cast<int>(state_.traffic.cells.in()); k < inflow().due(time); ++k) {
    auto nodes = free_place(first + k);
    if (!nodes) return;  // it waits, and those behind it
    change_.come.push_back({first + k, *std::move(nodes)});
  }
}

template <int D>
auto Traffic<D>::free_place(int cell) -> std::optional<typename Engine<D>::Cells> {
  auto tries = inflow().places(cell, state_.steps);
  looks_in_vain_ = tries.empty() ? looks_in_vain_ + 1 : 0;
  if (looks_in_vain_ > most_looks_in_vain) {
    const scene::Scene& scene = *plan_.scene;
    throw Error(
        Cause::bad_input, scene.place(scene.domain.feed()->pointer),
        "no place and no angle was found behind the inlet at which such a cell keeps two lattice spacings from walls",
        {"take a wider inlet, a smaller cell, or a finer lattice"});
  }
  const auto& cells = engine_.cells();
  std::vector<char> taken(tries.size(), 0);
  for (std::size_t i = 0; i < tries.size(); ++i) {
    const auto is_near = [&](const auto& others, int other) { return !inflow().is_apart(tries[i], others, other); };
    for (const Arrival& other : change_.come) taken[i] = taken[i] != 0 || is_near(other.nodes, 0) ? 1 : 0;
    for (const int other : cells.own_cells()) taken[i] = taken[i] != 0 || is_near(cells, other) ? 1 : 0;
  }
  for (const std::vector<char>& of_rank : core::all_of(engine_.ranks(), taken)) {
    for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = taken[i] != 0 || of_rank[i] != 0 ? 1 : 0;
  }
  const auto free = std::find(taken.begin(), taken.end(), 0);
  if (free == taken.end()) return std::nullopt;
  return std::move(tries[static_cast<std::size_t>(free - taken.begin())]);
}

template <int D>
auto Traffic<D>::take() -> Change {
  Change change = std::exchange(change_, {});
  std::vector<int> gone;
  for (const Departure& departure : change.gone) gone.push_back(departure.cell);
  engine_.change_cells(gone, change.come);
  TrafficState& traffic = state_.traffic;
  const double time = state_.time_at(plan_.stages[state_.stage]);
  for (const Departure& departure : change.gone) traffic.cells.left(departure.cell, time, departure.end);
  for (const Arrival& arrival : change.come) {
    state_.observer.begin_with(arrival.nodes, 0, arrival.cell);
    traffic.cells.came(arrival.cell, content_[plan_.scene->cells[arrival.cell].type], time, lower_end);
  }
  return change;
}

template <int D>
long Traffic<D>::steps_to_next() const {
  constexpr double room = 1;  // spacings: what cells may move between two looks
  constexpr double most_steps = 20;
  double step = 0;
  for (const core::Opening& opening : *engine_.solver().setup().openings)
    if (opening.kind == core::Opening::Kind::velocity) step = std::max(step, 2 * std::abs(opening.value));
  for (const int c : engine_.cells().own_cells()) step = std::max(step, engine_.cells().largest_step[c]);
  step = core::largest(engine_.ranks(), std::array{step})[0];
  return static_cast<long>(std::clamp(std::floor(room / step), 1.0, most_steps));
}

template class Traffic<2>;
template class Traffic<3>;

}  // namespace rouleau::run
