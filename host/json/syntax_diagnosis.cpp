#include "syntax_diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/text.hpp"

namespace rouleau::json {
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto lead = byte(at);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80U) return 0;
  }
  const auto second = byte(at + 1);
  const bool bad = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
                   (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F);
  return bad ? 0 : length;
}

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string byte_name(char c) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "byte 0x%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return name.data();
}

class Diagnosis {
 public:
  Diagnosis(std::string_view text, const Stumble& stumble) : text_(text), stumble_(stumble) {}

  [[nodiscard]] TextFault find() const {
    const auto p = skip(stumble_.cursor);
    switch (stumble_.after) {
      case Taken::nothing:
      case Taken::array_start:
        return value_wanted(p);
      case Taken::object_start:
        return key_wanted(p);
      case Taken::key:
        return at(p) == ':' ? value_wanted(skip(p + 1)) : unexpected(p, "a ':' is missing before");
      case Taken::value:
        return member_wanted(p);
      case Taken::document:
        return fault(p, "the document ends before this " + found(p) + "; only one JSON value may stand in a file");
    }
    return fault(p, "this is not JSON");
  }

 private:
  [[nodiscard]] char at(std::size_t p) const { return p < text_.size() ? text_[p] : '\0'; }
  [[nodiscard]] bool end(std::size_t p) const { return p >= text_.size(); }
  [[nodiscard]] std::size_t skip(std::size_t p) const {
    return std::min(text_.find_first_not_of(" \t\r\n", p), text_.size());
  }
  [[nodiscard]] TextFault fault(std::size_t p, const std::string& problem) const {
    return {p, problem, stumble_.pointer};
  }
  [[nodiscard]] std::string word(std::size_t p) const {
    auto stop = p;
    while (is_letter(at(stop)) || is_digit(at(stop))) ++stop;
    return std::string(text_.substr(p, stop - p));
  }

  /// What stands at p, as a message calls it.
  [[nodiscard]] std::string found(std::size_t p) const {
    if (is_letter(at(p))) return in_quotes(word(p));
    if (is_digit(at(p)) || at(p) == '-') return "number";
    if (at(p) == '"') return "text";
    const auto length = utf8_length(text_, p);
    if (length == 0 || static_cast<unsigned char>(at(p)) < 0x20 || at(p) == 0x7f) return byte_name(at(p));
    return "'" + std::string(text_.substr(p, length)) + "'";
  }

  [[nodiscard]] TextFault unclosed() const {
    if (stumble_.opened >= text_.size()) return fault(text_.size(), "the file ends where a value was to come");
    const auto open = at(stumble_.opened);
    return fault(text_.size(), std::string("the file ends too early: the '") + open + "' of line " +
                                   std::to_string(position(text_, stumble_.opened).line) + " is not closed by a '" +
                                   (open == '{' ? '}' : ']') + "'");
  }

  [[nodiscard]] TextFault unexpected(std::size_t p, const std::string& missing) const {
    if (end(p)) return unclosed();
    if (at(p) == '/' || at(p) == '#') return fault(p, "JSON has no comments; remove this one");
    return fault(p, missing + " this " + found(p));
  }

  /// After a value: ',' and another one, or the end of the object or array.
  [[nodiscard]] TextFault member_wanted(std::size_t p) const {
    const bool object = at(stumble_.opened) == '{';
    const char close = object ? '}' : ']';
    if (at(p) == ',') {
      const auto next = skip(p + 1);
      if (at(next) == close) return fault(p, std::string("remove this comma: nothing follows it but '") + close + "'");
      return object ? key_wanted(next) : value_wanted(next);
    }
    if (at(p) == (object ? ']' : '}')) {
      return fault(p, std::string("'") + at(p) + "' cannot close the '" + at(stumble_.opened) + "' of line " +
                          std::to_string(position(text_, stumble_.opened).line) + "; write '" + close + "'");
    }
    if (p > 0 && is_digit(at(stumble_.cursor - 1)) && (is_letter(at(p)) || at(p) == '%')) {
      return fault(p, "a number cannot be followed by " + found(p) +
                          "; a quantity with its unit stands in double quotes, as in \"1.2 cP\"");
    }
    if (is_letter(at(p)) && p == stumble_.cursor && at(p - 1) == '"') {
      return fault(p, "a text ends just before this " + found(p) +
                          ": either the double quote that ought to close an earlier text is missing, or one inside the "
                          "text is not written \\\"");
    }
    if (is_digit(at(p)) && p == stumble_.cursor) return broken_number(start_of_number(p));
    return unexpected(p, std::string("a ',' or '") + close + "' is missing before");
  }

  [[nodiscard]] TextFault key_wanted(std::size_t p) const {
    if (at(p) == '"') return broken_string(p);
    if (at(p) == '\'') return fault(p, "write keys in double quotes, not in single ones");
    if (is_letter(at(p))) return fault(p, "the key " + word(p) + " needs double quotes: " + in_quotes(word(p)));
    return unexpected(p, "a key in double quotes was to come, not");
  }

  [[nodiscard]] TextFault value_wanted(std::size_t p) const {
    const char c = at(p);
    if (c == '"') return broken_string(p);
    if (c == '\'') return fault(p, "write text in double quotes, not in single ones");
    const auto letters = word(p + (c == '-' || c == '+' ? 1 : 0));
    const auto same = [&](std::string_view other) {
      return std::equal(letters.begin(), letters.end(), other.begin(), other.end(),
                        [](char a, char b) { return (a | 0x20) == b; });
    };
    if (same("nan") || same("inf") || same("infinity")) {
      return fault(p, (c == '-' || c == '+' ? std::string(1, c) : "") + letters +
                          " is not a number that can be computed with; write a finite number");
    }
    if (is_digit(c) || c == '-' || c == '+' || c == '.') return broken_number(p);
    for (const char* literal : {"true", "false", "null"}) {
      if (same(literal)) return fault(p, "write " + std::string(literal) + " in lower case, not " + letters);
    }
    if (is_letter(c)) return fault(p, "the text " + letters + " needs double quotes: " + in_quotes(letters));
    if (c == ',' || c == '}' || c == ']') return fault(p, "a value is missing before this " + found(p));
    return unexpected(p, "a value was to come, not");
  }

  /// Back to where the number began of which the parser took only the first digits ("01").
  [[nodiscard]] std::size_t start_of_number(std::size_t p) const {
    while (p > 0 && (is_digit(at(p - 1)) || at(p - 1) == '-')) --p;
    return p;
  }

  [[nodiscard]] TextFault broken_number(std::size_t p) const {
    auto stop = p;
    while (is_letter(at(stop)) || is_digit(at(stop)) || at(stop) == '+' || at(stop) == '-' || at(stop) == '.') ++stop;
    const auto token = std::string(text_.substr(p, stop - p));
    if (end_of_number(text_, p) == stop && is_digit(token.back())) {
      return fault(p, in_quotes(token) + " is too large for a number: the limit is 1.8e308");
    }
    std::string remedy = "; numbers are written like 12, -0.5 or 6e-3";
    if (token.starts_with("+")) remedy = "; leave out the plus sign";
    if (token.starts_with(".")) remedy = "; write a zero before the point: 0" + token;
    if (token.ends_with(".")) remedy = "; write a digit after the point: " + token + "0";
    if (token.size() > 1 && token[0] == '0' && is_digit(token[1])) remedy = "; leave out the zeros in front";
    return fault(p, in_quotes(token) + " is not a number" + remedy);
  }

  /// The 16 bits of a \\uXXXX, or -1.
  [[nodiscard]] int escape_code(std::size_t p) const {
    if (at(p) != '\\' || at(p + 1) != 'u') return -1;
    int code = 0;
    for (std::size_t i = p + 2; i < p + 6; ++i) {
      const char c = static_cast<char>(at(i) | 0x20);
      if (!is_digit(at(i)) && (c < 'a' || c > 'f')) return -1;
      code = 16 * code + (is_digit(at(i)) ? at(i) - '0' : c - 'a' + 10);
    }
    return code;
  }

  /// Is \\uXXXX a character, or the first half of a pair whose second follows? (Second halves are met on their own.)
  [[nodiscard]] bool whole_escape(std::size_t p) const {
    const auto surrogate = [](int code, int first) { return code >= first && code < first + 0x400; };
    if (surrogate(escape_code(p), 0xD800)) return surrogate(escape_code(p + 6), 0xDC00);
    if (surrogate(escape_code(p), 0xDC00)) return p >= 6 && surrogate(escape_code(p - 6), 0xD800);
    return escape_code(p) >= 0;
  }

  [[nodiscard]] TextFault broken_string(std::size_t start) const {
    for (std::size_t p = start + 1; p < text_.size();) {
      const char c = text_[p];
      if (c == '"') break;
      if (c == '\n' || c == '\r')
        return fault(start, "the text that begins here is not closed by a double quote on its line");
      if (c == '\t') return fault(p, "a tab stands inside a text; write \\t or a blank");
      if (static_cast<unsigned char>(c) < 0x20)
        return fault(p, "the control character " + byte_name(c) + " stands inside a text");
      if (c == '\\') {
        if (std::string_view("\"\\/bfnrtu").find(at(p + 1)) == std::string_view::npos) {
          return fault(p, "'\\' must be followed by one of \" \\ / b f n r t u; a backslash itself is written \\\\");
        }
        if (at(p + 1) == 'u' && !whole_escape(p)) {
          return fault(p,
                       "this \\u is not followed by the four hexadecimal digits of a character (or by half of a pair)");
        }
        p += 2;
        continue;
      }
      const auto length = utf8_length(text_, p);
      if (length == 0) return fault(p, byte_name(c) + " is not valid UTF-8; save the file as UTF-8");
      p += length;
    }
    if (end_of_string(text_, start) >= text_.size())
      return fault(start, "the text that begins here is never closed by a double quote");
    return fault(start, "this text is not valid JSON: look at its \\u escapes");
  }

  std::string_view text_;
  const Stumble& stumble_;
};

}  // namespace

TextFault describe_malformed(std::string_view text, const Stumble& stumble) { return Diagnosis(text, stumble).find(); }

std::size_t end_of_number(std::string_view text, std::size_t start) {
  std::size_t p = start;
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : '\0'; };
  const auto digits = [&] {
    while (is_digit(at(p))) ++p;
  };
  if (at(p) == '-') ++p;
  if (at(p) == '0') {
    ++p;
  } else if (is_digit(at(p))) {
    digits();
  } else {
    return p;
  }
  if (at(p) == '.' && is_digit(at(p + 1))) {
    ++p;
    digits();
  }
  if (at(p) == 'e' || at(p) == 'E') {
    const auto sign = at(p + 1) == '+' || at(p + 1) == '-' ? 2U : 1U;
    if (is_digit(at(p + sign))) {
      p += sign;
      digits();
    }
  }
  return p;
}

}  // namespace rouleau::json
