#include "text_tree.hpp"

#include <algorithm>

#include "json.hpp"
#include "json_pointer.hpp"

namespace rouleau::json {

TextTree::Index TextTree::open(std::size_t key, std::size_t value) {
  const auto index = nodes_.size();
  nodes_.push_back(
      {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(index + 1)});
  return index;
}

std::vector<TextTree::Index> TextTree::children(Index node) const {
  std::vector<Index> found;
  for (Index child = node + 1; child < nodes_[node].next; child = nodes_[child].next) found.push_back(child);
  return found;
}

std::string TextTree::key(std::string_view text, std::size_t offset) {
  const auto end = end_of_string(text, offset);
  const auto inside = text.substr(offset + 1, end - offset - 2);
  if (inside.find('\\') == std::string_view::npos) return std::string(inside);
  return nlohmann::json::parse(text.substr(offset, end - offset)).get<std::string>();
}

std::optional<TextTree::Index> TextTree::child(std::string_view text, Index node, const std::string& token) const {
  const bool array = text[nodes_[node].value] == '[';
  if (!array && text[nodes_[node].value] != '{') return std::nullopt;
  const auto index = array_index(token);
  if (array && !index) return std::nullopt;
  std::size_t count = 0;
  for (Index at = node + 1; at < nodes_[node].next; at = nodes_[at].next, ++count) {
    if (array ? count == *index : key(text, nodes_[at].key) == token) return at;
  }
  return std::nullopt;
}

std::size_t end_of_string(std::string_view text, std::size_t start) {
  for (std::size_t i = start + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      return i + 1;
    }
  }
  return text.size();
}

TextPosition position(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, std::min(offset, text.size()));
  const auto line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
          static_cast<int>(before.size() - line_start) + 1};
}

}  // namespace rouleau::json
