// Limits of the method, and what a scene leaves out.
#pragma once

#include <string>

namespace rouleau::plan {

/// What is not computed, and why.
struct Omission {
  std::string what, why;
};
/// The setting that "numerics": "auto" changes where a limit is exceeded.
enum class RemediedBy { nothing, density_factor, resolution };

/// A limit of the method: the scene's value, where it ends, and limit / value.
struct Limit {
  std::string name;
  double value, limit, margin;
  std::string remedy;
  RemediedBy remedied_by = RemediedBy::nothing;
};

}  // namespace rouleau::plan
