#include "run_state.hpp"

#include "core/membrane/cell_nodes.hpp"

namespace rouleau::run {

namespace {

constexpr const char *link_places = "/links/place", *lefts = "/links/left", *aways = "/links/away";

}  // namespace

void RunState::report(Summary& s) const {
  s.steps = steps;
  s.strain = strain;
  s.simulated_time_s = time;
  s.wall_s = wall;
  s.steps_per_s = wall > 0 ? static_cast<double>(steps) / wall : 0;
  s.passes = costs.passes();
  s.mach_max = observer.mach_max();
  s.mass_drift = observer.mass_drift();
  s.area_drift_max = observer.area_drift_max();
  s.stretch = {observer.stretch().least, observer.stretch().most};
  s.momentum_residual = momentum_residual;
  s.aggregates_final = history.count();
  s.aggregate_history = history.events();
  s.lifetimes = history.lifetimes();
  s.rheology = rheology.stages();
  s.energy = energy.summary();
  s.stages = stages;
  s.resumed = resumed;
}

bool RunState::fits(const plan::Plan& plan, const core::CellNodes& membranes) const {
  return stage >= 0 && stage < static_cast<int>(plan.stages.size()) && stage_step >= 0 && steps_before >= 0 &&
         steps >= stage_step && observer.fits(membranes) && rheology.fits() &&
         rest_watch.fits(membranes, plan.stages[stage].stage->until_at_rest);
}

std::size_t save_links(files::CheckpointWriter* writer, const core::LinkMemory& links) {
  if (writer == nullptr || links.place.empty()) return links.place.size();
  for (const auto& [path, values] :
       {std::pair{link_places, &links.place}, std::pair{lefts, &links.left}, std::pair{aways, &links.away}}) {
    writer->begin_array(path, values->size());
    writer->append(*values);
  }
  return links.place.size();
}

core::LinkMemory read_links(const files::CheckpointReader& reader, const nlohmann::json& of_solver) {
  if (of_solver.value("links", 0) == 0) return {};
  core::LinkMemory links{reader.array(link_places), reader.array(lefts), reader.array(aways)};
  if (links.left.size() != links.place.size() || links.away.size() != links.place.size())
    reader.refuse("links without what has left along them");
  return links;
}

}  // namespace rouleau::run
