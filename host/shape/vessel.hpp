// What walls of any shape leave to cells, as far as the lattice sees it.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::shape {

/// Of a domain with shapes of walls: area or volume of the fluid between two corners, m2 or m3. Of second order in the
/// spacing of the lattice; that of the whole domain is what the domain says.
double fluid_content(const scene::Domain& domain, const scene::Vector& lower, const scene::Vector& upper);

/// A place in each connected piece of wall that holds nodes of the lattice, m: its node that lies deepest.
template <int D>
std::vector<std::array<double, D>> wall_pieces(const scene::Domain& domain);

}  // namespace rouleau::shape
