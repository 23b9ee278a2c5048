// JSON pointers (RFC 6901) as text: "/cells/0/at" and its parts.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.hpp"

namespace rouleau::json {

/// The pointer of a member or element of what `parent` points to; `token` is unescaped.
inline std::string child_pointer(const std::string& parent, std::string_view token) {
  std::string pointer = parent + '/';
  for (const char c : token) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

inline std::string child_pointer(const std::string& parent, std::size_t index) {
  return parent + '/' + std::to_string(index);
}

/// Unescaped parts of a pointer; nothing when the text is no pointer ("" is the whole document: no parts).
inline std::optional<std::vector<std::string>> split_pointer(std::string_view pointer) {
  std::vector<std::string> tokens;
  if (pointer.empty()) return tokens;
  if (pointer.front() != '/') return std::nullopt;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] != '~') {
      tokens.back() += pointer[i];
    } else if (i + 1 < pointer.size() && (pointer[i + 1] == '0' || pointer[i + 1] == '1')) {
      tokens.back() += pointer[++i] == '0' ? '~' : '/';
    } else {
      return std::nullopt;
    }
  }
  return tokens;
}

/// The index that a token stands for in an array ("0", "17"; no sign, no leading zero), or nothing.
inline std::optional<std::size_t> array_index(std::string_view token) {
  if (token.empty() || token.size() > 9 || (token.size() > 1 && token.front() == '0')) return std::nullopt;
  std::size_t index = 0;
  for (const char c : token) {
    if (c < '0' || c > '9') return std::nullopt;
    index = 10 * index + static_cast<std::size_t>(c - '0');
  }
  return index;
}

/// How messages call the value at a pointer: "tau", "nodes[1]", or "the document".
inline std::string subject(std::string_view pointer) {
  const auto tokens = split_pointer(pointer);
  if (!tokens || tokens->empty()) return "the document";
  std::string name = "entry ";
  for (const auto& token : *tokens) {
    if (array_index(token)) {
      name += '[';
      name += token;
      name += ']';
    } else {
      name = token;
    }
  }
  return printable(name);
}

}  // namespace rouleau::json
