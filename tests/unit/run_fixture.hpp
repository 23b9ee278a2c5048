// What the tests of a run's output share: a small scene and snapshots of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "files/run_directory.hpp"
#include "observe/snapshot.hpp"
#include "run/summary.hpp"
#include "scene/scene.hpp"
#include "scratch_folder.hpp"

namespace rouleau::test {

using namespace observe;
using namespace run;
using namespace scene;

using test::ScratchFolder;

inline Scene small_scene(const std::string& title = "two cells") {
  Scene scene;
  scene.title = title;
  scene.domain.size = {20e-6, 10e-6};
  scene.domain.nodes = {8, 4};
  return scene;
}

/// A field whose values are known, given all at once.
inline Field given_field(const char* name, const char* unit, int components, std::vector<double> values) {
  return {name, unit, components, [values = std::move(values)](const Field::Take& take) { take(values); }};
}

/// All values of a field; in several bands as in one.
inline std::vector<double> whole(const Field& field) {
  std::vector<double> values;
  field.give([&](const std::vector<double>& rows) { values.insert(values.end(), rows.begin(), rows.end()); });
  return values;
}

/// Outlines of two round cells in contact, the second with `second_nodes` nodes.
inline OutlineSnapshot small_outlines(int second_nodes = 32) {
  OutlineSnapshot outlines;
  outlines.first.push_back(0);
  for (int cell = 0; cell < 2; ++cell) {
    const int nodes = cell == 0 ? 32 : second_nodes;
    for (int i = 0; i < nodes; ++i) {
      const double angle = 2 * std::numbers::pi * i / nodes;
      outlines.x.push_back(8e-6 + 4.5e-6 * cell + 2e-6 * std::cos(angle));
      outlines.y.push_back(5e-6 + 2e-6 * std::sin(angle));
      outlines.tension.push_back(1e-6 * i);
    }
    outlines.first.push_back(outlines.first.back() + nodes);
  }
  return outlines;
}

/// The same as an observer gives them.
inline MembraneSnapshot given(const OutlineSnapshot& outlines) {
  std::vector<double> points;
  for (std::size_t i = 0; i < outlines.x.size(); ++i) points.insert(points.end(), {outlines.x[i], outlines.y[i]});
  MembraneSnapshot membranes;
  membranes.first = outlines.first;
  membranes.cell.resize(outlines.first.size() - 1);
  std::iota(membranes.cell.begin(), membranes.cell.end(), 0);
  membranes.fields = {given_field("points", "m", 2, points), given_field("tension", "N/m", 1, outlines.tension)};
  return membranes;
}

/// These two cells; fields when asked for.
inline Snapshot small_snapshot(long step, bool with_fields = false, int second_nodes = 32) {
  Snapshot snapshot;
  snapshot.step = step;
  snapshot.time = 0.1 * static_cast<double>(step);
  snapshot.strain = static_cast<double>(step) / 3;
  snapshot.stage_name = "shear";
  snapshot.aggregate_count = 1;
  snapshot.relative_viscosity = step == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.25;
  snapshot.membranes = given(small_outlines(second_nodes));
  for (int cell = 0; cell < 2; ++cell) {
    CellSnapshot state{};
    state.cell = cell;
    state.type = "rbc, \"old\"";
    state.x = 8e-6 + 4.5e-6 * cell;
    state.y = 5e-6;
    state.angle = std::numbers::pi / 3;
    state.area = 1.0 / 3 * 1e-11;
    state.min_gap = cell == 0 ? 0.5e-6 : std::numeric_limits<double>::infinity();
    snapshot.cells.push_back(state);
  }
  snapshot.contacts.push_back({0, 1, {-1, 0}, 0.5e-6, 1.5e-6});
  if (with_fields) {
    auto& fields = snapshot.fields;
    fields.nx = 8;
    fields.ny = 4;
    std::vector<double> velocity;
    for (int i = 0; i < 32; ++i) velocity.insert(velocity.end(), {1.0 * i, -1.0 * i, 0.0});
    fields.fields = {given_field("velocity", "m/s", 3, velocity),
                     given_field("viscosity", "Pa s", 1, std::vector<double>(32, 1.2e-3f))};
  }
  return snapshot;
}

/// A scene whose cells may come and leave.
inline Scene open_scene() {
  Scene scene = small_scene("cells that come and leave");
  scene.domain.openings.emplace();
  scene.domain.periodic[0] = false;
  scene.cells.resize(5);
  return scene;
}

/// Round cells of 32 nodes, no two of them alike, each alone but 2 and 3, which are together. They move a micrometre a
/// step.
inline Snapshot snapshot_of(long step, const std::vector<int>& cells) {
  Snapshot snapshot = small_snapshot(step);
  snapshot.cells.clear(), snapshot.contacts.clear();
  OutlineSnapshot outlines;
  outlines.first = {0};
  for (const int cell : cells) {
    CellSnapshot state{};
    state.cell = state.aggregate = cell;
    if (cell == 3 && std::find(cells.begin(), cells.end(), 2) != cells.end()) state.aggregate = 2;
    state.type = "type " + std::to_string(cell % 2);
    state.x = (2 + 3 * cell + static_cast<double>(step)) * 1e-6, state.y = 5e-6;
    state.deformation = 0.1 * cell;
    for (int i = 0; i < 32; ++i) {
      const double angle = 2 * std::numbers::pi * i / 32;
      outlines.x.push_back(state.x + 1e-6 * std::cos(angle));
      outlines.y.push_back(state.y + (1 + 0.1 * cell) * 1e-6 * std::sin(angle));
      outlines.tension.push_back(1e-6 * (cell + 1));
    }
    outlines.first.push_back(static_cast<int>(outlines.x.size()));
    snapshot.cells.push_back(state);
  }
  snapshot.membranes = given(outlines);
  snapshot.membranes.cell = cells;
  snapshot.cells_inside = static_cast<long>(cells.size());
  return snapshot;
}

/// Which cells there are at each output of a run in which they come and leave.
inline const std::vector<std::vector<int>> cells_of_open_run{{0, 1}, {0, 2}, {2}, {}, {3}, {2, 3, 4}};

inline Summary small_summary() {
  Summary summary;
  summary.status = "completed";
  summary.title = "two cells";
  summary.precision = "f64";
  summary.plan.dimensionless = {{"reynolds_physical", 2.5e-4}, {"capillary", std::nan("")}};
  return summary;
}

}  // namespace rouleau::test
