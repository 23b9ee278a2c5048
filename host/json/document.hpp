// JSON text with the place of every value: what nlohmann-json does not keep and a good error needs.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "json.hpp"
#include "parser.hpp"

namespace rouleau::json {

/// A parsed JSON file. Duplicate keys, NaN and infinite numbers, and anything after the document are errors, and so are
/// files beyond the limits of parser.hpp. Lines and columns count from 1, columns in bytes.
class Document {
 public:
  /// Reads a file; throws what InputFile does, and Error(bad_input) with line and column when malformed.
  static Document read(const std::filesystem::path& file);
  /// Parses text; `file` is only for messages. `cause` is that of the errors it throws.
  static Document parse(std::string_view text, std::string file, Cause cause = Cause::bad_input);

  [[nodiscard]] const nlohmann::json& root() const { return root_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& text() const { return text_; }

  /// Place of the value at a JSON pointer; of its nearest ancestor in the text if it is absent. A value that the text
  /// does not have has no line: its place reads "--set /pointer", or names what else put it there.
  [[nodiscard]] Place place(const std::string& pointer) const;
  /// Place of the key of the member at `pointer` rather than of its value.
  [[nodiscard]] Place key_place(const std::string& pointer) const;

  /// Replaces or adds the value at "POINTER=VALUE" (as in --set). Throws Error(bad_input) naming the option.
  void set(const std::string& assignment);
  /// Replaces or adds a value; `origin` stands for the file's name in its place. Throws PutError.
  void put(const std::string& pointer, const nlohmann::json& value, const std::string& origin);

  /// Was the value at `pointer`, or one that holds it, made by set() or put()?
  [[nodiscard]] bool overridden(const std::string& pointer) const { return override_at(pointer) != nullptr; }
  /// Places in the text's order, for whoever walks the whole document; offsets are into text().
  [[nodiscard]] const TextTree& tree() const { return tree_; }

 private:
  [[nodiscard]] Place place_of(const std::string& pointer, bool of_key) const;

  struct Override {
    std::string pointer, origin;  ///< of a value that the text does not have
  };
  /// What put the value at `pointer`, or one that holds it, into the document; null for values of the text.
  [[nodiscard]] const Override* override_at(const std::string& pointer) const;

  nlohmann::json root_;
  std::string file_;
  std::string text_;
  TextTree tree_;
  std::vector<Override> overrides_;
};

/// Thrown for a pointer that is none or that leads nowhere; what() is one sentence for the user.
class PutError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Puts `value` into `root` at a JSON pointer. Members that are absent are made (a schema then says whether they may be
/// there), "-" appends to a list. Returns the pointer that names the value now, without "-". Throws PutError.
std::string put_value(nlohmann::json& root, const std::string& pointer, const nlohmann::json& value);

}  // namespace rouleau::json
