// How a JSON value is written in messages, and a number that JSON may not be able to hold.
#pragma once

#include <cmath>
#include <string>

#include "json.hpp"

namespace rouleau::json {

/// JSON has neither infinity nor NaN: what is undefined is null.
inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// A JSON value as one would write it, shortened when long.
std::string shown(const nlohmann::json& value);

}  // namespace rouleau::json
