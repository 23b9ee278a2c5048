// What a study measures in each run: which number of a run's directory, and what it should be.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reference.hpp"

namespace rouleau::study {

enum class QuantityKind {
  deformation,
  angle,
  area_drift,
  mass_drift,
  passage,
  period,
  gap,
  speed,
  contact_area,
  contact_length,
  dissociation_strain,
  aggregate_count,
  relative_viscosity,
  velocity_l2,
  column
};

/// When a quantity is taken.
struct When {
  enum class Kind {
    end,               ///< the last output
    strain,            ///< that of the tables, summed over the stages
    time,              ///< s
    mean_from_strain,  ///< mean over the strain from there to the end
    mean_from_time     ///< likewise over the time, s
  };
  Kind kind = Kind::end;
  double value = 0;
};

enum class ErrorKind {
  relative,  ///< |value - reference| / |reference|
  absolute   ///< |value - reference|, in the quantity's unit
};

struct Quantity {
  std::string name;
  QuantityKind kind;
  std::string unit;  ///< of value and reference; empty for a pure number
  ErrorKind error;
  double target;        ///< error that the study's sentences speak of
  Reference reference;  ///< of velocity_l2 and the drifts exactly 0
  int cell = 0;         ///< of deformation, angle, passage, period, speed, and of a column of cells.csv
  std::optional<When> at;
  double passed_angle = 0;              ///< passage: rad
  bool of_long_axis = false;            ///< period: of the long axis instead of the outline's first node
  double turns = 1;                     ///< period
  std::optional<double> from_strain;    ///< period
  std::optional<double> from_time;      ///< speed: s; none: from half of the run on
  std::optional<int> count;             ///< dissociation_strain: aggregates; none: all cells apart
  bool for_good = false;                ///< dissociation_strain
  bool intrinsic = false;               ///< relative_viscosity
  bool poiseuille = false;              ///< velocity_l2: of a driven channel, else of moving walls
  bool steady = true;                   ///< velocity_l2: against the steady flow, else against the start-up from rest
  std::string table = "cells", column;  ///< column: "cells" or "series"; speed: the centroid's along its axis
};

/// The quantity at `pointer` of a study; docs/study.md tells the keys of each kind. Throws Error(bad_input).
Quantity read_quantity(const json::Document& document, const std::string& pointer);

/// "deformation", ...
const char* name_of(QuantityKind kind);

struct Measured {
  double value;            ///< NaN: not defined in this run
  double uncertainty = 0;  ///< that the value has whatever the method: a moment that lies between two outputs
  std::string why_not;     ///< why there is no value; empty where there is one
};

/// Takes the quantity from what a run has written. A run that did not complete has no values. Throws
/// Error(input_output) for files that cannot be read.
Measured measure(const Quantity& quantity, const std::filesystem::path& run_directory);

/// Relative L2 distance of the last velocity field in frames.h5 from the exact flow (part of measure).
Measured velocity_error(const Quantity& quantity, const std::filesystem::path& run_directory);

}  // namespace rouleau::study
