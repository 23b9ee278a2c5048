#include "syntax_fault.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "text_tree.hpp"

namespace rouleau::json {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// What to do about the usual slips of the pen; empty: this is none. `at`: where the word or sign begins.
std::string remedy_of(std::string_view text, std::size_t at, bool wants_end) {
  const char c = text[at];
  const std::size_t before = at > 0 ? text.find_last_not_of(" \t\r\n", at - 1) : std::string_view::npos;
  const char last = before == std::string_view::npos ? '\0' : text[before];
  if (c == '/' || c == '#') return "JSON has no comments; remove this one";
  if ((c == '}' || c == ']') && last == ',') return std::string("remove the comma before this '") + c + "'";
  if (c == '\'') return "write text in double quotes, not in single ones";
  if (wants_end && (c == '"' || c == '{' || c == '[' || (is_digit(c) && !is_digit(text[at - 1]))))
    return "a ',' is missing before it";
  if (c == '+' || c == '-' || c == '.' || is_digit(c)) return "numbers are written like 12, -0.5 or 6e-3";
  if (!is_letter(c) && c != '%') return "";
  std::size_t end = at;
  while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
  std::string word(text.substr(at, end - at));
  const std::string quoted = in_quotes(word);
  if (is_digit(last)) return "a quantity with its unit stands in double quotes, as in \"1.2 cP\"";
  std::transform(word.begin(), word.end(), word.begin(), [](char letter) { return static_cast<char>(letter | 0x20); });
  if (word == "nan" || word == "inf" || word == "infinity") return "write a finite number";
  if (word == "true" || word == "false" || word == "null") return "write " + word + " in lower case";
  return "the text " + quoted + " needs double quotes";
}

}  // namespace

TextFault syntax_fault(std::string_view text, const std::string& words, std::size_t consumed, std::size_t token,
                       std::size_t opened, const std::string& pointer) {
  const bool ended = consumed > text.size();
  std::size_t at = ended ? text.size() : std::max<std::size_t>(consumed, 1) - 1;
  if (words.find("number overflow") != std::string::npos)
    return {at, "a number is too large: the limit is 1.8e308", pointer};
  std::string remedy;
  if (ended && opened < text.size()) {
    remedy = std::string("the file ends before the '") + text[opened] + "' of line " +
             std::to_string(position(text, opened).line) + " is closed";
  } else if (!ended) {
    if (words.find("unexpected string") != std::string::npos || words.find("unexpected number") != std::string::npos)
      at -= std::min(at, std::max<std::size_t>(token, 1) - 1);
    if (words.find("invalid literal") != std::string::npos)
      while (at > 0 && is_letter(text[at - 1])) --at;
    const bool wants_end = words.ends_with("expected '}'") || words.ends_with("expected ']'");
    if (words.find("invalid string") == std::string::npos) remedy = remedy_of(text, at, wants_end);
  }
  // "... syntax error while parsing object - unexpected '}'; expected string literal", after an invalid token with
  // "; last read: '...'" before the end.
  std::string said = "this is not JSON";
  if (const auto begin = words.find("while parsing"); begin != std::string::npos) {
    const auto read = words.find("; last read: ", begin), wanted = words.rfind("; expected ");
    said += ": " + words.substr(begin, read - begin);
    if (read != std::string::npos && wanted != std::string::npos && wanted > read) said += words.substr(wanted);
  }
  return {at, remedy.empty() ? said : said + "; " + remedy, pointer};
}

}  // namespace rouleau::json
