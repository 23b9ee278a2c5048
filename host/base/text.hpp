// How values, lists and suggestions are written in messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rouleau {

/// Text in double quotes, control characters escaped, shortened when long.
std::string in_quotes(std::string_view text);

/// Text without quotes, what steers a terminal escaped as in JSON: control characters, those of Latin-1 too, and those
/// that change the direction of writing.
std::string printable(std::string_view text);

/// The same of several lines, whose ends stay.
std::string printable_lines(std::string_view text);

/// Cut to eighty bytes, whole characters and "..." with `end` behind them; shorter text as it is.
std::string shortened(std::string text, std::string_view end = {});

/// "a, b, c"; "none" when empty.
std::string listed(const std::vector<std::string>& words);

/// The candidate that `word` was most likely meant to be, or empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The candidate that the word is, or is but for one letter in six; empty when there is none.
std::string misspelt(std::string_view word, const std::vector<std::string>& candidates);

/// A number as short as it can be read back with six digits, or with `digits`.
std::string number(double value, int digits = 6);

/// With so many digits after the point.
std::string decimals(double value, int digits);

/// To `digits` significant digits; a number with more digits before the point is written whole, not with a power of
/// ten, up to a million.
std::string rounded(double value, int digits);

/// "6.4 s", "42 s", "3.1 min", "22 h".
std::string time_in_words(double seconds);

/// Lines of more than `width` characters are broken at spaces, and go on below the last of their columns (which two
/// spaces part), at the border, or indented by two more than they are. No word is broken.
std::string folded(std::string_view text, std::size_t width);

/// The same after lines that begin with a letter have been joined to those before them that do: paragraphs.
std::string reflowed(std::string_view text, std::size_t width);

/// Lines after the first get the indent that Error gives the first.
std::string indented(std::string problem);

/// Of ASCII, whatever the locale.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace rouleau
