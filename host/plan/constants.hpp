// All numbers that were measured and that a plan is made with: one table. Lattice units where nothing else is said; in
// brackets the heading of docs/results/plan-constants.md that has the measurement.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "core/coupling/kernel_kind.hpp"

namespace rouleau::plan {

// ---- relaxation time and lattice ----
inline constexpr double least_of_tau = 0.005;            ///< of tau - 1/2 [relaxation times]
inline constexpr double least_inside_corrected = 0.025;  ///< inside cells with a correction [relaxation times]
inline constexpr double most_layered_tau = 50.5;         ///< of the most viscous layer [relaxation times]
inline constexpr double narrowest_passage = 8, least_passage = 4;  ///< spacings: warned of below, refused below [tubes]
inline constexpr double least_tube_radius = 8;                     ///< spacings [tubes]
inline constexpr double largest_driven_mach = 0.1;                 ///< of a driven flow [Mach numbers]
inline constexpr double steps_of_period = 350;                     ///< fewest, over (tau - 1/2)^2 [oscillations]
inline constexpr double thinnest_layer = 2.5;                      ///< spacings, that oscillates [oscillations]
inline constexpr double largest_delay = 0.1;    ///< rad, of an oscillation by the density factor [oscillations]
inline constexpr double largest_travel = 0.05;  ///< Reynolds number of cells that travel [travelling cells]
inline constexpr double follows_from = 0.002;   ///< the same, from which the frame moves along [travelling cells]
inline constexpr bool frame_follows[2] = {true, false};  ///< whether it can, by dimension [travelling cells]

// ---- the start of a flow ----
inline constexpr double largest_error_by_start = 0.01;     ///< relative, without a target [start of a flow]
inline constexpr double largest_share_of_strain = 0.1;     ///< of a stage, without a target [start of a flow]
inline constexpr double largest_relaxing_capillary = 0.2;  ///< capillary number, of relaxations [start of a flow]
inline constexpr double first_events = 5;                  ///< strain before which events err least [start of a flow]

// ---- how far the lattice's fluid gives way ----
inline constexpr double compression_by_rate = 2.7;            ///< over (tau - 1/2) times the shear rate [compression]
inline constexpr double largest_compression_by_shear = 0.01;  ///< of a cell's content by a flow [compression]
inline constexpr double compression_by_pressure = 3;          ///< density over pressure, exact [compression]
inline constexpr double largest_compression_by_attraction = 0.1;  ///< 3 times the strongest attraction [attraction]
inline constexpr double largest_compression_by_prestress = 1e-3;  ///< 3 times tension over radius [compression]
/// Volume that a cell loses in a strain of 1, times radius^2, by dimension: alone, and in a crowd [leaks].
inline constexpr double leak_of_one[2] = {0, 0.1}, leak_of_many[2] = {0, 0.5};

// ---- how stiff membranes may be ----
struct AtTau {
  double tau, value;
};
/// Largest d tension / d stretch, d moment / d curvature and d force / d distance with the explicit step [stiffness].
inline constexpr std::array<AtTau, 6> stretch_limit{
    {{0.505, 0.18}, {0.55, 1.7}, {0.6, 2.3}, {1.0, 6.3}, {2.0, 5.1}, {10.0, 2.1}}};
inline constexpr std::array<AtTau, 5> bending_limit{{{0.55, 0.36}, {0.6, 0.86}, {1.0, 6.8}, {2.0, 3.8}, {5.0, 1.7}}};
inline constexpr std::array<AtTau, 3> contact_limit{{{0.6, 0.65}, {1.0, 1.46}, {2.0, 0.97}}};
inline constexpr double largest_viscous_lag = 0.25;     ///< square of rate times lag: error of the stress [viscous lag]
inline constexpr double comfortable_margin = 1.3;       ///< below it "auto" takes the semi-implicit step [stiffness]
inline constexpr double stretching_gain = 20;           ///< of the semi-implicit step [semi-implicit step]
inline constexpr double cautious_stretching_gain = 4;   ///< beyond the range of the full one [semi-implicit step]
inline constexpr double bending_gain = 10;              ///< [semi-implicit step]
inline constexpr double semi_implicit_loss = 0.5;       ///< with a kernel that zigzags [semi-implicit step]
inline constexpr double least_semi_implicit_tau = 0.6;  ///< below it gains nothing [semi-implicit step]
/// Relaxation times of the full gain, by dimension: the least without and with the slip correction, the most without
/// and with all of two viscosities, slip correction and the kernel sharp6 [semi-implicit step].
inline constexpr double least_tau_of_full_gain[2][2] = {{0, 0.9}, {0.9, 0.9}};
inline constexpr double most_tau_of_full_gain[2][2] = {{5, 5}, {5, 3}};
inline constexpr double largest_held_strain = 0.15;     ///< while a step holds forces [held forces]
inline constexpr double held_on_companions = 6;         ///< times as long on a companion's lattice [held forces]
inline constexpr double largest_slip_smoothing = 0.04;  ///< variance over radius^2 [smoothed slip]
inline constexpr double nowhere = std::numeric_limits<double>::infinity();

/// A kernel that a scene can choose, and what it does badly [kernels].
struct KernelFacts {
  core::KernelKind kind;
  const char* name;
  double first_moment;   ///< largest |sum w (x - X)|, spacings
  double stretch_limit;  ///< largest stretching stiffness with explicit coupling over that of peskin4
  double bending_limit;  ///< the same for bending stiffness
  /// Relaxation time from which on the semi-implicit step bears more; `nowhere`: it bears half as much as the explicit
  /// one.
  double semi_implicit_from;
  const char* defect;  ///< what a user has to expect, for `plan`; empty: nothing
};
/// The kernel of this name, which the schema has checked.
const KernelFacts& kernel_named(const std::string& name);

// ---- cells in contact ----
/// Deepest well between cells over bending modulus / radius^2, without a potential within membranes [deep wells].
inline constexpr double deepest_well_of_bare_cells[2] = {40, 250};
/// Deepest well, over the stretching modulus, with which "auto" takes the slip correction in two dimensions [deep
/// wells].
inline constexpr double deepest_corrected_well = 0.02;
inline constexpr double narrowest_well = 0.5;             ///< spacings [narrow wells]
inline constexpr double narrowest_well_of_a_wall = 0.25;  ///< spacings [narrow wells]
inline constexpr double least_gap = 2;                    ///< spacings, of cells at rest; range of a repulsion [gaps]
inline constexpr double least_gap_at_start = 1;           ///< spacings, between cells and to plane walls [gaps]
inline constexpr double least_gap_to_tube = 1;            ///< spacings [gaps]

// ---- segments ----
inline constexpr double shortest_segment = 0.4;  ///< spacings [segments]
inline constexpr double longest_segment = 2.0;   ///< spacings [segments]

// ---- what else "auto" takes ----
inline constexpr double density_factor_at_rest = 13000;  ///< largest with which cells came to rest [rest]
inline constexpr double least_of_layers = 0.01;  ///< of tau - 1/2 in a layer: twice the limit [relaxation times]

// ---- what walls and images add to a sheared cell's deformation in three dimensions ----
inline constexpr double box_share_at_eight = 0.012;  ///< relative, at 8 radii; by the cube of them [small boxes]
inline constexpr double smallest_box = 6;            ///< radii; narrower ones were not measured [small boxes]

// ---- errors, relative (docs/accuracy.md, "The error model of auto") ----
/// Errors were measured for cells whose inside is as viscous as the fluid around them, up to so many times as viscous.
inline constexpr double measured_ratio = 5;
/// Smallest and largest capillary number of a scene's cells and flows.
struct CapillaryRange {
  double least, most;
};
/// What a lattice leaves in a shape at ten spacings a radius and tau 1, and the power of the spacing with which it
/// falls; slip adds what falls with the first power.
struct ShapeError {
  double at_ten, order, slip_at_ten = 0;
};
/// The first at viscosity ratio 1, the second at measured_ratio.
using ShapeErrors = ShapeError[2];
/// By dimension and MembraneCoupling, of round cells and of thin ones; in space those of thin ones are the others'
/// [lattice].
inline constexpr ShapeErrors shape_errors[2][3][2] = {
    {{{{0.0065, 2, 0.014}, {0.029, 2, 0.025}}, {{0.040, 3, 0.014}, {0.039, 2, 0.025}}},
     {{{0.0065, 2}, {0.029, 2}}, {{0.040, 3}, {0.039, 2}}},
     {{{0.0065, 2}, {0.029, 2}}, {{0.040, 3}, {0.039, 2}}}},
    {{{{0.031, 2, 0.022}, {0.031, 2, 0.022}}, {{0.031, 2, 0.022}, {0.031, 2, 0.022}}},
     {{{0.031, 2, 0.022}, {0.031, 2, 0.022}}, {{0.031, 2, 0.022}, {0.031, 2, 0.022}}},
     {{{0.015, 2}, {0.024, 2}}, {{0.015, 2}, {0.024, 2}}}}};
/// Stiffer cells than at `stiff`, and softer ones than at `soft`, have larger errors, by these powers.
struct CapillaryErrors {
  double stiff, stiff_power, soft, soft_power;
};
/// By dimension, of round cells and of thin ones, at both viscosity ratios [lattice].
inline constexpr CapillaryErrors by_capillary[2][2][2] = {
    {{{0.05, 0.3, 0.2, 0.6}, {0.0125, 0.2, 0.2, 0.3}}, {{1, 0, 1, 0}, {1, 0, 1, 0}}},
    {{{1, 0, 1, 0}, {1, 0, 1, 0}}, {{1, 0, 1, 0}, {1, 0, 1, 0}}}};
/// Growth of the shape's error for each unit of tau above 1, by dimension, of round cells and of thin ones [lattice].
inline constexpr double growth_with_tau[2][2] = {{0, 0.2}, {0, 0}};
/// Capillary numbers for which errors were measured; `unstretched`: of membranes that do not resist stretching, too.
struct MeasuredCapillary {
  bool known = false;
  double least = 0, most = 0;
  bool unstretched = false;
};
/// By dimension and MembraneCoupling [lattice].
inline constexpr MeasuredCapillary measured_capillary[2][3] = {
    {{true, 0.003, 0.8, true}, {true, 0.003, 0.8, true}, {true, 0.003, 0.8, true}}, {{}, {}, {true, 0.0035, 0.7}}};
inline constexpr const char* sharp_kernel = "sharp6";
inline constexpr const char* kernel_of_auto[2] = {"peskin4", sharp_kernel};  ///< by dimension
/// Cells without slip correction pass each other too far apart, of first order, by dimension [passing cells].
inline constexpr double passing_at_ten[2] = {0.06, 0.085};
/// Of strains at which things happen, by dimension, and of a thin cell that begins along the flow [dense fluid].
inline constexpr double motion_by_reynolds[2][2] = {{0.024, 0.076}, {0.037, 0.037}};
inline constexpr double along_the_flow = 0.5;  ///< rad, to be one [dense fluid]
/// Es of a neo-Hookean membrane over a third of its stretching stiffness, by dimension: a surface has one of 4 Es.
inline constexpr double shear_share[2] = {1, 0.75};
/// The smallest radii of a cell, in spacings, that leave room for error bars; as they are for most cells.
struct LeastRadii {
  double run = 10;       ///< for which errors were measured, too
  double companion = 4;  ///< on the lattice of the companion for the lattice
  double coarsest = 4;   ///< on that of the companion for the order
};
/// By dimension and MembraneCoupling, of any cells and of spheres alone. Of what a denser fluid does to red cells of
/// viscosity ratio 5, 5.9 spacings show 0.4, 6.8 and 7.8 show 0.6 and 0.8.
inline constexpr LeastRadii least_radii_of[2][3][2] = {{{}, {}, {}}, {{}, {}, {{10, 7, 5.5}, {6.5}}}};

namespace in_plane {
inline constexpr double by_compression[2] = {0.065, 0.15};  ///< of compression^2 times Reynolds number [stiff cells]
inline constexpr double of_shape = 0.5, shape_rate = 1.2, relaxation_by_reynolds = 0.3;   // [steady state]
inline constexpr double of_viscosity = 3.4, viscosity_rate = 0.7, measured_height = 6.4;  // [steady state]
}  // namespace in_plane

namespace in_space {
inline constexpr double steady_amplitude = 0.5, steady_rate[2] = {0.55, 0.38};  // [steady state]
}  // namespace in_space

inline constexpr double start_up = 1.2;        ///< times ((tau - 1/2)/rows)^2, between planes [flows]
inline constexpr double start_up_in_duct = 5;  ///< the same with walls all round [flows]
inline constexpr double duct_error = 0.26;     ///< of the flow rate, over rows^2 [flows]
inline constexpr double tube_error = 1;        ///< of the flow rate, over the square of the radius [flows]

// ---- costs: seconds on one core, bytes ----
namespace cost {
inline constexpr double of_node[2][2] = {{0.85e-9, 1.5e-9}, {5.5e-9, 11e-9}};  ///< by dimension, f32 and f64 [time]
inline constexpr double of_wall_node[2] = {36e-9, 0};  ///< s more, within a spacing of walls of a shape [time]
/// s, of a membrane's node, and what is on top [time].
struct OfMembraneNode {
  double alone;
  double near = 0, near_by_square = 0;  ///< of each surface that is near, by the square of the cutoff too
  double listed_by_square = 0;          ///< of each surface in a list that is made anew, by the square of its reach
  double sharp_kernel = 0, slip = 0, slip_of_contrast = 0, semi_implicit = 0;
  double active[2] = {};  ///< of each node of the lattice that feels it: force, velocity and viscosity, f32 and f64
  double output = 0;      ///< of an output: gaps, aggregates, rows
};
inline constexpr OfMembraneNode of_membrane_node[2] = {{50e-9},
                                                       {.alone = 200e-9,
                                                        .near = 100e-9,
                                                        .near_by_square = 3e-9,
                                                        .listed_by_square = 70e-9,
                                                        .sharp_kernel = 120e-9,
                                                        .slip = 60e-9,
                                                        .slip_of_contrast = 190e-9,
                                                        .semi_implicit = 100e-9,
                                                        .active = {6e-9, 16e-9},
                                                        .output = 5e-6}};
/// s, of a row in three dimensions that fills no whole number of registers [time].
inline constexpr double of_ragged_row = 150e-9, bytes_of_register = 64;
/// Lists of contacts last so many steps, and until a cell has travelled so many spacings [time].
inline constexpr double lifetime_of_lists = 120, travel_of_lists = 0.5;
/// A node of the lattice is in reach of a membrane within so many spacings, one more each with sharp6 and slip
/// correction; along x up to a multiple of so many nodes [time].
inline constexpr double reach_of_membranes = 2.5, nodes_at_once = 16;
inline constexpr double bytes_of_node[2] = {400, 1200};  ///< of a membrane [memory]
inline constexpr int velocities[2] = {9, 19};            ///< of the lattice
}  // namespace cost
/// HDF5's own bytes in frames.h5 [files].
namespace hdf5 {
inline constexpr double file = 12100, frame = 256, membranes = 1244, fields = 97, dataset = 307,
                        compressed_dataset = 3043;
}  // namespace hdf5
/// Bytes of a row of the tables [files].
namespace row {
inline constexpr double cells = 263, wall_gap = 19, aggregates = 59, series = 372, series_of_fluid = 239, sizes = 48,
                        all_headers = 881;
}  // namespace row

}  // namespace rouleau::plan
