#include "schedule.hpp"

#include <algorithm>

namespace rouleau::core {

bool over_rows(Task task) {
  return task == Task::clear_force || task == Task::spread || task == Task::collide_and_stream;
}

Schedule make_schedule(const StepFeatures& has) {
  Schedule schedule;
  const auto add = [&](bool wanted, Task task, const char* name, Meeting meeting) {
    if (wanted) schedule.steps.push_back({task, name, meeting});
  };
  const bool cells = has.cells, ranks = has.ranks, corrected = has.slip_correction || has.area_correction;
  const bool ghosts = cells && ranks;
  const bool touch = has.interactions, walls = has.wall_interactions;
  const char* const mark = has.viscosity_contrast ? "indicator" : "activity";
  // Where a worker would wait for the others it goes on with its own cells: announce, await.
  const Meeting own_cells = ghosts ? Meeting::all : touch ? Meeting::await : Meeting::none;

  // The last step has left the lattice to itself; with cells a later meeting tells all workers before they take rows.
  add(has.changing_drive || has.changing_forces, Task::set_drive, "fluid",
      cells && !has.changing_forces ? Meeting::none : Meeting::all);
  add(touch && !ghosts, Task::find_contacts, "interaction", Meeting::announce);
  add(cells, Task::membrane_forces, "membrane", walls ? Meeting::none : own_cells);
  add(walls, Task::wall_forces, "interaction", own_cells);
  // What ranks tell each other is on its way during the task after it is sent: positions since the last step.
  add(ghosts, Task::receive_positions, "ranks", Meeting::all);
  add(ghosts, Task::locate_ghosts, "move", Meeting::none);
  add(touch && ghosts, Task::find_contacts, "interaction", Meeting::all);
  add(touch, Task::interaction_forces, "interaction", ranks ? Meeting::all : Meeting::announce);
  add(corrected && !touch, Task::complete_forces, "corrections", Meeting::none);
  // The frame is found from the velocities of all cells: when all workers have left the last step, and no message is on
  // its way.
  const bool frame = cells && has.moving_frame;
  add(frame && touch, Task::follow_cells, "fluid", Meeting::none);
  add(touch && ranks, Task::send_reactions, "ranks", Meeting::none);
  if (ghosts && !touch) {
    schedule.steps.back().meeting = Meeting::all;
    add(frame, Task::follow_cells, "fluid", Meeting::none);
    add(true, Task::send_forces, "ranks", Meeting::none);
  }
  const Meeting alone = touch ? Meeting::await : Meeting::all, several = touch ? Meeting::none : Meeting::all;
  add(cells, Task::find_nodes, mark, ranks ? several : alone);
  add(frame && !touch && !ranks, Task::follow_cells, "fluid", Meeting::all);
  add(touch && ranks, Task::receive_reactions, "ranks", Meeting::all);
  add(touch, Task::take_reactions, "interaction", corrected ? Meeting::none : Meeting::all);
  add(corrected && touch, Task::complete_forces, "corrections", Meeting::all);
  add(touch && ranks, Task::send_forces, "ranks", Meeting::none);
  // Marks are set for even shares of the rows, of which workers take others where rows cost more or less.
  add(cells, Task::set_viscosity, mark, has.uneven_rows ? Meeting::all : Meeting::none);
  add(ghosts, Task::receive_forces, "ranks", Meeting::all);
  schedule.rows = schedule.steps.size();
  add(cells, Task::clear_force, "spread", Meeting::none);
  add(cells, Task::spread, "spread", Meeting::none);
  schedule.observable = schedule.steps.size();
  add(true, Task::collide_and_stream, "fluid", Meeting::all);
  add(true, Task::end_step, "fluid", cells || ranks ? Meeting::none : Meeting::all);
  add(ranks, Task::send_halo, "ranks", Meeting::none);
  add(ghosts, Task::interpolate_inside, "interpolate", Meeting::none);
  add(ranks, Task::receive_halo, "ranks", Meeting::all);
  add(ghosts, Task::interpolate_ghosts, "interpolate", Meeting::all);
  add(ghosts, Task::send_velocities, "ranks", Meeting::none);
  // The next step begins with the same cells; its first barrier serves these tasks, too.
  add(cells, Task::interpolate, "interpolate", Meeting::none);
  add(ghosts, Task::receive_velocities, "ranks", Meeting::all);
  add(corrected, Task::correct_velocities, "corrections", Meeting::none);
  add(cells, Task::move, "move", Meeting::none);
  add(cells, Task::locate, "move", ranks ? Meeting::all : Meeting::none);
  add(ghosts, Task::send_positions, "ranks", Meeting::all);
  return schedule;
}

std::vector<std::string> pass_names(StepFeatures features) {
  features.ranks = false;
  std::vector<std::string> names;
  for (const Step& step : make_schedule(features).steps)
    if (std::find(names.begin(), names.end(), step.name) == names.end()) names.emplace_back(step.name);
  return names;
}

}  // namespace rouleau::core
