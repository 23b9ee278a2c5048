// Where a noisy series became steady, and its mean from there on with an error: one rule for all that a run says.
#pragma once

#include <limits>
#include <string>

#include "base/curve.hpp"
#include "json/json.hpp"

namespace rouleau::observe {

/// Numbers that are unknown are NaN.
struct Statistics {
  std::string verdict;  ///< "steady", or what is missing: then there is no mean
  double mean = unknown;
  double standard_error = unknown;  ///< of the mean; knows that values which follow each other are alike
  double bar_95 = unknown;          ///< half of the interval that holds the true mean in 95 % of cases
  double from = unknown;            ///< where it became steady, in the unit of x
  double parts = unknown;           ///< independent ones: variance of the values over the error's square
  double length = unknown;          ///< of such a part, in the unit of x

  [[nodiscard]] bool steady() const { return verdict == "steady"; }
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
};

/// Of values at places that rise; values that are not finite are left out.
///  1. Values are taken at as many equal distances (linear between them).
///  2. MSER-5 (White, Simulation 69, 1997): of the means of groups of five (fewer below 100 values) so many are left
///     out at the beginning that the estimated variance of the mean of the others is least, and half as many again.
///     More than half of all: not steady.
///  3. Batch means: batches of equal length, 1.25 times as long until neighbours have a correlation below 0.4, without
///     its bias in short series (Kendall 1954). The error is that of the mean of the batches times
///     sqrt((1 + r) / (1 - r)) for the correlation r that remains. Fewer than ten batches, or than 15 independent
///     parts: too short.
///  4. A straight line through the values that rises by more than three of its standard errors: not steady.
/// The bar is Student's for the smaller of the numbers of batches and of parts. docs/results/means-2026-11.md has its
/// coverage.
Statistics statistics(const Column& x, const Column& values);

/// Unknown numbers are null.
void to_json(nlohmann::json& json, const Statistics& statistics);

}  // namespace rouleau::observe
