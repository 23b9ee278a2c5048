#include "document.hpp"

#include <utility>

#include "base/input_file.hpp"
#include "base/text.hpp"
#include "json_pointer.hpp"
#include "shown.hpp"

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
    if (equals == std::string::npos)
      refuse("POINTER=VALUE is wanted, for example --set /numerics/tau=0.8; there is no '=' here");
    pointer_ = assignment.substr(0, equals);
    if (!pointer_.empty() && !pointer_.starts_with('/'))
      refuse("a JSON pointer begins with '/'; write --set /" + printable(assignment));
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

Document Document::read(const std::filesystem::path& file) {
  return parse(read_input(file, largest_text), file.string());
}

Document Document::parse(std::string_view text, std::string file, Cause cause) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  Document document;
  document.file_ = std::move(file);
  document.text_ = text;
  try {
    auto parsed = parse_json(document.text_);
    document.root_ = std::move(parsed.root);
    document.tree_ = std::move(parsed.tree);
  } catch (const TextFault& fault) {
    const auto [line, column] = position(text, fault.offset);
    throw Error(cause, Place{document.file_, fault.pointer, line, column}, fault.what());
  }
  return document;
}

Place Document::place(const std::string& pointer) const { return place_of(pointer, false); }
Place Document::key_place(const std::string& pointer) const { return place_of(pointer, true); }

void Document::put(const std::string& pointer, const nlohmann::json& value, const std::string& origin) {
  overrides_.push_back({put_value(root_, pointer, value), origin});
}

const Document::Override* Document::override_at(const std::string& pointer) const {
  for (const Override& override : overrides_)
    if (pointer == override.pointer || pointer.starts_with(override.pointer + '/')) return &override;
  return nullptr;
}

Place Document::place_of(const std::string& pointer, bool of_key) const {
  if (const Override* override = override_at(pointer)) return {override->origin, pointer, 0, 0};
  if (tree_.size() == 0) return {file_, pointer, 0, 0};
  TextTree::Index node = 0;
  bool found = true;
  std::string reached;
  for (const auto& token : split_pointer(pointer).value_or(std::vector<std::string>{})) {
    reached = child_pointer(reached, token);
    const auto child = override_at(reached) != nullptr ? std::nullopt : tree_.child(text_, node, token);
    found = child.has_value();
    if (!found) break;
    node = *child;
  }
  const auto [line, column] = position(text_, found && of_key ? tree_[node].key : tree_[node].value);
  return {file_, pointer, line, column};
}

void Document::set(const std::string& assignment) {
  overrides_.push_back({Assignment(assignment).apply(root_), "--set"});
}

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
