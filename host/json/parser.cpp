#include "parser.hpp"

#include "base/text.hpp"
#include "json_pointer.hpp"

namespace rouleau::json {
namespace {

/// nlohmann-json's events with the place of each: a token begins after the previous one, white space, ',' and ':'.
class Reader final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Reader(std::string_view text, ParsedText& result) : text_(text), result_(result) {}

  bool null() override { return scalar(nullptr, 4); }
  bool boolean(bool value) override { return scalar(value, value ? 4 : 5); }
  bool number_integer(number_integer_t value) override { return number(value); }
  bool number_unsigned(number_unsigned_t value) override { return number(value); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    const auto start = skip_separators();
    check_length(value, start);
    return scalar(std::move(value), end_of_string(text_, start) - start);
  }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(nlohmann::json::object()); }
  bool start_array(std::size_t) override { return open(nlohmann::json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    const auto start = skip_separators();
    check_length(value, start);
    auto& object = containers_.back();
    if (object.value->contains(value)) {
      result_.tree.close(object.node);  // for now: its children so far can be looked up
      const auto first = result_.tree.child(text_, object.node, value);
      const auto line = position(text_, result_.tree[*first].key).line;
      throw TextFault(start,
                      "the key " + in_quotes(value) + " stands twice in the same object, first on line " +
                          std::to_string(line) + "; keep one of them",
                      child_pointer(pointer(), value));
    }
    key_ = value;
    key_start_ = start;
    cursor_ = end_of_string(text_, start);
    return true;
  }

  bool parse_error(std::size_t consumed, const std::string& token, const nlohmann::detail::exception& error) override {
    throw syntax_fault(text_, error.what(), consumed, token.size(), opened(), pointer());
  }

 private:
  struct Container {
    nlohmann::json* value;
    TextTree::Index node;
    std::string token;  ///< of this container in its parent
  };

  std::size_t skip_separators() {
    cursor_ = std::min(text_.find_first_not_of(" \t\r\n,:", cursor_), text_.size());
    return cursor_;
  }

  void check_length(const std::string& value, std::size_t start) const {
    if (value.size() <= longest_string) return;
    throw TextFault(start,
                    "this text has " + std::to_string(value.size()) + " bytes; at most " +
                        std::to_string(longest_string) + " are read",
                    pointer());
  }

  /// Puts a value into the container at hand and notes its place.
  nlohmann::json& add(nlohmann::json value) {
    const auto start = skip_separators();
    if (containers_.empty()) {
      result_.tree.open(start, start);
      return result_.root = std::move(value);
    }
    auto& container = *containers_.back().value;
    if (container.is_array()) {
      result_.tree.open(start, start);
      container.push_back(std::move(value));
      return container.back();
    }
    result_.tree.open(key_start_, start);
    return container[key_] = std::move(value);
  }

  bool scalar(nlohmann::json value, std::size_t length) {
    add(std::move(value));
    cursor_ += length;
    return true;
  }

  template <class Number>
  bool number(Number value) {
    const auto start = skip_separators();
    return scalar(value, text_.find_first_not_of("+-.0123456789eE", start) - start);
  }

  bool open(nlohmann::json value) {
    const auto start = skip_separators();
    if (containers_.size() == deepest_nesting) {
      throw TextFault(start, "objects and arrays lie more than " + std::to_string(deepest_nesting) +
                                 " deep within each other, which no file of this kind needs");
    }
    auto token = containers_.empty()                    ? std::string()
                 : containers_.back().value->is_array() ? std::to_string(containers_.back().value->size())
                                                        : key_;
    // Reading is sequential: a container is complete before its parent grows, so the address stays good.
    auto& added = add(std::move(value));
    containers_.push_back({&added, last_node(), std::move(token)});
    cursor_ = start + 1;
    return true;
  }

  bool close() {
    cursor_ = text_.find_first_of("]}", skip_separators()) + 1;
    result_.tree.close(containers_.back().node);
    containers_.pop_back();
    return true;
  }

  [[nodiscard]] TextTree::Index last_node() const { return result_.tree.size() - 1; }
  [[nodiscard]] std::size_t opened() const {
    return containers_.empty() ? text_.size() : result_.tree[containers_.back().node].value;
  }

  /// Of the container at hand.
  [[nodiscard]] std::string pointer() const {
    std::string pointer;
    for (std::size_t i = 1; i < containers_.size(); ++i) pointer = child_pointer(pointer, containers_[i].token);
    return pointer;
  }

  std::string_view text_;
  ParsedText& result_;
  std::vector<Container> containers_;
  std::string key_;
  std::size_t key_start_ = 0;
  std::size_t cursor_ = 0;  ///< end of the last token taken
};

}  // namespace

ParsedText parse_json(std::string_view text) {
  if (text.size() > largest_text) {
    throw TextFault(
        0, "the file has more than " + std::to_string(largest_text >> 20U) + " MiB, which no file of this kind needs");
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw TextFault(0, "the file is empty; it must hold one JSON object, written between { and }");
  }
  // nlohmann-json takes a NUL byte for the end of the text and would not look at what follows.
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    throw TextFault(nul, "a NUL byte stands here: this is no text file");
  }
  ParsedText result;
  Reader reader(text, result);
  nlohmann::json::sax_parse(text.begin(), text.end(), &reader);
  return result;
}

}  // namespace rouleau::json
