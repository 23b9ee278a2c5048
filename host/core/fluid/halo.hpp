// What crosses the border of a block of the lattice: populations and the velocity.
//
// Where a block is its own neighbour, numbers are copied row by row, by the worker who owns the row and while the row is
// in the cache. Everything else goes through messages (domain/messages.hpp).
#pragma once

#include "field.hpp"
#include "lattice.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// After an even step of row y: copies what its neighbours across the border will read in the odd step.
template <class T>
void send_row(Lattice<T>& lattice, int y);

/// After the populations of all nodes have been set for an even step: what odd steps would have streamed across the
/// border, so that the first receive_row() finds it.
template <class T>
void begin_halo(Lattice<T>& lattice);

/// Before an even step of row y: takes what odd steps have streamed across the border. May be repeated.
template <class T>
void receive_row(Lattice<T>& lattice, int y);

/// Sets the halo nodes that belong to row y: periodic images, or beyond a wall 2 u_wall - u (no slip, linear).
template <class T>
void fill_velocity_halo(VectorField<T>& velocity, int y, const Domain<2>& domain, const WallVelocity& walls);

}  // namespace rouleau::core
