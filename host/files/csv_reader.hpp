// Reads back the tables of a run's directory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rouleau::files {

/// A CSV file with a header line, as Tables writes it. A last line that a killed run left unfinished is dropped.
class StoredTable {
 public:
  /// Throws Error(input_output) when the file cannot be read.
  explicit StoredTable(const std::filesystem::path& file);
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] bool has(const std::string& column) const;
  /// Column as numbers; an empty or unreadable entry is NaN. Throws Error(bad_input) when there is no such column.
  [[nodiscard]] std::vector<double> numbers(const std::string& column) const;
  /// One more than the largest number in a column that numbers things from 0. Throws Error(bad_input) with the row
  /// for an entry that cannot be such a number.
  [[nodiscard]] std::size_t count_of(const std::string& column) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& column) const;

 private:
  [[nodiscard]] std::size_t index(const std::string& column) const;
  std::filesystem::path file_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace rouleau::files
