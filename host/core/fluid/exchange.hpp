// Everything that crosses the border of a block: populations, force, velocity.
//
// Today one block is its own periodic neighbour along x and, where it has no walls, along y; a block of another thread
// or another MPI rank will be reached through these same calls. Every call touches the halo that belongs to one row
// only, so that the worker who owns the row can make it.
#pragma once

#include "field.hpp"
#include "lattice.hpp"

namespace rouleau::core {

/// Velocity of the walls along x, lattice units. Not used when y is periodic.
struct WallVelocity {
  double lower = 0, upper = 0;
};

/// Adds to the populations of row y what a moving wall beside it gives: f_q += 6 w_q c_q . u_wall for every q that
/// comes from the wall (Ladd, J. Fluid Mech. 271, 1994). To be called after every collision of the row, at either
/// parity.
template <class T>
void add_wall_momentum(Lattice<T>& lattice, int y, const WallVelocity& walls);

/// After an even step of row y: copies what its neighbours across the border will read in the odd step.
template <class T>
void send_row(Lattice<T>& lattice, int y);

/// After the populations of all nodes have been set for an even step: what odd steps would have streamed across the
/// border, so that the first receive_row() finds it.
template <class T>
void begin_exchange(Lattice<T>& lattice);

/// Before an even step of row y: takes what odd steps have streamed across the border. May be repeated.
template <class T>
void receive_row(Lattice<T>& lattice, int y);

/// Sets the halo nodes that belong to row y to zero: its ends, and the rows beyond the border whose image it is.
template <class T>
void clear_force_halo(VectorField<T>& force, int y, bool periodic_y);

/// Adds to row y the force that was spread onto its halo nodes. Beyond a wall the halo is the mirror image with
/// reversed sign: the adjoint of fill_velocity_halo, so that spreading and interpolation stay adjoint near walls too.
template <class T>
void fold_force_row(VectorField<T>& force, int y, bool periodic_y);

/// Sets the halo nodes that belong to row y: periodic images, or beyond a wall 2 u_wall - u (no slip, linear).
template <class T>
void fill_velocity_halo(VectorField<T>& velocity, int y, bool periodic_y, const WallVelocity& walls);

}  // namespace rouleau::core
