// Reads JSON text into values and into the tree of where each part stands, and says where it is no JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "json.hpp"

namespace rouleau::json {

class TextTree {
 public:
  using Index = std::size_t;

  /// Offsets into the text. `next` is the index of the node that follows the whole value, children included.
  struct Node {
    std::uint32_t key;    ///< of the member's key, or of the value where there is none
    std::uint32_t value;  ///< of the value's first character
    std::uint32_t next;
  };

  /// Adds a value in the text's order and returns its index; the root is the first. `close` when its children are
  /// there.
  Index open(std::size_t key, std::size_t value);
  void close(Index node) { nodes_[node].next = static_cast<std::uint32_t>(nodes_.size()); }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] const Node& operator[](Index node) const { return nodes_[node]; }

  /// Indices of the members or elements of a value, in the text's order.
  [[nodiscard]] std::vector<Index> children(Index node) const;

  /// Unescaped key of a member, and the member or element that a token of a JSON pointer names.
  [[nodiscard]] static std::string key(std::string_view text, std::size_t offset);
  [[nodiscard]] std::optional<Index> child(std::string_view text, Index node, const std::string& token) const;

 private:
  std::vector<Node> nodes_;
};

/// One past the closing quote of the JSON string that begins at `start`, or the text's size when it is not closed.
std::size_t end_of_string(std::string_view text, std::size_t start);

/// Line and column of an offset, both from 1; columns count bytes.
struct TextPosition {
  int line;
  int column;
};
TextPosition position(std::string_view text, std::size_t offset);

/// A fault in JSON text: what() is one sentence, with the offset it speaks of.
struct TextFault : std::runtime_error {
  TextFault(std::size_t at, const std::string& problem, std::string where = {})
      : std::runtime_error(problem), offset(at), pointer(std::move(where)) {}
  std::size_t offset;
  std::string pointer;  ///< of the object or array it lies in, where that is known
};

/// The fault as an exception, to be thrown by the caller. `words`: what() of nlohmann-json's exception; `consumed`:
/// bytes that it had read, `token` of them of the last token; `opened`: offset of the innermost open '{' or '[', the
/// text's size when none is; `pointer`: of that one.
TextFault syntax_fault(std::string_view text, const std::string& words, std::size_t consumed, std::size_t token,
                       std::size_t opened, const std::string& pointer);

/// Limits that keep a hostile or broken file from exhausting stack or memory.
inline constexpr std::size_t largest_text = 16U << 20U;  ///< bytes
inline constexpr std::size_t deepest_nesting = 200;      ///< objects and arrays within each other
inline constexpr std::size_t longest_string = 8192;      ///< bytes

struct ParsedText {
  nlohmann::json root;
  TextTree tree;
};

/// Throws TextFault for malformed JSON, duplicate keys, numbers that overflow and texts beyond the limits.
ParsedText parse_json(std::string_view text);

}  // namespace rouleau::json
