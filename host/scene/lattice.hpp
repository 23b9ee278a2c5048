// The lattice of a scene: its nodes along the sides of the domain, its spacing, and its box as core has it.
#pragma once

#include <optional>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/geometry/region.hpp"
#include "scene.hpp"

namespace rouleau::scene {

/// Numbers of nodes along each side: two, or three.
using LatticeSize = std::vector<int>;

/// Cells keep so many spacings from openings when they are placed or come in, so that no kernel reaches beyond one, not
/// after the next steps either.
inline constexpr double kept_from_openings = 6;

/// Spacing of the lattice, m.
double lattice_spacing(const Scene& scene);

/// The lattice of a scene of D dimensions, in one block; with D = 2, of one of three, its section across z.
template <int D = 2>
core::Domain<D> lattice_domain(const Scene& scene);

/// Where the fluid of a tube or between walls of any shape is, with images, in spacings; null: planes alone close it.
template <int D>
core::RegionPointer<D> fluid_region(const Scene& scene);

/// One of the openings that an end of the flow axis has beside each other.
struct OpenPart {
  double area;  ///< m2, or m in two dimensions
  Vector at;    ///< its middle, m
};
/// Those at the lower end, 0, or the upper one, 1, in the order of core::parts_of_section.
std::vector<OpenPart> open_parts(const Scene& scene, int end);

/// Its layers of other viscosities.
std::vector<core::Layer> lattice_layers(const Scene& scene);

/// Nodes whose fluid is computed: those in a tube, or all.
double fluid_nodes(const Domain& domain);

inline constexpr int most_coarse_rows = 4096;
/// The coarsest lattice with the same spacing along all sides, at least four nodes each; none where their ratios are
/// not those of whole numbers, up to most_coarse_rows along y, or where it would have more nodes than can be computed.
std::optional<LatticeSize> coarsest_lattice(const Vector& sides);
/// A lattice with so many times as many nodes along each side; none where that are more than can be computed.
std::optional<LatticeSize> refined(LatticeSize nodes, int factor);

/// That can compute a lattice.
int fewest_ranks(const Domain& domain);

}  // namespace rouleau::scene
