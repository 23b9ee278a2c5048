#include "schedule.hpp"

namespace rouleau::core {

Schedule make_schedule(const StepFeatures& has) {
  const Step collide{Task::collide_and_stream, "fluid", Meeting::all};
  if (!has.cells) return {{}, {collide, {Task::end_step, "fluid", Meeting::all}}};

  Schedule schedule;
  const auto force = [&](bool wanted, Task task, const char* name, Meeting meeting) {
    if (wanted) schedule.forces.push_back({task, name, meeting});
  };
  const auto advance = [&](bool wanted, Task task, const char* name) {
    if (wanted) schedule.advance.push_back({task, name, Meeting::none});
  };
  const bool touch = has.interactions, slip = has.slip_correction;
  const char* const mark = has.viscosity_contrast ? "indicator" : "activity";
  // Where a worker would wait for the others it goes on with its own cells: announce, await.
  const Meeting own_cells = touch ? Meeting::await : Meeting::none;
  // Only where y is periodic do the rows of one worker have images in the halo of another.
  const Meeting images = has.periodic_y ? Meeting::all : Meeting::none;

  force(touch, Task::find_contacts, "interaction", Meeting::announce);
  force(true, Task::membrane_forces, "membrane", own_cells);
  force(touch, Task::interaction_forces, "interaction", Meeting::announce);
  force(slip && !touch, Task::complete_forces, "corrections", Meeting::none);
  force(true, Task::find_nodes, mark, touch ? Meeting::await : Meeting::all);
  force(touch, Task::take_reactions, "interaction", slip ? Meeting::none : Meeting::all);
  force(slip && touch, Task::complete_forces, "corrections", Meeting::all);
  force(true, Task::set_viscosity, mark, Meeting::none);
  force(true, Task::clear_force, "spread", images);
  force(true, Task::spread, "spread", images);
  force(true, Task::fold_force, "spread", Meeting::none);

  schedule.advance.push_back(collide);
  advance(true, Task::end_step, "fluid");
  // The forces of the next step begin with the same cells; their first barrier serves these tasks, too.
  advance(true, Task::interpolate, "interpolate");
  advance(slip || has.area_correction, Task::correct_velocities, "corrections");
  advance(true, Task::move, "move");
  return schedule;
}

}  // namespace rouleau::core
