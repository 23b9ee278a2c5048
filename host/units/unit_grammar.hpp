// What a text must look like to be handed to UDUNITS as a unit.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace rouleau::units {

/// The symbols of a unit in their order, parts of `unit`; nothing if it has not the shape
///   unit    = "1" | [ "1/" ] product
///   product = factor { [ "*" | "." | "·" | "-" | "/" | " per " ] factor }    with spaces anywhere between them
///   factor  = ( symbol | "(" product ")" ) [ power ]
///   power   = [ "^" | "**" ] [ sign ] digit [ digit ] | superscript digit [ superscript digit ]
/// UDUNITS 2.2.28 knows more, but takes any number for a factor ("um 2" is 2 um), which hides slips of the pen,
/// overlooks what follows a NUL or a ")" too many, and leaks the word it has just read wherever it finds out that
/// something is wrong. What has this shape, and symbols that it knows, it takes to the end.
std::optional<std::vector<std::string_view>> symbols_of(std::string_view unit);

}  // namespace rouleau::units
