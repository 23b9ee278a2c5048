// The text of a mesh file, read word by word, and the formats that are read so.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/surface/triangle_surface.hpp"

namespace rouleau::shape {

/// What to do about a mesh file that is damaged, whatever is wrong in it.
inline constexpr const char* write_anew = "write the mesh anew, as OBJ, OFF, PLY or STL";

/// A file's text, read word by word.
class Words {
 public:
  Words(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) {}

  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error(Cause::bad_input, {name_, {}, line_, 0}, problem, {write_anew});
  }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  /// The next word; empty at the end. `#` begins a comment.
  std::string_view next() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  /// The words that are left of this line.
  std::vector<std::string_view> rest() {
    std::vector<std::string_view> words;
    for (;;) {
      while (at_ < text_.size() && text_[at_] != '\n' && is_blank(text_[at_])) ++at_;
      if (at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '#') return words;
      words.push_back(next());
    }
  }
  template <class T>
  T number(const char* what) {
    const std::string_view word = next();
    if (word.empty()) refuse(std::string("ends where ") + what + " is expected");
    return number<T>(word, what);
  }
  template <class T>
  T number(std::string_view word, const char* what) const {
    T value{};
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const auto [end, error] = std::from_chars(word.data() + (plus ? 1 : 0), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      refuse(in_quotes(std::string(word)) + " stands where " + what + " is expected");
    }
    return value;
  }
  /// A backslash at the end of a line joins it with the next one. Before anything is read.
  void join_lines() {
    std::string joined;
    int owed = 0;  // ends of lines, which follow the joined one so that later lines keep their numbers
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const bool crlf = text_.compare(i, 3, "\\\r\n") == 0;
      if (crlf || text_.compare(i, 2, "\\\n") == 0) {
        joined += ' ';
        i += crlf ? 2 : 1;
        ++owed;
        continue;
      }
      joined += text_[i];
      if (text_[i] == '\n') joined.append(static_cast<std::size_t>(std::exchange(owed, 0)), '\n');
    }
    text_ = std::move(joined);
  }
  /// A number of things that the rest of the file has room for.
  std::size_t count(const char* what) {
    const auto value = number<std::size_t>(what);
    if (value > size())
      refuse(std::string(what) + " is " + std::to_string(value) + ", more than the file has room for");
    return value;
  }
  std::string_view rest_of_line() {
    const std::size_t begin = at_, end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return std::string_view(text_).substr(begin, end - begin);
  }
  /// Bytes from the present place on.
  std::string_view bytes(std::size_t wanted, const char* what) {
    if (text_.size() - at_ < wanted) refuse(std::string("ends within ") + what);
    at_ += wanted;
    return std::string_view(text_).substr(at_ - wanted, wanted);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  void skip_blanks() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      if (at_ == text_.size() || !is_blank(text_[at_])) return;
    }
  }
  std::string text_, name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Cut into triangles.
void add_face(core::TriangleSurface& surface, const std::vector<int>& corners, const Words& words);

// What the file says, whether it is closed or not. Every corner of STL is a node of its own. They throw
// Error(bad_input).
core::TriangleSurface read_off(Words& words);
core::TriangleSurface read_obj(Words& words);
core::TriangleSurface read_ply(Words& words);
core::TriangleSurface read_stl_text(Words& words);
core::TriangleSurface read_stl_binary(Words& words);

}  // namespace rouleau::shape
