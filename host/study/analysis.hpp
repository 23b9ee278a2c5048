// A study's conclusions from its data: references, errors, Pareto fronts, sensitivities, in words. No files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "quantity.hpp"
#include "richardson.hpp"

namespace rouleau::study {

struct StudyAxis {
  std::string name;
  std::vector<std::string> labels;
  /// Of an axis that refines the lattice: its spacing for each label, in any unit. Empty: the axis refines nothing.
  std::vector<double> spacing;
  bool ordered = true;  ///< its labels are numbers: steps are taken between neighbours, not between any two
};

/// One combination of settings and what came of it.
struct StudyPoint {
  std::vector<int> setting;                          ///< index of a label, for each axis
  double wall_s;                                     ///< median of its timed runs; NaN where there is none
  std::vector<Measured> results;                     ///< for each quantity; empty where it was not run
  std::array<double, 2> wall_range{wall_s, wall_s};  ///< least and most of the timed runs
};

struct StudyData {
  std::vector<StudyAxis> axes;
  int line = 0;                      ///< axis along which Richardson extrapolation refines; -1: none
  std::vector<int> default_setting;  ///< what the others are compared with
  std::vector<Quantity> quantities;
  std::vector<StudyPoint> points;
};

/// All axes but the line: what a line of the chart stands for, and where it tends to.
struct MethodLimit {
  std::vector<int> setting;         ///< -1 for the line's axis
  std::vector<std::size_t> points;  ///< with a value, finest grid first
  Extrapolation extrapolation;      ///< limit, uncertainty and coefficient in the quantity's unit
  std::vector<std::size_t> used;    ///< points it was made from, finest first
};

/// The number that a quantity's errors are measured against.
struct ResolvedReference {
  ReferenceKind kind;
  double value;        ///< NaN: there is none
  double uncertainty;  ///< NaN: not known
  double order;        ///< of Richardson extrapolation
  std::string source;
  std::vector<std::size_t> points;    ///< that it is made from
  std::optional<std::size_t> method;  ///< index into QuantityAnalysis::by_method, of Richardson extrapolation
  std::string why_not;                ///< why there is none, or why it is not to be trusted; else empty
};

struct PointError {
  double value;
  double deviation;    ///< value - reference, over the reference's magnitude where errors are relative
  double error;        ///< its magnitude
  double uncertainty;  ///< of the error: the reference's and the value's own; NaN: not known
  std::string why_not;
};
/// The error, but not below its own uncertainty.
double resolved_error(const PointError& error);

/// One setting of an axis against another, all else equal; `to` has the smaller error.
struct Sensitivity {
  std::size_t axis;
  std::size_t from, to;  ///< points
  double error_factor;   ///< the error of `from` over that of `to`, at least 1
  double time_factor;    ///< the time of `to` over that of `from`; 1 where the ranges of their repeats overlap
  double gain;           ///< log(error_factor)/log(time_factor): infinite where it costs nothing
};

struct StudySentence {
  std::string text;
  double target;                     ///< NaN: of no target
  std::optional<std::size_t> point;  ///< that it speaks of
};

struct QuantityAnalysis {
  ResolvedReference reference;
  std::vector<MethodLimit> by_method;
  std::string disagreement;                ///< methods that tend to different limits, in one sentence; empty: none
  std::vector<PointError> errors;          ///< for each point
  std::vector<std::size_t> front;          ///< points that no other is both cheaper and better than; cheapest first
  std::vector<Sensitivity> sensitivities;  ///< most gain first
  std::vector<StudySentence> sentences;
};

std::vector<QuantityAnalysis> analyse(const StudyData& study);
QuantityAnalysis analyse(const StudyData& study, std::size_t quantity);

/// Methods of a study with what their lines tend to, and the reference they are held against (parts of analyse).
std::vector<MethodLimit> limits_of_methods(const StudyData& study, std::size_t quantity);
ResolvedReference resolve_reference(const StudyData& study, std::size_t quantity,
                                    const std::vector<MethodLimit>& by_method);
/// Pairs of methods whose limits lie further apart than their uncertainties together.
std::vector<std::pair<std::size_t, std::size_t>> disagreements(const std::vector<MethodLimit>& by_method);

/// Indices of the points that are not dominated: none is as good in both and better in one. Sorted by time; of several
/// that are equal in both the first stays. Points that are not finite in both are left out.
std::vector<std::size_t> pareto_front(const std::vector<double>& time, const std::vector<double>& error);
std::vector<Sensitivity> sensitivities_of(const StudyData& study, const std::vector<PointError>& errors);

std::vector<StudySentence> sentences_of(const StudyData& study, std::size_t quantity, const QuantityAnalysis& analysis);
/// "resolution 20, scheme plain"; axes with index -1 are left out.
std::string name_of(const StudyData& study, const std::vector<int>& setting);
/// "0.4 %", "0.12 deg", "3e-05".
std::string error_in_words(const Quantity& quantity, double error);
/// Index of the point with this setting.
std::optional<std::size_t> find_point(const StudyData& study, const std::vector<int>& setting);

}  // namespace rouleau::study
