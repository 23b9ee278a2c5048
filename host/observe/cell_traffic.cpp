#include "cell_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "columns.hpp"
#include "json/shown.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"

namespace rouleau::observe {

using Json = nlohmann::json;

namespace {

template <auto member>
Value of_output(const Row& row) {
  return row.output.*member;
}

template <auto member>
constexpr Observable at_opening(const char* name, const char* unit, const char* doc) {
  return {.name = name, .unit = unit, .doc = doc, .value = of_output<member>, .has_means = true, .at_openings = true};
}

/// A column in the plane, per depth, and the same in space, where it has another unit.
std::array<Observable, 2> in_plane_and_space(const Observable& column, const char* space_unit) {
  std::array<Observable, 2> both{column, column};
  both[0].in_plane = true;
  both[1].unit = space_unit, both[1].in_space = true;
  return both;
}

/// That of an opening, of an end's list, which may have ended before it.
template <class V>
V& at_opening(std::array<std::vector<V>, 2>& ends, int end, int opening) {
  std::vector<V>& of_end = ends.at(static_cast<std::size_t>(end));
  const auto k = static_cast<std::size_t>(opening);
  if (of_end.size() <= k) of_end.resize(k + 1);
  return of_end[k];
}

template <class V>
V value_or(const std::vector<V>& values, std::size_t k, V otherwise) {
  return k < values.size() ? values[k] : otherwise;
}

/// All that has gone through an end along the open axis since the run began.
template <int end>
Value volume_through(const Row& row) {
  const std::vector<double>& openings = row.output.volume_through[end];
  return std::accumulate(openings.begin(), openings.end(), 0.0);
}

/// Of one of several openings at an end: what flows through it, and the cells.
template <int end, int number>
void add_opening(std::vector<Observable>& columns, bool cells) {
  static const std::string name = (end == 0 ? "inlet_" : "outlet_") + std::to_string(number + 1);
  static const std::string flow = name + "_flow", volume = name + "_volume", of_cells = name + "_cells";
  const auto add = [&](Observable column) {
    column.end = end, column.number = number;
    columns.push_back(column);
  };
  constexpr auto flow_of = [](const Row& row) -> Value {
    return value_or(row.output.opening_flow[end], number, std::nan(""));
  };
  constexpr auto volume_of = [](const Row& row) -> Value {
    return value_or(row.output.volume_through[end], number, std::nan(""));
  };
  constexpr auto cells_of = [](const Row& row) -> Value {
    return (end == 0 ? 1 : -1) * value_or(row.output.cells_through[end], number, 0L);
  };
  constexpr const char *through = "flow through one opening, by its number, along the open axis",
                       *in_all = "what flowed through it since the run began";
  if (cells) {
    const char* const doc =
        end == 0 ? "cells that came in through it, less those that left" : "cells that left through it";
    add({.name = of_cells, .unit = "", .doc = doc, .value = cells_of, .of_traffic = true});
  } else {
    const Observable flows{.name = flow, .unit = "m2/s", .doc = through, .value = flow_of, .at_openings = true};
    const Observable volumes{.name = volume, .unit = "m2", .doc = in_all, .value = volume_of, .at_openings = true};
    for (const Observable& column : in_plane_and_space(flows, "m3/s")) add(column);
    for (const Observable& column : in_plane_and_space(volumes, "m3")) add(column);
  }
}

template <int... number>
void add_openings(std::vector<Observable>& columns, bool cells, std::integer_sequence<int, number...>) {
  (add_opening<0, number>(columns, cells), ...);
  (add_opening<1, number>(columns, cells), ...);
}

constexpr const char* through_inlet =
    "flow through all of the inlet, along the open axis, at the first nodes behind it";
constexpr const char* through_outlet = "likewise, of the outlet, at the last nodes before it";
constexpr const char* volume_in = "all that flowed in since the run began; differences over time are mean flows";
constexpr const char* volume_out = "likewise, that flowed out";

}  // namespace

std::vector<Observable> columns_at_openings() {
  std::vector<Observable> all;
  const auto add = [&](const Observable& column, const char* space_unit) {
    for (const Observable& one : in_plane_and_space(column, space_unit)) all.push_back(one);
  };
  add(at_opening<&Snapshot::inlet_flow>("inlet_flow", "m2/s", through_inlet), "m3/s");
  add(at_opening<&Snapshot::outlet_flow>("outlet_flow", "m2/s", through_outlet), "m3/s");
  all.push_back(at_opening<&Snapshot::inlet_pressure>(
      "inlet_pressure", "Pa", "mean of the fluid's nodes at the inlet, half a spacing behind it"));
  all.push_back(at_opening<&Snapshot::outlet_pressure>("outlet_pressure", "Pa", "likewise, before the outlet"));
  add({.name = "inlet_volume", .unit = "m2", .doc = volume_in, .value = volume_through<0>, .at_openings = true}, "m3");
  add({.name = "outlet_volume", .unit = "m2", .doc = volume_out, .value = volume_through<1>, .at_openings = true},
      "m3");
  add_openings(all, false, std::make_integer_sequence<int, most_openings>());
  return all;
}

std::vector<Observable> columns_of_traffic() {
  const auto column = [](const char* name, const char* doc, Value (*value)(const Row&), const char* line) {
    return Observable{
        .name = name, .unit = "", .doc = doc, .value = value, .chart = "Cells", .line = line, .of_traffic = true};
  };
  std::vector<Observable> all = {
      column(
          "cells_in", "number of cells that have come in through an opening since the run began",
          [](const Row& row) -> Value { return row.output.cells_in; }, "came in"),
      column(
          "cells_inside", "number of cells that are there: as many rows cells.csv has at this instant",
          [](const Row& row) -> Value { return row.output.cells_inside; }, "inside"),
      column(
          "cells_out", "number of cells that have left through an opening",
          [](const Row& row) -> Value { return row.output.cells_out; }, "left")};
  add_openings(all, true, std::make_integer_sequence<int, most_openings>());
  return all;
}

bool has_traffic(const scene::Scene& scene) { return scene.domain.openings && !scene.cells.empty(); }

RunKind kind_of(const scene::Scene& scene) {
  const bool pulled = std::any_of(scene.stages.begin(), scene.stages.end(),
                                  [](const scene::Stage& stage) { return !stage.forces.empty(); });
  RunKind kind(scene.domain.dimension(), scene.domain.is_open(), has_traffic(scene),
               pulled || scene.fluid.gravity != scene::Vector(),
               std::any_of(scene.interactions.begin(), scene.interactions.end(),
                           [](const scene::Interaction& i) { return !i.with_wall() && !i.with_self(); }));
  for (const int end : {0, 1})
    if (scene.domain.openings) kind.openings[end] = static_cast<int>(scene::open_parts(scene, end).size());
  return kind;
}

void CellTraffic::begin_stage(const std::string& name) {
  stages_.push_back({name});
  before_ = {};
}

auto CellTraffic::stage() -> StageTraffic& {
  if (stages_.empty()) begin_stage("");
  return stages_.back();
}

void CellTraffic::came(int cell, double volume, double time, int end, int opening) {
  inside_[cell] = {time, volume, end == no_opening};
  if (end == no_opening) return;
  ++in_;
  ++at_opening(through_, end, opening);
  Passed& there = at_opening(stage().ends, end, opening);
  there.in += volume, ++there.cells_in;
}

void CellTraffic::left(int cell, double time, int end, int opening) {
  const Visit visit = inside_.at(cell);
  inside_.erase(cell);
  ++out_;
  --at_opening(through_, end, opening);
  Passed& there = at_opening(stage().ends, end, opening);
  there.out += visit.volume, ++there.cells_out;
  if (visit.placed) return;  // it was there before the run
  const double stay = time - visit.since;
  residence_.sum += stay;
  residence_.least = stayed_ == 0 ? stay : std::min(residence_.least, stay);
  residence_.most = std::max(residence_.most, stay);
  ++stayed_;
}

void CellTraffic::flowed(const std::array<std::vector<double>, 2>& in_stage) {
  for (const int end : {0, 1})
    for (std::size_t k = 0; k < in_stage[end].size(); ++k)
      at_opening(stage().ends, end, static_cast<int>(k)).flow = in_stage[end][k] + value_or(before_[end], k, 0.0);
}

double CellTraffic::come_in() const {
  double sum = 0;
  for (const StageTraffic& stage : stages_)
    for (const Passed& opening : stage.ends[0]) sum += opening.flow;
  return sum;
}

std::vector<int> CellTraffic::there() const {
  std::vector<int> cells;
  for (const auto& [cell, visit] : inside_) cells.push_back(cell);
  return cells;
}

void CellTraffic::tell(Snapshot& snapshot) const {
  snapshot.cells_in = in();
  snapshot.cells_inside = inside();
  snapshot.cells_out = out();
  snapshot.cells_through = through_;
  for (const StageTraffic& stage : stages_)
    for (const int end : {0, 1})
      for (std::size_t k = 0; k < stage.ends[end].size(); ++k)
        at_opening(snapshot.volume_through, end, static_cast<int>(k)) += (end == 0 ? 1 : -1) * stage.ends[end][k].flow;
}

auto CellTraffic::Passed::operator+=(const Passed& more) -> Passed& {
  in += more.in, out += more.out, flow += more.flow;
  cells_in += more.cells_in, cells_out += more.cells_out;
  return *this;
}

Json CellTraffic::Passed::summary(const std::string& unit) const {
  return {{"cells_in", cells_in},
          {"cells_out", cells_out},
          {"volume_in", in},
          {"volume_out", out},
          {"flow_in", flow},
          {"unit", unit},
          {"discharge_hematocrit", json::number_or_null((in - out) / flow)}};
}

Json CellTraffic::summary(const std::string& unit) const {
  Json stages = Json::array();
  for (const StageTraffic& stage : stages_) {
    Json ends = Json::array();
    for (const std::vector<Passed>& end : stage.ends) {
      Passed all;
      Json openings = Json::array();
      for (const Passed& opening : end) all += opening, openings.push_back(opening.summary(unit));
      ends.push_back(all.summary(unit));
      if (end.size() > 1) ends.back()["openings"] = std::move(openings);
    }
    stages.push_back({{"stage", stage.name}, {"ends", std::move(ends)}});
  }
  Json residence;  // null
  if (stayed_ > 0)
    residence = {{"mean", residence_.sum / static_cast<double>(stayed_)},
                 {"least", residence_.least},
                 {"most", residence_.most},
                 {"cells", stayed_}};
  return {{"cells_in", in()},
          {"cells_inside", inside()},
          {"cells_out", out()},
          {"residence_time_s", std::move(residence)},
          {"stages", std::move(stages)}};
}

}  // namespace rouleau::observe
