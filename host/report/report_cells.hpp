// Which rows of cells.csv are whose, also where cells come and leave.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "files/tables.hpp"

namespace rouleau::report {

/// The rows of cells.csv, output after output, in each of which the cells that are there have one.
class CellRows {
 public:
  /// Throws Error(bad_input) for what numbers no cell.
  CellRows(const files::StoredTable& cells, const files::StoredTable& series) {
    const std::size_t rows = cells.rows();
    std::vector<double> inside;  // of each output
    if (series.has("cells_inside")) {
      inside = series.numbers("cells_inside");
      for (const double number : cells.numbers("cell")) {
        if (!(number >= 0 && number <= std::numeric_limits<int>::max()))
          throw Error(Cause::bad_input, Place{"cells.csv"}, "has a cell whose number is none",
                      {"the file is damaged; repeat the run"});
        cell_.push_back(static_cast<std::size_t>(number));
      }
    } else {
      const std::size_t count = cells.count_of("cell");
      for (std::size_t row = 0; row < rows; ++row) cell_.push_back(row % count);
      if (count > 0) inside.assign(rows / count, static_cast<double>(count));
    }
    for (const double count : inside) {
      if (!(count >= 0 && count <= static_cast<double>(rows - begin_.back()))) break;
      begin_.push_back(begin_.back() + static_cast<std::size_t>(count));
    }
  }
  /// That are there whole.
  [[nodiscard]] std::size_t outputs() const { return begin_.size() - 1; }
  [[nodiscard]] std::size_t begin(std::size_t output) const { return begin_[output]; }
  [[nodiscard]] std::size_t end(std::size_t output) const { return begin_[output + 1]; }
  [[nodiscard]] std::size_t count(std::size_t output) const { return end(output) - begin(output); }
  [[nodiscard]] std::size_t cell(std::size_t row) const { return cell_[row]; }
  /// The row of a cell at an output; none: it is not there.
  [[nodiscard]] std::optional<std::size_t> row(std::size_t output, std::size_t cell) const {
    const std::size_t guess = begin(output) + cell;  // right where all are there
    if (guess < end(output) && cell_[guess] == cell) return guess;
    const auto first = cell_.begin() + static_cast<std::ptrdiff_t>(begin(output)),
               last = cell_.begin() + static_cast<std::ptrdiff_t>(end(output));
    const auto found = std::lower_bound(first, last, cell);
    if (found == last || *found != cell) return std::nullopt;
    return static_cast<std::size_t>(found - cell_.begin());
  }
  /// The first one of the outputs with the most cells; there is one.
  [[nodiscard]] std::size_t fullest() const {
    std::size_t most = 0;
    for (std::size_t output = 1; output < outputs(); ++output) most = count(output) > count(most) ? output : most;
    return most;
  }

 private:
  std::vector<std::size_t> cell_, begin_{0};
};

/// The cells that are there at some of the outputs `selection`, in which places of it, and in which row first.
struct ShownCells {
  ShownCells(const CellRows& rows, const std::vector<std::size_t>& selection) {
    struct When {
      std::size_t from, to, row;
    };
    std::map<std::size_t, When> found;
    for (std::size_t k = 0; k < selection.size(); ++k) {
      for (std::size_t r = rows.begin(selection[k]); r < rows.end(selection[k]); ++r)
        found.try_emplace(rows.cell(r), When{k, k, r}).first->second.to = k;
    }
    for (const auto& [cell, when] : found) {
      cells.push_back(cell), from.push_back(when.from), to.push_back(when.to), row.push_back(when.row);
      changes = changes || when.from > 0 || when.to + 1 < selection.size();
    }
  }
  std::vector<std::size_t> cells, from, to, row;
  bool changes = false;  ///< not all are there at all of them
};

}  // namespace rouleau::report
