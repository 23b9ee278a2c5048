// Numbers that JSON cannot hold.
#pragma once

#include <cmath>

#include "json.hpp"

namespace rouleau::json {

/// JSON has neither infinity nor NaN: what is undefined is null.
inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace rouleau::json
