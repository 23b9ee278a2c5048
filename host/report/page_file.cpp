#include "page_file.hpp"

namespace rouleau::report {

std::string page_with(std::string_view page, const nlohmann::json& data) {
  // "</script>" or "<!--" inside a string of the data would end the data early: "<" is written as its escape.
  // Everything the pages show is set as text, never as markup.
  std::string text;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);

  constexpr std::string_view mark = "@ROULEAU_DATA@";
  std::string result(page);
  result.replace(result.find(mark), mark.size(), text);
  return result;
}

}  // namespace rouleau::report
