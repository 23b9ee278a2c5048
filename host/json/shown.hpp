// How a JSON value is written in messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rouleau::json {

/// A JSON value as one would write it, shortened when long.
std::string shown(const nlohmann::json& value);

}  // namespace rouleau::json
