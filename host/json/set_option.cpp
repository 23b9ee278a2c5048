// --set POINTER=VALUE: changes one value of a document as if its file had been edited.
#include "base/text.hpp"
#include "document.hpp"
#include "parser.hpp"
#include "put_value.hpp"

namespace rouleau::json {
namespace {

class Assignment {
 public:
  explicit Assignment(const std::string& assignment) : option_("--set " + assignment) {
    try {
      (void)nlohmann::json(assignment).dump();
    } catch (const nlohmann::json::type_error&) {
      refuse("it is no UTF-8; write it in a terminal that is set to UTF-8");
    }
    const auto equals = assignment.find('=');
    if (equals == std::string::npos) {
      refuse("POINTER=VALUE is wanted, for example --set /numerics/tau=0.8; there is no '=' here");
    }
    pointer_ = assignment.substr(0, equals);
    if (!pointer_.empty() && !pointer_.starts_with('/')) {
      refuse("a JSON pointer begins with '/'; write --set /" + printable(assignment));
    }
    text_ = assignment.substr(equals + 1);
  }

  /// Puts the value in and returns the pointer that names it now (without "-").
  std::string apply(nlohmann::json& root) const {
    const nlohmann::json value = parse_value(text_);
    try {
      return put_value(root, pointer_, value);
    } catch (const PutError& error) {
      refuse(error.what());
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { throw Error(Cause::bad_input, Place{option_}, problem); }

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

  std::string option_, pointer_, text_;
};

}  // namespace

void Document::set(const std::string& assignment) {
  overrides_.push_back({Assignment(assignment).apply(root_), "--set"});
}

}  // namespace rouleau::json
