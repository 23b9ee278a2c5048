// Which rows of cells.csv are whose, also where cells come and leave.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "files/tables.hpp"

namespace rouleau::report {

/// The rows of cells.csv, output after output, in each of which the cells that are there have one.
class CellRows {
 public:
  /// Throws Error(bad_input) for what numbers no cell.
  CellRows(const files::StoredTable& cells, const files::StoredTable& series);
  /// That are there whole.
  [[nodiscard]] std::size_t outputs() const { return begin_.size() - 1; }
  [[nodiscard]] std::size_t begin(std::size_t output) const { return begin_[output]; }
  [[nodiscard]] std::size_t end(std::size_t output) const { return begin_[output + 1]; }
  [[nodiscard]] std::size_t count(std::size_t output) const { return end(output) - begin(output); }
  [[nodiscard]] std::size_t cell(std::size_t row) const { return cell_[row]; }
  /// The row of a cell at an output; none: it is not there.
  [[nodiscard]] std::optional<std::size_t> row(std::size_t output, std::size_t cell) const;
  /// The first one of the outputs with the most cells; there is one.
  [[nodiscard]] std::size_t fullest() const;

 private:
  std::vector<std::size_t> cell_, begin_{0};
};

/// The cells that are there at some of the outputs `selection`, in which places of it, and in which row first.
struct ShownCells {
  ShownCells(const CellRows& rows, const std::vector<std::size_t>& selection);
  std::vector<std::size_t> cells, from, to, row;
  bool changes = false;  ///< not all are there at all of them
};

}  // namespace rouleau::report
