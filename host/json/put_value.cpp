#include "put_value.hpp"

#include <string_view>

#include "base/text.hpp"
#include "json_pointer.hpp"
#include "parser.hpp"
#include "shown.hpp"

namespace rouleau::json {
namespace {

std::size_t put_index(const nlohmann::json& array, const std::string& token, const std::string& pointer) {
  const auto size = array.size();
  if (token == "-") return size;
  if (const auto index = array_index(token); index && *index < size) return *index;
  const auto last = size == 0 ? "" : size == 1 ? "0, or " : "0 to " + std::to_string(size - 1) + ", or ";
  throw PutError(printable(pointer) + " is a list of " + std::to_string(size) + "; " + in_quotes(token) +
                 " is no place in it: write " + last + "- to append");
}

std::vector<std::string> put_tokens(const std::string& pointer) {
  const auto tokens = split_pointer(pointer);
  if (!pointer.empty() && !pointer.starts_with('/'))
    throw PutError(in_quotes(pointer) + " is no JSON pointer, which begins with '/', such as /numerics/tau");
  if (!tokens) throw PutError("in a JSON pointer '~' is written ~0, and '/' inside a key ~1");
  if (tokens->empty()) throw PutError("the pointer is empty; name one value, for example /numerics/tau");
  if (tokens->size() > deepest_nesting)
    throw PutError("the pointer has more than " + std::to_string(deepest_nesting) + " parts");
  return *tokens;
}

}  // namespace

std::string put_value(nlohmann::json& root, const std::string& whole, const nlohmann::json& value) {
  auto* at = &root;
  std::string pointer;
  for (const auto& token : put_tokens(whole)) {
    if (at->is_array()) {
      const auto index = put_index(*at, token, pointer);
      if (index == at->size()) at->push_back(nullptr);
      at = &(*at)[index];
      pointer = child_pointer(pointer, index);
    } else if (at->is_object() || (at->is_null() && at != &root)) {
      at = &(*at)[token];  // made when absent; the schema then says whether it may be there
      pointer = child_pointer(pointer, token);
    } else {
      const auto holder = pointer.empty() ? "the document" : printable(pointer);
      throw PutError(holder + " is " + shown(*at) + ", which has nothing inside; set " + holder + " itself");
    }
  }
  *at = value;
  return pointer;
}

}  // namespace rouleau::json
