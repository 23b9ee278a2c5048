// Compares an output of a model with the derivative of another one, taken by differences that know their error.
#pragma once

#include "trials.hpp"
#include "worst.hpp"

namespace rouleau::conform {

/// `derivative` = `sign` d `function`/d `variable`, at frozen state.
struct DerivativeClaim {
  std::string derivative, function, variable;
  double sign = 1;
};

/// Slopes by differences, one for each element of the inputs.
struct Slope {
  double value = 0, error = 0;  ///< `error` bounds the difference's, of a function that is smooth across it
  bool decided = false;         ///< the error is small enough for the value to tell anything
};

/// Counts of elements at which a comparison told something and at which it did not.
struct Decided {
  int yes = 0, no = 0;
};

/// Holds the claim against differences at every element of the inputs.
void compare_derivative(Worst& worst, Decided& decided, const Subject& subject, const Trial& trial,
                        const Values& inputs, const DerivativeClaim& claim);

/// Holds it against the work over small steps all along a range: no jump of the function, and no stretch of it where
/// something else holds, escapes between the places that compare_derivative looks at.
void compare_work(Worst& worst, const Subject& subject, const Trial& trial, const Values& element,
                  const DerivativeClaim& claim, double low, double high);

/// The slope at each element, from the step with the smallest error bound.
std::vector<Slope> slopes(const Subject& subject, const Trial& trial, const Values& inputs, const std::string& function,
                          const std::string& variable);

}  // namespace rouleau::conform
