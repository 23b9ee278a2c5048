// --set POINTER=VALUE: changes one value of a document as if its file had been edited.
#include "document.hpp"
#include "json_pointer.hpp"
#include "parser.hpp"
#include "wording.hpp"

namespace rouleau::host {
namespace {

class Assignment {
 public:
  explicit Assignment(const std::string& assignment) : option_("--set " + assignment) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos) {
      refuse("POINTER=VALUE is wanted, for example --set /numerics/tau=0.8; there is no '=' here");
    }
    const auto pointer = assignment.substr(0, equals);
    const auto tokens = split_pointer(pointer);
    if (!tokens && !pointer.starts_with('/')) {
      refuse("a JSON pointer begins with '/'; write --set /" + assignment);
    }
    if (!tokens) refuse("in a JSON pointer '~' is written ~0, and '/' inside a key ~1");
    if (tokens->empty()) refuse("the pointer is empty; name one value, for example /numerics/tau");
    if (tokens->size() > deepest_nesting)
      refuse("the pointer has more than " + std::to_string(deepest_nesting) + " parts");
    tokens_ = *tokens;
    value_ = parse_value(assignment.substr(equals + 1));
  }

  /// Puts the value in and returns the pointer that names it now (without "-").
  std::string apply(nlohmann::json& root) const {
    auto* at = &root;
    std::string pointer;
    for (const auto& token : tokens_) {
      if (at->is_array()) {
        const auto index = index_in(*at, token, pointer);
        if (index == at->size()) at->push_back(nullptr);
        at = &(*at)[index];
        pointer = child_pointer(pointer, index);
      } else if (at->is_object() || (at->is_null() && at != &root)) {
        at = &(*at)[token];  // made when absent; the schema then says whether it may be there
        pointer = child_pointer(pointer, token);
      } else {
        refuse_inside(pointer, *at);
      }
    }
    *at = value_;
    return pointer;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error(ExitCode::bad_input, Place{option_, "", 0, 0}, problem);
  }

  [[noreturn]] void refuse_inside(const std::string& pointer, const nlohmann::json& value) const {
    const auto whole = pointer.empty() ? "the document" : pointer;
    refuse(whole + " is " + shown(value) + ", which has nothing inside; set " + whole + " itself");
  }

  /// Any JSON value; a bare word is a string. What begins like an object, array or string must be one.
  [[nodiscard]] nlohmann::json parse_value(const std::string& text) const {
    if (text.empty()) refuse("no value follows the '='; an empty text is written \"\"");
    try {
      return parse_json(text).root;
    } catch (const TextFault& fault) {
      const auto first = text.find_first_not_of(" \t");
      const bool bare =
          first == std::string::npos || std::string_view("{[\"").find(text[first]) == std::string_view::npos;
      if (bare && text.size() <= longest_string) return text;
      refuse("the value is not valid JSON, at its character " + std::to_string(fault.offset + 1) + ": " + fault.what());
    }
  }

  [[nodiscard]] std::size_t index_in(const nlohmann::json& array, const std::string& token,
                                     const std::string& pointer) const {
    const auto size = array.size();
    if (token == "-") return size;
    if (const auto index = array_index(token); index && *index < size) return *index;
    const auto last = size == 0 ? "" : size == 1 ? "0, or " : "0 to " + std::to_string(size - 1) + ", or ";
    refuse(pointer + " is a list of " + std::to_string(size) + "; " + in_quotes(token) + " is no place in it: write " +
           last + "- to append");
  }

  std::string option_;
  std::vector<std::string> tokens_;
  nlohmann::json value_;
};

}  // namespace

void Document::set(const std::string& assignment) { overrides_.push_back(Assignment(assignment).apply(root_)); }

}  // namespace rouleau::host
