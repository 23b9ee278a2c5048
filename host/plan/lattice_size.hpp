// Numbers of nodes along the sides of a domain, in two dimensions and in three.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::plan {

/// Numbers of nodes along each side: two, or three.
using LatticeSize = std::vector<int>;

LatticeSize lattice_size(const scene::Domain& domain);
/// Lengths of the sides, m: two, or three.
std::vector<double> sides(const scene::Domain& domain);
/// The domain with this lattice.
scene::Domain with_lattice(scene::Domain domain, const LatticeSize& nodes);

/// Nodes whose fluid is computed: those in a tube, or all.
double fluid_nodes(const scene::Domain& domain);

inline constexpr int most_coarse_rows = 4096;
/// The coarsest lattice with the same spacing along all sides, at least four nodes each; none where their ratios are not those of
/// whole numbers, up to most_coarse_rows along y, or where it would have more nodes than can be computed.
std::optional<LatticeSize> coarsest_lattice(const std::vector<double>& sides);
/// A lattice with so many times as many nodes along each side; none where that are more than can be computed.
std::optional<LatticeSize> refined(LatticeSize nodes, int factor);

/// That can compute a lattice.
int fewest_ranks(const scene::Domain& domain);

}  // namespace rouleau::plan
