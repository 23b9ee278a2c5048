// How a check's process tells its parent what it found: one JSON line on a file descriptor of its own.
#pragma once

#include "check.hpp"
#include "json/json.hpp"

namespace rouleau::conform {

nlohmann::json to_json(const Finding& finding);
Finding finding_from(const nlohmann::json& json);

/// Writes the finding; for the end of a check.
void send(const Finding& finding);
/// Writes a text for another check's process.
void send(const std::string& text);
/// The same as send(finding) from a signal handler: no allocation. `text` must hold no quotes, backslashes or control
/// characters.
void send_from_signal(const char* verdict, const char* text);

}  // namespace rouleau::conform
