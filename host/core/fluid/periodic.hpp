// Where a block is its own periodic neighbour: numbers are copied to and from its halo row by row, by the worker who owns
// the row and while the row is in the cache. What belongs to other blocks goes through Halo (domain/halo.hpp).
#pragma once

#include "core/domain/domain.hpp"
#include "field.hpp"
#include "lattice.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// After an even step of row y: copies what its neighbours across the border will read in the odd step.
template <class T>
void send_row(Lattice<T, D2Q9>& lattice, int y);

/// After the populations of all nodes have been set for an even step: what odd steps would have streamed across the
/// border, so that the first receive_row() finds it.
template <class T>
void fill_population_halo(Lattice<T, D2Q9>& lattice);

/// Before an even step of row y: takes what odd steps have streamed across the border. May be repeated.
template <class T>
void receive_row(Lattice<T, D2Q9>& lattice, int y);

/// Sets the halo nodes that belong to row y: periodic images, or beyond a wall 2 u_wall - u (no slip, linear).
template <class T>
void fill_velocity_halo(VectorField<T, 2>& velocity, int y, const Domain<2>& domain, const WallVelocity& walls);

/// The rows beyond the walls of a block once more, when the halo at its sides is complete.
template <class T>
void mirror_velocity(VectorField<T, 2>& velocity, const Domain<2>& domain, const WallVelocity& walls);

}  // namespace rouleau::core
