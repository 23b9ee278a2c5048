// What nlohmann-json says of malformed text, as a sentence with its place.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rouleau::json {

/// A fault in JSON text: what() is one sentence, with the offset it speaks of.
struct TextFault : std::runtime_error {
  TextFault(std::size_t at, const std::string& problem, std::string where = {})
      : std::runtime_error(problem), offset(at), pointer(std::move(where)) {}
  std::size_t offset;
  std::string pointer;  ///< of the object or array it lies in, where that is known
};

/// The fault as an exception, to be thrown by the caller. `words`: what() of nlohmann-json's exception; `consumed`:
/// bytes that it had read, `token` of them of the last token; `opened`: offset of the innermost open '{' or '[', the
/// text's size when none is; `pointer`: of that one.
TextFault syntax_fault(std::string_view text, const std::string& words, std::size_t consumed, std::size_t token,
                       std::size_t opened, const std::string& pointer);

}  // namespace rouleau::json
