// Cells from a table, a row for each: what files of all kinds have in common, named columns and rows that become cells.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
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

/// A quantity's column: "x_um".
struct QuantityColumn {
  std::size_t at;
  double scale;  ///< SI value of its unit
  std::string name, unit;
};

/// What is wrong, and with which column; none: with all of them. Throws.
using RefuseColumn = std::function<void(std::optional<std::size_t> column, const std::string& problem)>;

/// The columns of a table that say something about cells. Capital letters of a name mean the same; those of a unit do
/// not.
struct CellColumns {
  std::optional<std::size_t> type, step;
  std::array<std::optional<QuantityColumn>, 3> place;  ///< along x, y and z
  std::optional<QuantityColumn> angle;
  std::array<std::optional<std::size_t>, 3> axis;  ///< numbers

  CellColumns() = default;
  CellColumns(const std::vector<std::string>& names, const units::Units& units, const RefuseColumn& refuse);
};

/// Rows become cells.
class CellRows {
 public:
  /// `text(column)`: what the row has there, for messages.
  using Text = std::function<std::string(std::size_t column)>;
  using Value = std::function<double(std::size_t column, const std::string& name)>;

  CellRows(const std::vector<CellType>& types, const std::string& pointer, std::optional<int> type);

  CellColumns columns;
  std::vector<CellPlacement> cells;

  void find_columns(const std::vector<std::string>& names, const units::Units& units, const RefuseColumn& refuse);
  [[nodiscard]] int type_of(std::string_view name, const RefuseColumn& refuse) const;
  /// Of a row. Where it begins the rows of a later step, those before it do not count.
  void take_step(const Value& value, const Text& text, const RefuseColumn& refuse);
  /// `type`: none where all cells have the same.
  void add(std::optional<int> type, int line, const Value& value, const Text& text, const RefuseColumn& refuse);

 private:
  const std::string& pointer_;
  std::optional<int> only_type_;
  std::vector<std::string> type_names_;
  double last_step_ = 0;
};

/// What read_cell_table() is given.
struct CellTableSource {
  const std::filesystem::path& file;
  const std::vector<CellType>& types;
  const units::Units& units;
  const std::string& pointer;
  std::optional<int> type;
};
std::vector<CellPlacement> read_csv_cells(const CellTableSource& source);
std::vector<CellPlacement> read_hdf5_cells(const CellTableSource& source);

}  // namespace rouleau::scene
