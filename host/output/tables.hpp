// The tables of a run: cells.csv, aggregates.csv, aggregate_sizes.csv and series.csv, a block of rows per output time.
// time.
//
// cells.csv       one row per output time and cell
// aggregates.csv  one row per output time and contact, with the aggregate both cells belong to; an aggregate without
//                 any contact (a lone cell) has one row whose contact columns are empty. So
//                 drop_duplicates(["step", "aggregate"]) lists the aggregates and dropna(subset=["gap_m"]) the
//                 contacts. image_x, image_y: periodic shift of cell_b in boxes. members: cells joined by "+".
//                 rotation_rad: angle against x of the line through the aggregate's two outermost cells (Snapshot);
//                 empty for lone cells.
// series.csv      one row per output time: what belongs to the whole suspension; rotation_rad is that of the largest
//                 aggregate
// aggregate_sizes.csv  one row per output time and size that occurs: how many aggregates have so many cells
//
// Units stand in the column names. Numbers have the fewest digits that read back as the same double, whatever the
// locale; infinite and undefined ones are inf and nan. Text is quoted as in RFC 4180 where it must be.
#pragma once

#include <filesystem>

#include "output/file.hpp"
#include "output/snapshot.hpp"

namespace rouleau::host {

/// Shortest text that reads back as the same number; "inf", "-inf", "nan".
std::string to_text(double value);

class Tables {
 public:
  /// Creates the four files in `directory` with their header lines. Throws Error(input_output), as all members do.
  explicit Tables(const std::filesystem::path& directory);
  void write(const Snapshot& snapshot);
  void close();

 private:
  void write_cells(const Snapshot& snapshot);
  void write_aggregates(const Snapshot& snapshot);
  void write_series(const Snapshot& snapshot);

  AppendFile cells_, aggregates_, series_, sizes_;
};

}  // namespace rouleau::host
