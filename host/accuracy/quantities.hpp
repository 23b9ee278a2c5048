// The numbers that a run reports, read from its files: what error bars are measured for.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace rouleau::accuracy {

/// How far companions say something about a quantity.
enum class Nature {
  smooth,  ///< it changes with the numerics as its error does
  count    ///< a whole number: companions can only have the same or another one
};

struct Quantity {
  std::string name;  ///< key in summary.json, with the unit unless it is a pure number
  double value = std::numeric_limits<double>::quiet_NaN();
  Nature nature = Nature::smooth;
  double uncertainty = 0;    ///< that the value has whatever the numerics, for it was looked at in outputs only
  double part_of_cells = 0;  ///< of the value: what the lattice's error of the cells' shape must show in; 0: nothing
  bool principal = false;    ///< said on the terminal
  bool moment = false;       ///< the strain or time at which something happens
  double least_whole = 0;    ///< smaller values have their relative errors over this: strains before plan::first_events
};

/// Of a run that has completed:
///   deformation            mean over the cells at the end; up to eight cells: cell_N_deformation, cell_N_angle_rad,
///                          cell_N_y_m (of a lone cell angle_rad, y_m), in three dimensions also extents, velocity,
///                          tank-treading frequency, hollow and offset, by the names of their columns
///   passage_strain_N_deg   strain at which the long axis of a cell that turns over first passes a multiple of 45 deg
///   relative_viscosity ... the means of summary.json over the second half of a stage: of the last stage that has one;
///                          of stages before it STAGE: relative_viscosity
///   tank_treading_rad_per_strain, tumbling_rad_per_strain    of cells whose outline has turned once
///   parted_strain_A+B, separate_strain_A+B   of the aggregates that a stage began with, as summary.json has them
///   columns of series.csv  at the end, such as elastic_energy_J_per_m; not those that measure errors themselves, nor
///                          energies of the fluid, which is simulated denser than it is
///   aggregates             how many there are at the end
/// What is not defined in the run is left out. Throws Error(input_output) for files that cannot be read.
/// beyond: name of a last stage that is not the scene's own (Companion::beyond): moments in it count, nothing else
/// does.
std::vector<Quantity> reported_quantities(const std::filesystem::path& run_directory, const std::string& beyond = {});

/// Strain, or whatever x is, at which `angle` first passes each multiple of `part` between its first and last value;
/// rows without an angle are gaps.
struct Passage {
  int multiple;        ///< of `part`
  double at;           ///< linear between two rows
  double uncertainty;  ///< by the curve's bend between them
};
std::vector<Passage> passages(const std::vector<double>& x, const std::vector<double>& angle, double part);

}  // namespace rouleau::accuracy
