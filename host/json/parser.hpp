// Parses JSON text strictly and keeps the place of every value.
#pragma once

#include <string>
#include <string_view>

#include "json.hpp"
#include "syntax_fault.hpp"
#include "text_tree.hpp"

namespace rouleau::json {

/// Limits that keep a hostile or broken file from exhausting stack or memory.
inline constexpr std::size_t largest_text = 16U << 20U;  ///< bytes
inline constexpr std::size_t deepest_nesting = 200;      ///< objects and arrays within each other
inline constexpr std::size_t longest_string = 8192;      ///< bytes

struct ParsedText {
  nlohmann::json root;
  TextTree tree;
};

/// Throws TextFault for malformed JSON, duplicate keys, numbers that overflow and texts beyond the limits.
ParsedText parse_json(std::string_view text);

}  // namespace rouleau::json
