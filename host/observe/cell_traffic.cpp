#include "cell_traffic.hpp"

#include <algorithm>

#include "columns.hpp"
#include "json/shown.hpp"
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

/// Of the inlet or the outlet, per depth in the plane.
template <auto member>
constexpr Observable opening_flow(const char* name, bool space, const char* doc) {
  Observable made = at_opening<member>(name, space ? "m3/s" : "m2/s", doc);
  made.in_space = space, made.in_plane = !space;
  return made;
}

constexpr const char* through_inlet = "flow through all of the inlet, along +x, at the first nodes behind it";
constexpr const char* through_outlet = "likewise, of the outlet, at the last nodes before it";

}  // namespace

std::vector<Observable> columns_at_openings() {
  return {opening_flow<&Snapshot::inlet_flow>("inlet_flow", false, through_inlet),
          opening_flow<&Snapshot::inlet_flow>("inlet_flow", true, through_inlet),
          opening_flow<&Snapshot::outlet_flow>("outlet_flow", false, through_outlet),
          opening_flow<&Snapshot::outlet_flow>("outlet_flow", true, through_outlet),
          at_opening<&Snapshot::inlet_pressure>("inlet_pressure", "Pa",
                                                "mean of the fluid's nodes at the inlet, half a spacing behind it"),
          at_opening<&Snapshot::outlet_pressure>("outlet_pressure", "Pa", "likewise, before the outlet")};
}

std::vector<Observable> columns_of_traffic() {
  const auto column = [](const char* name, const char* doc, Value (*value)(const Row&), const char* line) {
    return Observable{
        .name = name, .unit = "", .doc = doc, .value = value, .chart = "Cells", .line = line, .of_traffic = true};
  };
  return {column(
              "cells_in", "number of cells that have come in through an opening since the run began",
              [](const Row& row) -> Value { return row.output.cells_in; }, "came in"),
          column(
              "cells_inside", "number of cells that are there: as many rows cells.csv has at this instant",
              [](const Row& row) -> Value { return row.output.cells_inside; }, "inside"),
          column(
              "cells_out", "number of cells that have left through an opening",
              [](const Row& row) -> Value { return row.output.cells_out; }, "left")};
}

bool has_traffic(const scene::Scene& scene) { return scene.domain.openings && !scene.cells.empty(); }

RunKind kind_of(const scene::Scene& scene) {
  const bool pulled = std::any_of(scene.stages.begin(), scene.stages.end(),
                                  [](const scene::Stage& stage) { return !stage.forces.empty(); });
  return {scene.domain.dimension(), scene.domain.is_open(), has_traffic(scene),
          pulled || scene.fluid.gravity != scene::Vector()};
}

void CellTraffic::begin_stage(const std::string& name, double time) {
  stages_.push_back({name});
  if (!flows_) last_time_ = time;
}

auto CellTraffic::stage(double time) -> StageTraffic& {
  if (stages_.empty()) begin_stage("", time);
  return stages_.back();
}

void CellTraffic::came(int cell, double volume, double time, int end) {
  inside_[cell] = {time, volume, end == no_opening};
  if (end == no_opening) return;
  ++in_;
  stage(time).in.at(static_cast<std::size_t>(end)) += volume;
}

void CellTraffic::left(int cell, double time, int end) {
  const Visit visit = inside_.at(cell);
  inside_.erase(cell);
  ++out_;
  stage(time).out.at(static_cast<std::size_t>(end)) += visit.volume;
  if (visit.placed) return;  // it was there before the run
  const double stay = time - visit.since;
  residence_.sum += stay;
  residence_.least = stayed_ == 0 ? stay : std::min(residence_.least, stay);
  residence_.most = std::max(residence_.most, stay);
  ++stayed_;
}

void CellTraffic::flowed(const std::array<double, 2>& along_x, double time) {
  if (flows_) {
    for (std::size_t end = 0; end < 2; ++end) {
      const double along = (last_flow_[end] + along_x[end]) / 2 * (time - last_time_);
      stage(time).flow[end] += end == 0 ? along : -along;
    }
  }
  flows_ = true;
  last_flow_ = along_x;
  last_time_ = time;
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
}

Json CellTraffic::summary(const std::string& unit) const {
  Json stages = Json::array();
  for (const StageTraffic& stage : stages_) {
    Json ends = Json::array();
    for (std::size_t end = 0; end < 2; ++end) {
      const double net = stage.in[end] - stage.out[end];
      ends.push_back({{"volume_in", stage.in[end]},
                      {"volume_out", stage.out[end]},
                      {"flow_in", stage.flow[end]},
                      {"unit", unit},
                      {"discharge_hematocrit", json::number_or_null(net / stage.flow[end])}});
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
