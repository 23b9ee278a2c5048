// What nlohmann-json says of malformed text, as a sentence with its place.
#pragma once

#include <string>
#include <string_view>

#include "parser.hpp"

namespace rouleau::json {

/// The fault as an exception, to be thrown by the caller. `words`: what() of nlohmann-json's exception; `consumed`: bytes that
/// it had read; `opened`: offset of the innermost open '{' or '[', the text's size when none is; `pointer`: of that one.
TextFault syntax_fault(std::string_view text, const std::string& words, std::size_t consumed, std::size_t opened,
                       const std::string& pointer);

}  // namespace rouleau::json
