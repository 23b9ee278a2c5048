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

}  // namespace rouleau::files
