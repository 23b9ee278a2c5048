// Changes JSON texts for libFuzzer so that they stay JSON, with the keys and words of a schema.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::fuzz {

class JsonMutator {
 public:
  /// The schema must outlive it. Takes from the schema what a key's value may be; `more` are other words worth trying
  /// as keys and texts.
  explicit JsonMutator(const nlohmann::json& schema, std::vector<std::string> more = {});

  /// Changes data[0, size) in place, up to `most` bytes; returns the new size. Bytes that
  /// are no JSON, and one of ten texts that are, are changed byte by byte.
  std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) const;
  /// Puts a part of the second text into the first; 0 when either is no JSON.
  static std::size_t cross(const std::uint8_t* first, std::size_t first_size, const std::uint8_t* second,
                           std::size_t second_size, std::uint8_t* out, std::size_t most, unsigned seed);

 private:
  using Json = nlohmann::ordered_json;
  using Random = std::minstd_rand;

  void collect(const nlohmann::json& schema);
  void change(Json& root, Random& random) const;
  void change_value(Json& value, Random& random) const;
  void change_text(std::string& text, Random& random) const;
  [[nodiscard]] std::string some_text(Random& random) const;
  [[nodiscard]] Json some_value(Random& random) const;
  /// What the schema allows for a key; any value for a key that it does not know.
  [[nodiscard]] Json value_for(const std::string& key, Random& random) const;
  [[nodiscard]] Json fitting(const nlohmann::json& rule, int depth, Random& random) const;

  const nlohmann::json& schema_;
  std::vector<std::string> keys_, words_;
  std::map<std::string, std::vector<const nlohmann::json*>> rules_;  ///< of each key, wherever it may stand
};

}  // namespace rouleau::fuzz
