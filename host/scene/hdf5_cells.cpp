// Cells from HDF5 datasets of one dimension in a file's root, each called as a column of a CSV file is, all equally
// long.
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "cell_rows.hpp"
#include "hdf5/hdf5_file.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

class Hdf5Table {
 public:
  explicit Hdf5Table(const CellTableSource& source)
      : source_(source),
        rows_(source.types, source.pointer, source.type),
        opened_(source.file, hdf5::File::Mode::read) {}

  std::vector<CellPlacement> read() {
    names_ = opened_.names("/");
    rows_.find_columns(names_, source_.units, refuse_);
    const CellColumns& columns = rows_.columns;
    values_.resize(names_.size());
    for (const auto& column : {columns.place[0], columns.place[1], columns.place[2], columns.angle})
      if (column) read_numbers(column->at);
    for (const auto& column : {columns.step, columns.axis[0], columns.axis[1], columns.axis[2]})
      if (column) read_numbers(*column);
    if (columns.type) read_types(*columns.type);
    if (!count_ || *count_ == 0) refuse_(std::nullopt, "this file has no cells: its datasets are empty");
    for (row_ = 0; row_ < *count_; ++row_) {
      rows_.take_step(value_, text_, refuse_);
      rows_.add(columns.type ? std::optional(types_[row_]) : std::nullopt, static_cast<int>(row_) + 1, value_, text_,
                refuse_);
    }
    return std::move(rows_.cells);
  }

 private:
  /// Its path, when its length is right.
  std::string checked(std::size_t column) {
    std::string path = '/' + names_[column];
    row_ = no_row;
    const std::vector<std::size_t> shape = opened_.shape(path);
    if (shape.size() != 1) refuse_(column, "this is no dataset of one dimension, a value for each cell");
    const std::size_t count = shape[0];
    if (count > static_cast<std::size_t>(most_cells) && !rows_.columns.step) {
      refuse_(column, "it has " + std::to_string(count) + " values; more than " + std::to_string(most_cells) +
                          " cells cannot be computed");
    }
    // What a file claims may be more than memory holds.
    if (count > 20 * static_cast<std::size_t>(most_cells))
      refuse_(column, "it has too many values, " + std::to_string(count));
    if (count_ && *count_ != count) {
      refuse_(column, "it has " + std::to_string(count) + " values, and others have " + std::to_string(*count_) +
                          "; give one for each cell");
    }
    count_ = count;
    return path;
  }
  void read_numbers(std::size_t column) {
    const std::string path = checked(column);
    const H5T_class_t kind = opened_.kind(path);
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) refuse_(column, "its values are no numbers");
    values_[column] = opened_.read(path);
  }
  void read_types(std::size_t column) {
    const std::string path = checked(column);
    if (opened_.kind(path) != H5T_STRING) refuse_(column, "its values are no names of cell types");
    const std::vector<std::string> names = opened_.read_texts(path);
    types_.reserve(names.size());
    for (row_ = 0; row_ < names.size(); ++row_) types_.push_back(rows_.type_of(names[row_], refuse_));
  }

  static constexpr std::size_t no_row = static_cast<std::size_t>(-1);
  const CellTableSource& source_;
  CellRows rows_;
  const hdf5::File opened_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> values_;  ///< by column; of those that are needed
  std::vector<int> types_;
  std::optional<std::size_t> count_;
  std::size_t row_ = no_row;  ///< the present one
  const RefuseColumn refuse_ = [this](std::optional<std::size_t> column, const std::string& problem) {
    std::string where;
    if (column) where = "the dataset " + in_quotes(names_[*column]);
    if (row_ != no_row) where += (where.empty() ? "" : ", ") + ("row " + std::to_string(row_ + 1));
    throw Error(Cause::bad_input, Place{source_.file.string()},
                indented(where + (where.empty() ? "" : ": ") + problem));
  };
  const CellRows::Text text_ = [this](std::size_t column) { return number(values_[column][row_], 15); };
  const CellRows::Value value_ = [this](std::size_t column, const std::string& name) {
    const double result = values_[column][row_];
    if (!std::isfinite(result))
      refuse_(column, in_quotes(number(result)) + " is no number; " + name + " has one in each row");
    return result;
  };
};

}  // namespace

std::vector<CellPlacement> read_hdf5_cells(const CellTableSource& source) { return Hdf5Table(source).read(); }

}  // namespace rouleau::scene
