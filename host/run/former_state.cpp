#include "former_state.hpp"

#include <limits>
#include <numeric>
#include <vector>

#include "observe/observables.hpp"
#include "observe/observer.hpp"
#include "plan/placed_cells.hpp"

namespace rouleau::run {

namespace {

using Json = nlohmann::json;

template <int D>
Json markers(const plan::Plan& plan) {
  observe::Observer observer(*plan.scene);
  plan::for_each_cell<D>(*plan.scene, scene::lattice_spacing(*plan.scene),
                         [&](std::size_t, const core::Cells<D>& cell) { observer.begin_with(cell); });
  return Json(observer).at("marker_");
}

/// Whether the means of a column have been kept since there are openings.
bool is_new(const observe::Observable& column) { return column.at_openings || column.name == "discharge_hematocrit"; }

void complete_values(Json& values) {
  std::vector<double> complete;
  std::size_t next = 0, columns = 0;
  for (const observe::Observable& column : observe::table("series").observables) {
    if (!column.has_means) continue;
    ++columns;
    const bool missing = is_new(column) || next >= values.size();
    complete.push_back(missing ? std::numeric_limits<double>::quiet_NaN() : values[next++].get<double>());
  }
  if (values.size() < columns && next == values.size()) values = complete;
}

}  // namespace

template <int D>
void complete_former_state(Json& run, const plan::Plan& plan) {
  Json &observer = run.at("observer"), &history = run.at("history");
  if (!observer.contains("marker_")) observer["marker_"] = markers<D>(plan);
  if (!history.contains("count_")) {
    const Json& events = history.at("events_");
    history["count_"] = events.empty() ? Json(0) : events.back().at("count");
  }
  for (Json& stage : run.at("rheology").at("stages_")) {
    for (Json& instant : stage.at("instants")) {
      complete_values(instant.at("values"));
      if (instant.contains("cell")) continue;
      std::vector<int> cells(instant.at("label").size());
      std::iota(cells.begin(), cells.end(), 0);
      instant["cell"] = cells;
    }
  }
}

template void complete_former_state<2>(Json&, const plan::Plan&);
template void complete_former_state<3>(Json&, const plan::Plan&);

}  // namespace rouleau::run
