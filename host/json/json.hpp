// nlohmann-json, reading whole numbers from whole numbers alone. Everything that reads JSON includes it by this header.
//
// On its own the library casts: 1.5 is read as 1, 5000000000 as another int, and what a cast of 1e300 to an integer
// does is undefined. A file that was made by somebody else may hold any of them.
#pragma once

#include <concepts>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

/// Reading a number that is not whole, or that `Integer` cannot hold, throws nlohmann::json::out_of_range; other kinds
/// of values throw nlohmann::json::type_error, as ever.
template <std::integral Integer>
requires(!std::same_as<Integer, bool>) struct nlohmann::adl_serializer<Integer, void> {
  template <class Json>
  static void to_json(Json& json, Integer value) {
    nlohmann::to_json(json, value);
  }

  template <class Json>
  static void from_json(const Json& json, Integer& value) {
    bool fits = true;
    if (json.is_number_unsigned()) {
      fits = std::in_range<Integer>(*json.template get_ptr<const typename Json::number_unsigned_t*>());
    } else if (json.is_number_integer()) {
      fits = std::in_range<Integer>(*json.template get_ptr<const typename Json::number_integer_t*>());
    } else if (json.is_number_float()) {
      fits = false;
    }
    if (!fits) throw detail::out_of_range::create(406, "no whole number that fits in here: " + json.dump(), &json);
    nlohmann::from_json(json, value);
  }
};
