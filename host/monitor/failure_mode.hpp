// How a run failed: by a wave along a membrane, a leak, a collapse, or in the fluid itself (docs/stability.md).
#pragma once

#include <array>
#include <functional>
#include <string>

#include "core/domain/images.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "failure.hpp"
#include "growth_watch.hpp"
#include "scene/scene.hpp"

namespace rouleau::monitor {

/// A wave that makes at least this share of the fastest node's speed is what failed.
inline constexpr double prominent = 0.5;
/// Waves up to this many segments long are of the nodes, not of the membrane.
inline constexpr double longest_node_wave = 4;
/// What happens within this many spacings of a membrane is felt by it: half a 4-point kernel, twice.
inline constexpr double membrane_neighbourhood = 4;
/// Two membranes that both lie within this many spacings of a place are in contact there.
inline constexpr double contact_neighbourhood = 8;
/// Share of lattice-scale oscillation from which on the fluid itself is what failed.
inline constexpr double lattice_oscillation_limit = 0.25;

/// Velocity and density deviation of a node, the latter over sqrt(3), in which a sound wave has as much of it as of the
/// former. NaN: unknown.
using FluidSample = std::array<double, 3>;

/// Second differences over 17 nodes along x and along y through a node, squared, over what a wave two spacings long of
/// the same energy about its mean would have; the larger of both. 0 smooth, 1 every other node. Samples that are no
/// numbers are left out.
double lattice_oscillation(int x, int y, const std::function<FluidSample(int x, int y)>& sample);

/// The same of the fluid about a node of the lattice or beside it, in three dimensions within its layer across z; on the
/// first rank, which alone has to know the node, 0 on the others. All ranks together.
template <class T, class Set>
double lattice_oscillation(const core::Fluid<T, Set>& fluid, const std::array<int, Set::dimension>& node);

/// Sets the mode of a failure whose reason and cell are known. `place` in lattice units; `oscillation`:
/// lattice_oscillation there; `step`: the last one. All ranks together, and all find the same.
void find_mode(Failure& failure, const core::Membranes& membranes, const GrowthWatch& growth,
               const core::Domain<2>& domain, std::array<double, 2> place, double oscillation, long step,
               const core::Ranks<2>& ranks = {});
/// Of surfaces: leakage where a volume drifts, sound where the fluid oscillates or there are no cells, else none.
void find_mode(Failure& failure, const core::Surfaces& surfaces, double oscillation);

/// What the mode adds to the failure's message, and what to do about it first; empty where the mode says no more than
/// the reason does. `against_attraction`: attraction_remedy().
std::string mode_sentence(const Failure& failure);
std::string mode_remedy(const Failure& failure, bool semi_implicit, const scene::Stage& stage,
                        const std::string& against_attraction = "");

}  // namespace rouleau::monitor
