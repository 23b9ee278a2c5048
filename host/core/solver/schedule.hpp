// One time step as a list: the algorithm of the simulator, in its order.
#pragma once

#include <string>
#include <vector>

#include "pass.hpp"

namespace rouleau::core {

/// What a time step may do. A pass over cells gives each worker cells, one over rows gives it rows of the lattice.
enum class Task {
  set_drive,           ///< one worker: walls, body force and forces on cells that change with time
  membrane_forces,     ///< cells: F = -dE/dX of the membrane laws
  wall_forces,         ///< cells: F = -dE/dX of the potentials between cells and walls
  receive_positions,   ///< one worker: of other ranks' nodes that this one has to know of
  locate_ghosts,       ///< cells: locate, of other ranks' cells and of those that have just become own ones
  find_contacts,       ///< cells: the closest point of other outlines to each node
  interaction_forces,  ///< cells: F = -dE/dX of the potentials, on own nodes
  send_reactions,      ///< one worker: what own nodes do to other ranks' cells
  receive_reactions,   ///< one worker
  take_reactions,      ///< cells: what other cells' nodes do to this one's
  complete_forces,     ///< cells: corrections of what is spread, made of all forces on a node
  find_nodes,          ///< cells: the area fraction of lattice nodes, and which nodes feel a membrane
  follow_cells,        ///< one worker: the frame of the fluid's unsteady term
  send_forces,         ///< one worker: to the ranks that spread them
  receive_forces,      ///< one worker
  set_viscosity,       ///< rows: the relaxation rate in and around the cells that have moved
  clear_force,         ///< rows
  spread,              ///< rows: forces to the lattice (Peskin, Acta Numerica 11, 2002)
  collide_and_stream,  ///< rows: lattice Boltzmann with the force of Guo, Zheng and Shi, Phys. Rev. E 65, 2002
  end_step,            ///< one worker: the lattice's parity
  send_halo,           ///< one worker: populations and velocities to other blocks, as far as that is still to be done
  receive_halo,        ///< one worker
  interpolate_inside,  ///< cells: interpolate, those that lie inside of the block
  interpolate_ghosts,  ///< cells: interpolate, other ranks' nodes
  interpolate,      ///< cells: velocities of the nodes, with the kernel that has spread their forces; where there are
                    ///< ranks those of own cells at the block's borders
  send_velocities,  ///< one worker: of other ranks' nodes, to these
  receive_velocities,  ///< one worker
  correct_velocities,  ///< cells: neither slip nor leaks
  move,                ///< cells: X(t + 1) = X(t) + U
  locate,              ///< cells: where the nodes touch the lattice
  send_positions       ///< one worker: what all ranks agree on, then nodes that others have to know of in the next step
};

/// A task and what happens between the workers after it.
struct Step {
  Task task;
  /// In summary.json and plan; tasks of one name are phases of one pass.
  const char* name;
  Meeting meeting;
};

/// What decides which tasks a step has.
struct StepFeatures {
  bool cells = false;
  bool interactions = false;
  bool wall_interactions = false;
  bool viscosity_contrast = false;
  bool slip_correction = false;
  bool area_correction = false;
  /// The fluid's unsteady term is seen from a frame that moves with the cells.
  bool moving_frame = false;
  /// What drives the fluid changes with time.
  bool changing_drive = false;
  /// What acts on cells from outside does.
  bool changing_forces = false;
  /// Workers share the rows of the lattice by what they cost.
  bool uneven_rows = false;
  /// Other ranks hold other blocks and own other cells.
  bool ranks = false;
};

/// Whether a task is one over rows of the lattice.
bool over_rows(Task task);

/// A step. Before step [observable] (and after a barrier) forces and velocities belong to the present positions, and
/// the state may be observed; from step [rows] on, one may go on to the end of the step without a look at it.
struct Schedule {
  std::vector<Step> steps;
  std::size_t rows = 0, observable = 0;
};
Schedule make_schedule(const StepFeatures& features);

/// The passes of a step, each name once, as one process has them; other ranks change the order of the tasks.
std::vector<std::string> pass_names(StepFeatures features);

}  // namespace rouleau::core
