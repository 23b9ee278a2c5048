// The tables of a run: cells.csv, aggregates.csv, series.csv and aggregate_sizes.csv, a block of rows per output time.
// observe/observables.hpp says what their columns hold. aggregates.csv has one row per contact, with the aggregate both
// cells belong to; an aggregate without any contact (a lone cell) has one row whose contact columns are empty. So
// drop_duplicates(["step", "aggregate"]) lists the aggregates and dropna(subset=["gap_m"]) the contacts.
//
// Units stand in the column names. Numbers have the fewest digits that read back as the same double, whatever the
// locale; infinite and undefined ones are inf and nan. Text is quoted as in RFC 4180 where it must be.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "file.hpp"
#include "observe/observable.hpp"
#include "observe/snapshot.hpp"

namespace rouleau::files {

/// Shortest text that reads back as the same number; "inf", "-inf", "nan".
std::string to_text(double value);

/// Text as an entry of a CSV table: in quotes where it must be (RFC 4180).
std::string csv_text(const std::string& text);

class Tables {
 public:
  /// How much of each of the files there is, in the order of observe::tables().
  using Mark = std::array<FileMark, 4>;

  /// Throws Error(input_output) unless the files begin with what they held at the mark.
  static void require(const std::filesystem::path& directory, const Mark& mark);

  /// Creates the four files in `directory` with their header lines. Throws Error(input_output), as all members do.
  Tables(const std::filesystem::path& directory, const observe::RunKind& run, Kept kept = Kept::on_disk);
  /// Opens them, and drops what was written after the mark.
  Tables(const std::filesystem::path& directory, const observe::RunKind& run, const Mark& mark);
  void write(const observe::Snapshot& snapshot);
  /// To the disk.
  Mark mark();
  void close();

 private:
  observe::RunKind run_;  ///< decides on columns
  std::vector<AppendFile> files_;
};

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
