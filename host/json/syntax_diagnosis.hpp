// Says in a human sentence what is wrong with malformed JSON.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "parser.hpp"

namespace rouleau::json {

/// What the parser had taken last before it stumbled.
enum class Taken { nothing, object_start, array_start, key, value, document };

struct Stumble {
  std::size_t cursor;    ///< end of the last token taken
  std::size_t consumed;  ///< bytes that the lexer had read
  Taken after;
  std::size_t opened;   ///< offset of the innermost open '{' or '['; the text's size when none is open
  std::string pointer;  ///< of that object or array
};

/// The fault as an exception, to be thrown by the caller.
TextFault describe_malformed(std::string_view text, const Stumble& stumble);

/// Length of the UTF-8 character at `at`, 0 when there is none (RFC 3629: no overlong forms, no surrogates).
std::size_t utf8_length(std::string_view text, std::size_t at);

/// One past the JSON number that begins at `start` (as far as the grammar goes).
std::size_t end_of_number(std::string_view text, std::size_t start);

}  // namespace rouleau::json
