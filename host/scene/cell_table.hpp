// Cells from a table, a row for each: a CSV file, or HDF5 datasets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene.hpp"
#include "units/units.hpp"

namespace rouleau::scene {

/// Reads a CSV file whose header names the columns `type`, `x_UNIT`, `y_UNIT`, in three dimensions `z_UNIT` (without
/// it places have two numbers), and, where cells are turned, `angle_UNIT` and `axis_x`, `axis_y`, `axis_z` (numbers),
/// in any order and beside others that are not looked at; without `type` all cells are of that which is given, or of
/// the only cell type. Where there is a column `step`, as in cells.csv of a run, the rows of the last step are taken:
/// where that run has come to. Columns are separated by commas, semicolons or tabs, as the header or a line `sep=;`
/// before it shows; between semicolons and tabs numbers may have decimal commas. Entries may stand in double quotes.
/// Blank lines, lines of empty entries and those that begin with `#` are skipped. UTF-8, or UTF-16 with a byte order
/// mark. Or an HDF5 file, known by its first bytes, with a dataset for each column. `pointer`: of the entry in the
/// scene, for the cells. Throws Error(bad_input) with file, line and column (in bytes from 1) or dataset and row
/// (from 1), or Error(input_output) when the file cannot be read.
std::vector<CellPlacement> read_cell_table(const std::filesystem::path& file, const std::vector<CellType>& types,
                                           const units::Units& units, const std::string& pointer,
                                           std::optional<int> type = {});

/// Where a cell comes from, for a message: the entry's pointer, and the line (of HDF5 the row) of its file.
std::string origin_of(const CellPlacement& cell);

}  // namespace rouleau::scene
