// Where a block is its own periodic neighbour: numbers are copied to and from its halo row by row, by the worker who
// owns the row and while the row is in the cache. What belongs to other blocks goes through Halo (domain/halo.hpp).
#pragma once

#include "core/domain/domain.hpp"
#include "field.hpp"
#include "lattice.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// After an even step of a row: copies what its neighbours across the border will read in the odd step. Also after the
/// populations of a row have been set for an even step, so that the first receive_row() finds what odd steps would have
/// streamed across the border.
template <class T, class Set>
void send_row(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row);

/// Before an even step of a row: takes what odd steps have streamed across the border. May be repeated.
template <class T, class Set>
void receive_row(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row);

/// Sets the halo nodes that belong to a row: periodic images, or beyond a wall 2 u_wall - u (no slip, linear).
template <class T, int D>
void fill_velocity_halo(VectorField<T, D>& velocity, const std::array<int, D - 1>& row, const Domain<D>& domain,
                        const WallVelocity& walls);

/// The rows of the halo beyond walls once more, when the halo at its sides is complete.
template <class T, int D>
void mirror_velocity(VectorField<T, D>& velocity, const Domain<D>& domain, const WallVelocity& walls);

}  // namespace rouleau::core
