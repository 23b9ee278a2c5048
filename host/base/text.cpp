#include "text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace rouleau {
namespace {

constexpr std::size_t longest_shown = 80;

/// Distance in insertions, deletions, replacements and swaps of neighbours; upper and lower case count as the same.
std::size_t spelling_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

struct Character {
  unsigned code;     ///< of Unicode; a byte that begins no character stands for itself
  std::size_t size;  ///< bytes
};

/// The first character of a text that is not empty, in UTF-8. Only characters of two and three bytes are taken apart:
/// nothing longer steers a terminal.
Character next_character(std::string_view text) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const auto follows = [&](std::size_t k) { return (byte(k) & 0xC0U) == 0x80U; };
  if ((byte(0) & 0xE0U) == 0xC0U && follows(1)) return {(byte(0) & 0x1FU) << 6 | (byte(1) & 0x3FU), 2};
  if ((byte(0) & 0xF0U) == 0xE0U && follows(1) && follows(2))
    return {(byte(0) & 0x0FU) << 12 | (byte(1) & 0x3FU) << 6 | (byte(2) & 0x3FU), 3};
  if ((byte(0) & 0xF8U) == 0xF0U && follows(1) && follows(2) && follows(3)) return {0x10000, 4};
  return {byte(0), 1};
}

/// Control characters of ASCII and of Latin-1, line and paragraph separators, and what changes the direction of
/// writing.
bool steers(unsigned code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

/// Characters, not bytes: 10xxxxxx continue one.
std::size_t length_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0U) != 0x80U; }));
}

/// Where a line goes on that is too long: below its last column, if that leaves room, or a little further in.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  std::size_t column = begin == 0 ? 0 : begin + 2;  // paragraphs stand at the border
  for (std::size_t gap = line.find("  ", begin); gap != std::string_view::npos; gap = line.find("  ", gap + 1)) {
    const std::size_t next = line.find_first_not_of(' ', gap);
    if (next != std::string_view::npos && length_of(line.substr(0, next)) <= width * 3 / 5)
      column = length_of(line.substr(0, next));
  }
  return column;
}

std::string folded_line(std::string_view line, std::size_t width) {
  if (length_of(line) <= width) return std::string(line);
  const std::size_t indent = hanging_indent(line, width);
  std::string text, row;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t word = std::min(line.find_first_not_of(' ', at), line.size());
    const std::size_t end = std::min(line.find(' ', word), line.size());
    const std::string_view piece = line.substr(at, end - at);
    if (row.find_first_not_of(' ') != std::string::npos && length_of(row) + length_of(piece) > width) {
      text += row + '\n';
      row = std::string(indent, ' ') + std::string(line.substr(word, end - word));
    } else {
      row += piece;
    }
    at = end;
  }
  return text + row;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const auto [code, size] = next_character(text.substr(at));
    if (steers(code)) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x", code);
      result += escape.data();
    } else {
      result += text.substr(at, size);
    }
    at += size;
  }
  return result;
}

std::string printable_lines(std::string_view text) {
  std::string safe;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    safe += (at == 0 ? "" : "\n") + printable(text.substr(at, end - at));
    at = end + 1;
  }
  return safe;
}

std::string shortened(std::string text, std::string_view end) {
  if (text.size() <= longest_shown) return text;
  std::size_t length = longest_shown - 3;
  // A character of several bytes is not cut: bytes 10xxxxxx continue one.
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return text.substr(0, length) + "..." + std::string(end);
}

std::string in_quotes(std::string_view text) {
  // JSON escapes all control characters but DEL, and bytes that are no UTF-8 become U+FFFD.
  const auto replace = nlohmann::json::error_handler_t::replace;
  return shortened(printable(nlohmann::json(std::string(text)).dump(-1, ' ', false, replace)), "\"");
}

std::string listed(const std::vector<std::string>& words) {
  if (words.empty()) return "none";
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + printable(word);
  return text;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest_word = 64;
  std::string best;
  if (word.empty() || word.size() > longest_word) return best;
  std::size_t best_distance = word.size() <= 2 ? 2 : std::max<std::size_t>(2, word.size() / 3 + 1);
  for (const auto& candidate : candidates) {
    if (candidate.size() > longest_word) continue;
    auto distance = spelling_distance(word, candidate);
    // A word cut short or drawn out ("params", "nodes_xy") is near although many letters differ.
    const auto shorter = std::min(word.size(), candidate.size());
    const auto same = static_cast<std::size_t>(
        std::mismatch(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(shorter), candidate.begin()).first -
        word.begin());
    const bool begins_alike = same >= 3 && same + 1 >= shorter && word.size() != candidate.size();
    if (begins_alike) distance = std::min<std::size_t>(distance, 1);
    if (distance >= std::max(word.size(), candidate.size())) continue;  // nothing in common
    const bool same_first = word.front() == candidate.front() && (best.empty() || word.front() != best.front());
    if (distance < best_distance || (distance == best_distance && !best.empty() && same_first)) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string misspelt(std::string_view word, const std::vector<std::string>& candidates) {
  const auto near = nearest(word, candidates);
  return !near.empty() && spelling_distance(word, near) <= word.size() / 6 ? near : "";
}

std::string number(double value, int digits) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string decimals(double value, int digits) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string rounded(double value, int digits) {
  const bool whole = std::abs(value) >= std::pow(10, digits) && std::abs(value) < 1e6;
  return whole ? number(std::round(value), 7) : number(value, digits);
}

std::string time_in_words(double seconds) {
  if (seconds < 120) return rounded(seconds, 2) + " s";
  return seconds < 7200 ? rounded(seconds / 60, 2) + " min" : rounded(seconds / 3600, 2) + " h";
}

std::string folded(std::string_view text, std::size_t width) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    result += folded_line(text.substr(at, end - at), width);
    if (end < text.size()) result += '\n';
    at = end + 1;
  }
  return result;
}

std::string reflowed(std::string_view text, std::size_t width) {
  std::string joined(text);
  const auto in_paragraph = [&](std::size_t at) {
    return at < joined.size() && joined[at] != ' ' && joined[at] != '\n';
  };
  std::size_t line = 0;  // where the present one begins
  for (std::size_t end = joined.find('\n'); end != std::string::npos; end = joined.find('\n', end + 1))
    if (in_paragraph(line) && in_paragraph(end + 1))
      joined[end] = ' ';
    else
      line = end + 1;
  return folded(joined, width);
}

std::string indented(std::string problem) {
  for (auto at = problem.find('\n'); at != std::string::npos; at = problem.find('\n', at + 1))
    problem.insert(at + 1, "  ");
  return problem;
}

}  // namespace rouleau
