// What a study measures in each run: which number of a run's directory, and what it should be, the reference that
// errors are measured against.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/curve.hpp"

namespace rouleau::json {
class Document;
}  // namespace rouleau::json

namespace rouleau::study {

enum class ReferenceKind {
  value,       ///< given in the study
  file,        ///< a number of a JSON file
  analytic,    ///< known exactly
  richardson,  ///< limit of the study's own grids
  point        ///< what the study finds at one of its points
};

struct Reference {
  ReferenceKind kind = ReferenceKind::richardson;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< in the quantity's unit; NaN until the study has run
  double uncertainty = 0;                                   ///< of `value`; 0 where none is known
  std::string source;                                       ///< in the user's words, or the file and pointer
  /// Of `point`: the point. Of `richardson`: the method whose limit is the reference; empty: the surest one.
  std::map<std::string, std::string> labels;
};

/// The reference at `pointer` of a document that fits study_schema():
///     {"value": 0.2386, "uncertainty": 0.0002, "source": "..."}
///     {"file": "x.json", "pointer": "/0/steady/D", "uncertainty": 1e-4 | "/0/error_bar/D", "factor", "offset",
///     "source"}
///                           the file is relative to the document's folder; value = number x factor + offset
///     {"analytic": "zero"}  "richardson"  {"richardson": {"scheme": "corrected"}}  {"point": {"resolution": "40"}}
/// Throws Error(bad_input) at the place of a fault, Error(input_output) for a file that cannot be read.
Reference read_reference(const json::Document& document, const std::string& pointer);

/// "value", "file", ...
const char* name_of(ReferenceKind kind);

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

/// The quantity at `pointer` of a study that fits study_schema(). Throws Error(bad_input).
Quantity read_quantity(const json::Document& document, const std::string& pointer);

/// "deformation", ...
const char* name_of(QuantityKind kind);

struct Measured {
  double value;            ///< NaN: not defined in this run
  double uncertainty = 0;  ///< that the value has whatever the method: a moment that lies between two outputs
  std::string why_not;     ///< why there is no value; empty where there is one
};

/// No value, and why.
inline Measured undefined_because(const std::string& why_not) {
  return {std::numeric_limits<double>::quiet_NaN(), 0, why_not};
}

/// Takes the quantity from what a run has written. A run that did not complete has no values. Throws
/// Error(input_output) for files that cannot be read.
Measured measure(const Quantity& quantity, const std::filesystem::path& run_directory);

/// Relative L2 distance of the last velocity field in frames.h5 from the exact flow (part of measure).
Measured velocity_error(const Quantity& quantity, const std::filesystem::path& run_directory);

/// How aggregates change: the number there is from x on, until the next change.
struct CountChange {
  double time, strain;
  int count;
};

/// First strain, since the sheared stage began, at which there are `count` aggregates or more; with `for_good` the
/// first from which on there are to the end. Between the output before and this one it happened: `uncertainty` is
/// their distance. NaN where it does not happen, or had happened when shear began.
struct Dissociation {
  double strain, uncertainty;
  bool at_start;  ///< there were as many when shear began
};
/// `output_strain`: of every output of the run; shear begins at `start_time` and `start_strain`.
Dissociation dissociation(const std::vector<CountChange>& changes, const Column& output_strain, double start_time,
                          double start_strain, int count, bool for_good);

}  // namespace rouleau::study
