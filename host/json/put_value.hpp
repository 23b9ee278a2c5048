// Changes one value inside a JSON document by its pointer, as --set and the matrix of a study do.
#pragma once

#include <stdexcept>
#include <string>

#include "json.hpp"

namespace rouleau::json {

/// Thrown for a pointer that is none or that leads nowhere; what() is one sentence for the user.
class PutError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Puts `value` into `root` at a JSON pointer. Members that are absent are made (a schema then says whether they may be
/// there), "-" appends to a list. Returns the pointer that names the value now, without "-". Throws PutError.
std::string put_value(nlohmann::json& root, const std::string& pointer, const nlohmann::json& value);

}  // namespace rouleau::json
