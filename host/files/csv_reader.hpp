// Reads back the tables of a run's directory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rouleau::files {

/// A CSV file with a header line, as Tables writes it. A last line that a killed run left unfinished is dropped.
class StoredTable {
 public:
  /// Throws Error(input_output) when the file cannot be read.
  explicit StoredTable(const std::filesystem::path& file);
  [[nodiscard]] std::size_t rows() const { return header_.empty() ? 0 : (begin_.size() - 1) / header_.size(); }
  [[nodiscard]] bool has(const std::string& column) const;
  /// Column as numbers; an empty or unreadable entry is NaN. Throws Error(bad_input) when there is no such column.
  [[nodiscard]] std::vector<double> numbers(const std::string& column) const;
  /// One more than the largest number in a column that numbers things from 0. Throws Error(bad_input) with the row
  /// for an entry that cannot be such a number.
  [[nodiscard]] std::size_t count_of(const std::string& column) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& column) const;

 private:
  [[nodiscard]] std::size_t index(const std::string& column) const;
  [[nodiscard]] std::string_view entry(std::size_t row, std::size_t column) const {
    const std::size_t at = row * header_.size() + column;
    return std::string_view(text_).substr(begin_[at], begin_[at + 1] - begin_[at]);
  }
  std::filesystem::path file_;
  std::vector<std::string> header_;
  std::string text_;                      // all entries, one after another
  std::vector<std::size_t> begin_ = {0};  // of each, row by row, and the end
};

}  // namespace rouleau::files
