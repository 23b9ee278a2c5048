// Where each value of a JSON text lies: a flat tree in the text's order, twelve bytes a value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace rouleau::json
