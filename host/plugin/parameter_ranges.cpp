#include "parameter_ranges.hpp"

#include "base/text.hpp"

namespace rouleau::plugin {

std::string value_text(double si, const Parameter& parameter, const units::Units& units) {
  const std::string text = number(si / units.scale(parameter.unit));
  return parameter.unit == "1" ? text : text + ' ' + parameter.unit;
}

std::string violated_limit(double value, const Parameter& parameter, const units::Units& units) {
  const auto text = [&](const char* words, double limit) { return words + value_text(limit, parameter, units); };
  if (const auto limit = parameter.minimum; limit && value < *limit && !same_quantity(value, *limit)) {
    return text("at least ", *limit);
  }
  if (const auto limit = parameter.exclusive_minimum; limit && (value <= *limit || same_quantity(value, *limit))) {
    return text("above ", *limit);
  }
  if (const auto limit = parameter.maximum; limit && value > *limit && !same_quantity(value, *limit)) {
    return text("at most ", *limit);
  }
  if (const auto limit = parameter.exclusive_maximum; limit && (value >= *limit || same_quantity(value, *limit))) {
    return text("below ", *limit);
  }
  return {};
}

bool is_unusual(double value, const Parameter& parameter) {
  if (!parameter.usual) return false;
  const auto [low, high] = *parameter.usual;
  return (value < low && !same_quantity(value, low)) || (value > high && !same_quantity(value, high));
}

}  // namespace rouleau::plugin
