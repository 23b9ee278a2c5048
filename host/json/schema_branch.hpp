// Which branch of a schema's oneOf a user meant, judged by the keys of the value.
#pragma once

#include <string>
#include <vector>

#include "json.hpp"

namespace rouleau::json {

struct Choice {
  /// `branches` are the alternatives as the schema has them; they and `schema` must outlive this.
  Choice(const nlohmann::json& schema, const nlohmann::json& branches, const nlohmann::json& value);

  std::vector<const nlohmann::json*> possible;  ///< branches of the value's type
  std::vector<const nlohmann::json*> meant;     ///< those that share the most keys with the value; one when it is clear
  bool only_words = true;                       ///< every possible branch is a fixed word
  std::vector<std::string> words;               ///< fixed words among the branches
  std::vector<std::string> all_keys;            ///< keys of any possible branch
  std::vector<std::string> other_keys;          ///< keys of branches that are not meant
  std::vector<std::string> deciding_keys;       ///< required in one branch, unknown in another
  std::string wanted;                           ///< all branches in words
};

}  // namespace rouleau::json
