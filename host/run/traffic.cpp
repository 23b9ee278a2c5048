#include "traffic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "core/fluid/openings/section.hpp"
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
  measure();
  change_ = {};
  find_gone();
  find_come(state_.time_at(plan_.stages[state_.stage]));
  return change_.any();
}

template <int D>
void Traffic<D>::find_gone() {
  constexpr double below_arrivals = 1.5;  // spacings: what has just come does not go
  std::vector<Departure> mine;
  const auto& cells = engine_.cells();
  for (const int c : cells.own_cells()) {
    const core::BoundingBox<D> box = core::box_of<D>(cells, c);
    const int axis = inflow().axis();
    const bool at_upper = box.most[axis] > inflow().highest(),
               at_lower = box.least[axis] < inflow().lowest() - below_arrivals;
    const int end = at_upper ? upper_end : lower_end;
    if (at_upper || at_lower) mine.push_back({c, end, opening_at(end, cells, cells.cells[c])});
  }
  for (const std::vector<Departure>& of_rank : core::all_of(engine_.ranks(), std::move(mine)))
    change_.gone.insert(change_.gone.end(), of_rank.begin(), of_rank.end());
  std::sort(change_.gone.begin(), change_.gone.end(), [](auto& a, auto& b) { return a.cell < b.cell; });
}

template <int D>
void Traffic<D>::find_come(double time) {
  const int first = static_cast<int>(plan_.scene->placed().size());
  for (int k = static_cast<int>(state_.traffic.cells.in()); k < due_by(time); ++k) {
    auto nodes = free_place(k, time);
    if (!nodes) return;  // it waits, and those behind it
    change_.come.push_back({first + k, *std::move(nodes)});
  }
}

template <int D>
auto Traffic<D>::free_place(int cell, double time) -> std::optional<typename Engine<D>::Cells> {
  auto tries = inflow().places(cell, time, state_.traffic.cells.come_in());
  looks_in_vain_ = tries.empty() ? looks_in_vain_ + 1 : 0;
  if (looks_in_vain_ > most_looks_in_vain) {
    const scene::Scene& scene = *plan_.scene;
    throw Error(
        Cause::bad_input, scene.place(scene.domain.feed()->pointer),
        "no place and no angle was found behind the inlet at which such a cell keeps two lattice spacings from walls",
        {"take a wider inlet, a smaller cell, or a finer lattice"});
  }
  const std::vector<double> here = ways(tries, std::vector(tries.size(), 0.0));
  if (const auto free = std::find(here.begin(), here.end(), 0.0); free != here.end())
    return std::move(tries[static_cast<std::size_t>(free - here.begin())]);
  std::vector<double> most;
  most.reserve(tries.size());
  for (auto& attempt : tries) most.push_back(inflow().draw_back(attempt));
  std::vector<double> far = ways(tries, std::move(most));
  for (std::size_t left = tries.size(); left > 0; --left) {
    const auto best = std::max_element(far.begin(), far.end());
    if (*best < 0) break;
    core::Vec<D> along = core::Vec<D>::Zero();
    along[inflow().axis()] = std::exchange(*best, -1);
    auto& attempt = tries[static_cast<std::size_t>(best - far.begin())];
    inflow().move(attempt, along);
    if (inflow().fits(attempt)) return std::move(attempt);
  }
  return std::nullopt;
}

template <int D>
std::vector<double> Traffic<D>::ways(const std::vector<typename Engine<D>::Cells>& cells, std::vector<double> most) {
  const auto& there = engine_.cells();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto shorten = [&](const auto& others, int other) {
      if (most[i] >= 0) most[i] = inflow().way(cells[i], others, other, most[i]);
    };
    for (const Arrival& other : change_.come) shorten(other.nodes, 0);
    for (const int other : there.own_cells()) shorten(there, other);
  }
  for (const std::vector<double>& of_rank : core::all_of(engine_.ranks(), most))
    for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::min(most[i], of_rank[i]);
  return most;
}

template <int D>
void Traffic<D>::measure() {
  auto in_stage = engine_.solver().fluid().passed();
  for (std::vector<double>& end : in_stage)
    for (double& volume : end) volume *= std::pow(plan_.stages[state_.stage].units.length, D);
  state_.traffic.cells.flowed(in_stage);
}

template <int D>
int Traffic<D>::opening_at(int end, const core::Cells<D>& cells, const core::CellRange& cell) {
  const core::BasicSolverSetup<D>& setup = engine_.solver().setup();
  const core::Domain<D>& domain = setup.domain;
  if (parts_of_ends_[0].empty()) parts_of_ends_ = core::parts_of_ends(domain, setup.solid.get());
  const std::vector<int>& openings = parts_of_ends_[end];
  for (int i = cell.first; i < cell.end(); ++i) {
    std::array<int, D> node{};
    bool inside = true;
    for (int k = 0; k < D; ++k) {
      if (k == domain.open_axis) continue;
      node[k] = domain.wrapped(k, static_cast<int>(std::lround(cells.position[k][i])));
      inside = inside && node[k] >= 0;
    }
    if (!inside) continue;
    if (const int opening = openings[core::SectionNodes<D>(domain).number(node)]; opening >= 0) return opening;
  }
  return 0;
}

template <int D>
auto Traffic<D>::take() -> Change {
  Change change = std::exchange(change_, {});
  std::vector<int> gone;
  for (const Departure& departure : change.gone) gone.push_back(departure.cell);
  engine_.change_cells(gone, change.come);
  TrafficState& traffic = state_.traffic;
  const double time = state_.time_at(plan_.stages[state_.stage]);
  for (const Departure& departure : change.gone)
    traffic.cells.left(departure.cell, time, departure.end, departure.opening);
  for (const Arrival& arrival : change.come) {
    state_.observer.begin_with(arrival.nodes, 0, arrival.cell);
    traffic.cells.came(arrival.cell, content_[plan_.scene->cells[arrival.cell].type], time, lower_end,
                       opening_at(lower_end, arrival.nodes, arrival.nodes.cells[0]));
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
