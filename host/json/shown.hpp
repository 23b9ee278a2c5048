// How a JSON value is written in messages.
#pragma once

#include <string>

#include "json.hpp"

namespace rouleau::json {

/// A JSON value as one would write it, shortened when long.
std::string shown(const nlohmann::json& value);

}  // namespace rouleau::json
