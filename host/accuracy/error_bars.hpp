// Errors of what a run reports, from its differences from companions (Richardson extrapolation).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "companions.hpp"
#include "json/json.hpp"
#include "quantities.hpp"

namespace rouleau::accuracy {

/// What a companion reports.
struct Measured {
  Role role;
  std::string differs;
  std::vector<Quantity> quantities;
};

/// Estimates of value - true value, one for each cause.
struct Shares {
  double lattice = 0, start = 0, inertia = 0;
};

struct ErrorBar {
  Quantity quantity;
  Shares shares;
  double estimate = 0;          ///< of |value - true value|; the bar is wider
  std::optional<double> error;  ///< the true value lies within value +- this in 95 % of cases; none: nothing to say
  std::string how;              ///< what it is made of, or why there is none
};

/// What differences between lattices say of a value's error on the finest of them.
struct LatticeShare {
  double error = 0;  ///< value - limit
  double doubt = 0;  ///< of it, not negative
};
/// `coarse` and `coarser`: values on lattices `r` and `s` times as coarse as that of `value`; s = 1: there is no second
/// one. The error is a h^p + b h^2p with both, kept between what b h^2p alone gives and twice what c h^p gives. With
/// one of them, or where the two differences have no common trend, it is c h^q, q the order that was measured with
/// other cells of the kind, and the doubt holds the error that c h^p would be and, of the two, the larger difference.
LatticeShare lattice_share(double value, double coarse, double r, double coarser, double s, double p, double q);

/// `measured`: of all companions of the choice, in their order. With the sum s of the shares
///   estimate = max(|s|, floor) + the value's own uncertainty
///   error = estimate + doubt of the lattice's share + (|start| + |inertia|)/2
/// The floor is 3/4 of the deformation's relative lattice share, times Quantity::part_of_cells: a difference that
/// happens to vanish between two lattices is no error that vanishes.
std::vector<ErrorBar> error_bars(const std::vector<Quantity>& run, const Companions& companions,
                                 const std::vector<Measured>& measured);

/// {name: {value, error, how}}; error is null where there is none.
nlohmann::json to_json(const std::vector<ErrorBar>& bars);

/// "0.347 +- 0.004": the error with one digit or, where that is a 1, two, rounded up; the value to the same place.
std::string with_error(double value, double error);

/// Of the quantities that are told first: "deformation 0.347 +- 0.004".
std::vector<std::string> sentences(const std::vector<ErrorBar>& bars);

/// The largest relative estimate of these quantities' errors (of an angle the error in rad), and of which one. Where
/// there are moments at which something happens they alone count: a shape that turns over has moved on by the end.
struct Worst {
  double error = 0;
  std::string name;
  Shares shares = {};      ///< relative, too
  double uncertainty = 0;  ///< relative: what outputs leave open, and no other numerics mend
};
std::optional<Worst> worst(const std::vector<ErrorBar>& bars);

}  // namespace rouleau::accuracy
