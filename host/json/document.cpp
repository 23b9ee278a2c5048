#include "document.hpp"

#include <utility>

#include "base/input_file.hpp"
#include "json_pointer.hpp"
#include "parser.hpp"
#include "put_value.hpp"

namespace rouleau::json {
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
  for (const Override& override : overrides_) {
    if (pointer == override.pointer || pointer.starts_with(override.pointer + '/')) return &override;
  }
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

}  // namespace rouleau::json
