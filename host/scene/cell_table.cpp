#include "cell_table.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

/// A quantity's column: "x_um".
struct QuantityColumn {
  std::size_t at;
  double scale;  ///< SI value of its unit
  std::string name, unit;
};

/// What is wrong, and with which column; none: with all of them.
using Refuse = std::function<void(std::optional<std::size_t> column, const std::string& problem)>;

/// The columns of a table that say something about cells.
struct Columns {
  std::optional<std::size_t> type, step;
  std::optional<QuantityColumn> x, y, z, angle;
  std::array<std::optional<std::size_t>, 3> axis;  ///< numbers

  Columns() = default;
  /// Finds them by name. `refuse` throws.
  Columns(const std::vector<std::string>& names, const units::Units& units, const Refuse& refuse) {
    type = find("type", names, refuse);
    step = find("step", names, refuse);
    for (int k = 0; k < 3; ++k) axis[k] = find(std::string("axis_") + "xyz"[k], names, refuse);
    x = quantity("x", "m", "um", names, units, refuse);
    y = quantity("y", "m", "um", names, units, refuse);
    z = quantity("z", "m", "um", names, units, refuse);
    angle = quantity("angle", "rad", "deg", names, units, refuse);
    for (const auto* needed : {&x, &y}) {
      if (needed->has_value()) continue;
      const std::string name = needed == &x ? "x" : "y";
      refuse(std::nullopt, "there is no column " + name + " with its unit\nname one, such as \"" + name +
                               "_um\" or \"" + name + "_m\"; it has: " + listed(names));
    }
    for (int k = 0; k < 3; ++k) {
      if (axis[k] || (!axis[0] && !axis[1] && !axis[2])) continue;
      refuse(std::nullopt, std::string("an axis has three columns, and there is no \"axis_") + "xyz"[k] + "\"; add it");
    }
  }

 private:
  static std::optional<std::size_t> find(const std::string& name, const std::vector<std::string>& names,
                                         const Refuse& refuse) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != name) continue;
      if (found) refuse(i, "the column " + in_quotes(name) + " is there twice; leave one of them out");
      found = i;
    }
    return found;
  }
  /// The column NAME_UNIT.
  static std::optional<QuantityColumn> quantity(const std::string& name, const char* wanted, const char* common,
                                                const std::vector<std::string>& names, const units::Units& units,
                                                const Refuse& refuse) {
    std::optional<QuantityColumn> found;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string& text = names[i];
      if (text == name) {
        refuse(i, "the column " + in_quotes(text) + " has no unit\nwrite it behind the name: " + name + '_' + common +
                      " or " + name + '_' + wanted);
      }
      if (!text.starts_with(name + '_')) continue;
      const std::string unit = text.substr(name.size() + 1);
      if (found) {
        refuse(i, in_quotes(found->name) + " and " + in_quotes(text) + " are both " + name + "; leave one of them out");
      }
      try {
        found = {i, units.to_si("1 " + unit, wanted, name), text, unit};
      } catch (const units::UnitError& error) {
        refuse(i, error.what());
      }
    }
    return found;
  }
};

/// Rows become cells: what tables of both kinds of files have in common.
class CellRows {
 public:
  CellRows(const std::vector<CellType>& types, const std::string& pointer, std::optional<int> type)
      : pointer_(pointer), only_type_(type) {
    for (const CellType& known : types) type_names_.push_back(known.name);
  }
  Columns columns;

  void find_columns(const std::vector<std::string>& names, const units::Units& units, const Refuse& refuse) {
    columns = Columns(names, units, refuse);
    if (columns.type && only_type_) {
      refuse(columns.type,
             "the scene gives all cells of this file a type, and the file has a column \"type\" of its own; leave one "
             "of them out");
    }
    if (!columns.type && !only_type_ && type_names_.size() != 1) {
      refuse(std::nullopt,
             "there is no column \"type\", and " + std::to_string(type_names_.size()) +
                 " cell types\nadd it, or \"type\" to the entry of the scene; cell_types has: " + listed(type_names_));
    }
  }
  [[nodiscard]] int type_of(std::string_view name, const Refuse& refuse) const {
    const auto found = std::find(type_names_.begin(), type_names_.end(), name);
    if (found == type_names_.end()) {
      refuse(columns.type, "no cell type is called " + in_quotes(name) + did_you_mean(name, type_names_) +
                               "\ncell_types has: " + listed(type_names_));
    }
    return static_cast<int>(found - type_names_.begin());
  }
  /// `text(column)`: what the row has there, for messages.
  using Text = std::function<std::string(std::size_t column)>;
  using Value = std::function<double(std::size_t column, const std::string& name)>;
  /// Of a row. Whether it begins the rows of a later step, and those before it do not count.
  void take_step(const Value& value, const Text& text, const Refuse& refuse) {
    if (!columns.step) return;
    const double step = value(*columns.step, "step");
    if (step < last_step_) {
      refuse(columns.step, "the step " + in_quotes(text(*columns.step)) + " comes after step " +
                               number(last_step_, 15) + "; sort the rows by step, or leave the column out");
    }
    if (step > last_step_) cells.clear();
    last_step_ = step;
  }
  /// `type`: none where all cells have the same.
  void add(std::optional<int> type, int line, const Value& value, const Text& text, const Refuse& refuse) {
    if (cells.size() == std::size_t{most_cells}) {
      refuse(std::nullopt,
             "these are more than " + std::to_string(most_cells) + " cells, more than can be computed; take fewer");
    }
    const auto si = [&](const QuantityColumn& column, const AllowedRange& range) {
      const double result = value(column.at, column.name) * column.scale;
      if (!(result >= range.least && result <= range.most)) {
        refuse(column.at, in_quotes(text(column.at)) + ' ' + column.unit + " is out of range; " + column.name +
                              " lies between " + number(range.least / column.scale) + " and " +
                              number(range.most / column.scale));
      }
      return result;
    };
    CellPlacement& cell = cells.emplace_back();
    cell.type = type.value_or(only_type_.value_or(0));
    cell.center = {si(*columns.x, range::place), si(*columns.y, range::place)};
    cell.angle = columns.angle ? si(*columns.angle, range::angle) : 0;
    cell.pointer = pointer_;
    cell.line = line;
    cell.z = columns.z ? si(*columns.z, range::place) : std::nan("");
    if (!columns.axis[0]) return;
    Eigen::Vector3d axis;
    for (int k = 0; k < 3; ++k) axis[k] = value(*columns.axis[k], std::string("axis_") + "xyz"[k]);
    if (!(axis.norm() > 1e-9 && axis.norm() < 1e9))
      refuse(columns.axis[0], "this axis has no direction; give three numbers that are not all 0");
    cell.axis = axis.normalized();
  }

  std::vector<CellPlacement> cells;

 private:
  const std::string& pointer_;
  std::optional<int> only_type_;
  std::vector<std::string> type_names_;
  double last_step_ = 0;
};

class CsvTable {
 public:
  CsvTable(const std::filesystem::path& file, const std::vector<CellType>& types, const units::Units& units,
           const std::string& pointer, std::optional<int> type)
      : file_(file), units_(units), pointer_(pointer), rows_(types, pointer, type) {}

  std::vector<CellPlacement> read() {
    errno = 0;
    std::ifstream stream(file_, std::ios::binary);
    std::error_code ignored;
    if (!stream || !std::filesystem::is_regular_file(file_, ignored)) {
      throw Error(Cause::input_output, Place{file_.string(), pointer_},
                  "this file of cells cannot be read: " +
                      std::string(errno != 0 ? std::strerror(errno) : "it is no plain file"));
    }
    std::string line;
    while (std::getline(stream, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      split(line);
      if (line_ == 1) {
        read_header();
      } else if (!line.empty()) {
        read_row();
      }
    }
    if (stream.bad()) throw Error(Cause::input_output, Place{file_.string()}, std::strerror(errno));
    if (line_ == 0)
      refuse_file("this file of cells is empty; its first line names the columns: type,x_um,y_um,angle_deg");
    if (rows_.cells.empty()) refuse_file("this file has no cells: there is no row below the header");
    return std::move(rows_.cells);
  }

 private:
  struct Entry {
    std::string_view text;
    std::size_t column;  ///< from 1
  };

  void split(std::string_view line) {
    entries_.clear();
    if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    for (std::size_t begin = 0;;) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      std::string_view text = line.substr(begin, end - begin);
      std::size_t column = begin + 1;
      while (!text.empty() && text.front() == ' ') text.remove_prefix(1), ++column;
      while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
      entries_.push_back({text, column});
      if (end == line.size()) return;
      begin = end + 1;
    }
  }

  void read_header() {
    header_ = entries_.size();
    std::vector<std::string> names;
    for (const Entry& entry : entries_) names.emplace_back(entry.text);
    rows_.find_columns(names, units_, refuse_);
  }

  void read_row() {
    if (entries_.size() != header_) {
      refuse(entries_.back().column, "this line has " + std::to_string(entries_.size()) + " entries, and the header " +
                                         std::to_string(header_) + "; give one for each column");
    }
    rows_.take_step(value_, text_, refuse_);
    const auto& type = rows_.columns.type;
    rows_.add(type ? std::optional(rows_.type_of(entries_[*type].text, refuse_)) : std::nullopt, line_, value_, text_,
              refuse_);
  }

  [[nodiscard]] double value(std::size_t column, const std::string& name) const {
    const Entry& entry = entries_[column];
    double result = 0;
    const char* const end = entry.text.data() + entry.text.size();
    const auto [stopped, error] = std::from_chars(entry.text.data(), end, result);
    if (error != std::errc{} || stopped != end || entry.text.empty() || !std::isfinite(result))
      refuse(entry.column, in_quotes(entry.text) + " is no number; the column " + name + " has one in each row");
    return result;
  }

  /// Of the file as a whole.
  [[noreturn]] void refuse_file(const std::string& problem) const {
    throw Error(Cause::bad_input, Place{file_.string()}, indented(problem));
  }
  [[noreturn]] void refuse(std::size_t column, const std::string& problem) const {
    throw Error(Cause::bad_input, Place{file_.string(), {}, line_, static_cast<int>(column)}, indented(problem));
  }

  const std::filesystem::path& file_;
  const units::Units& units_;
  const std::string& pointer_;
  std::vector<Entry> entries_;  ///< of the present line
  int line_ = 0;
  std::size_t header_ = 0;  ///< columns
  CellRows rows_;
  const Refuse refuse_ = [this](std::optional<std::size_t> column, const std::string& problem) {
    refuse(column ? entries_[*column].column : 1, problem);
  };
  const CellRows::Text text_ = [this](std::size_t column) { return std::string(entries_[column].text); };
  const CellRows::Value value_ = [this](std::size_t column, const std::string& name) { return value(column, name); };
};

/// HDF5's identifiers, closed with it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 says nothing by itself while one lives.
class Silence {
 public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Datasets of one dimension in a file's root, each called as a column of a CSV file is, all equally long.
class Hdf5Table {
 public:
  Hdf5Table(const std::filesystem::path& file, const std::vector<CellType>& types, const units::Units& units,
            const std::string& pointer, std::optional<int> type)
      : file_(file),
        units_(units),
        rows_(types, pointer, type),
        opened_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {}

  std::vector<CellPlacement> read() {
    if (!opened_.valid()) unreadable("this file of cells is no HDF5 file that can be read");
    H5Literate(
        opened_.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* names) -> herr_t {
          static_cast<std::vector<std::string>*>(names)->emplace_back(name);
          return 0;
        },
        &names_);
    rows_.find_columns(names_, units_, refuse_);
    const Columns& columns = rows_.columns;
    values_.resize(names_.size());
    for (const auto& column : {columns.x, columns.y, columns.z, columns.angle}) {
      if (column) read_numbers(column->at);
    }
    for (const auto& column : {columns.step, columns.axis[0], columns.axis[1], columns.axis[2]}) {
      if (column) read_numbers(*column);
    }
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
  [[noreturn]] void unreadable(const std::string& problem) const {
    throw Error(Cause::input_output, Place{file_.string()}, problem);
  }
  /// Opens a column, and checks its length.
  Handle open(std::size_t column) {
    Handle dataset(H5Dopen2(opened_.id(), names_[column].c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(dataset.valid() ? H5Dget_space(dataset.id()) : -1, H5Sclose);
    row_ = no_row;
    if (!space.valid() || H5Sget_simple_extent_ndims(space.id()) != 1)
      refuse_(column, "this is no dataset of one dimension, a value for each cell");
    hsize_t count = 0;
    H5Sget_simple_extent_dims(space.id(), &count, nullptr);
    if (count > static_cast<hsize_t>(most_cells) && !rows_.columns.step) {
      refuse_(column, "it has " + std::to_string(count) + " values; more than " + std::to_string(most_cells) +
                          " cells cannot be computed");
    }
    // What a file claims may be more than memory holds.
    if (count > 20 * static_cast<hsize_t>(most_cells))
      refuse_(column, "it has too many values, " + std::to_string(count));
    if (count_ && *count_ != count) {
      refuse_(column, "it has " + std::to_string(count) + " values, and others have " + std::to_string(*count_) +
                          "; give one for each cell");
    }
    count_ = count;
    return dataset;
  }
  void read_numbers(std::size_t column) {
    const Handle dataset = open(column);
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) refuse_(column, "its values are no numbers");
    values_[column].resize(*count_);
    if (H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_[column].data()) < 0)
      unreadable("the dataset " + in_quotes(names_[column]) + " cannot be read");
  }
  void read_types(std::size_t column) {
    const Handle dataset = open(column);
    const Handle stored(H5Dget_type(dataset.id()), H5Tclose), space(H5Dget_space(dataset.id()), H5Sclose);
    if (H5Tget_class(stored.id()) != H5T_STRING) refuse_(column, "its values are no names of cell types");
    types_.reserve(*count_);
    const bool variable = H5Tis_variable_str(stored.id()) > 0;
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_cset(type.id(), H5Tget_cset(stored.id()));
    const std::size_t size = H5Tget_size(stored.id());
    if (!variable && size > 1000) refuse_(column, "names of cell types are not as long as that");
    H5Tset_size(type.id(), variable ? H5T_VARIABLE : size + 1);
    std::vector<char*> words(variable ? *count_ : 0);
    std::vector<char> letters(variable ? 0 : *count_ * (size + 1));
    void* const to = variable ? static_cast<void*>(words.data()) : letters.data();
    if (H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0)
      unreadable("the dataset \"type\" cannot be read");
    std::vector<std::string> names;
    names.reserve(*count_);
    for (std::size_t i = 0; i < *count_; ++i) {
      const char* const word = variable ? words[i] : &letters[i * (size + 1)];
      names.emplace_back(word != nullptr ? word : "");
    }
    if (variable) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, words.data());
    for (row_ = 0; row_ < *count_; ++row_) types_.push_back(rows_.type_of(names[row_], refuse_));
  }

  static constexpr std::size_t no_row = static_cast<std::size_t>(-1);
  const Silence silence_;
  const std::filesystem::path& file_;
  const units::Units& units_;
  CellRows rows_;
  const Handle opened_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> values_;  ///< by column; of those that are needed
  std::vector<int> types_;
  std::optional<std::size_t> count_;
  std::size_t row_ = no_row;  ///< the present one
  const Refuse refuse_ = [this](std::optional<std::size_t> column, const std::string& problem) {
    std::string where;
    if (column) where = "the dataset " + in_quotes(names_[*column]);
    if (row_ != no_row) where += (where.empty() ? "" : ", ") + ("row " + std::to_string(row_ + 1));
    throw Error(Cause::bad_input, Place{file_.string()}, indented(where + (where.empty() ? "" : ": ") + problem));
  };
  const CellRows::Text text_ = [this](std::size_t column) { return number(values_[column][row_], 15); };
  const CellRows::Value value_ = [this](std::size_t column, const std::string& name) {
    const double result = values_[column][row_];
    if (!std::isfinite(result))
      refuse_(column, in_quotes(number(result)) + " is no number; " + name + " has one in each row");
    return result;
  };
};

/// By its first bytes.
bool is_hdf5(const std::filesystem::path& file) {
  std::array<char, 8> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  return std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n";
}

}  // namespace

std::string origin_of(const CellPlacement& cell) {
  return cell.pointer + (cell.line > 0 ? ", line " + std::to_string(cell.line) + " of its file" : "");
}

std::vector<CellPlacement> read_cell_table(const std::filesystem::path& file, const std::vector<CellType>& types,
                                           const units::Units& units, const std::string& pointer,
                                           std::optional<int> type) {
  if (is_hdf5(file)) return Hdf5Table(file, types, units, pointer, type).read();
  return CsvTable(file, types, units, pointer, type).read();
}

std::vector<std::string> cell_table_entries(const nlohmann::json& scene) {
  std::vector<std::string> entries;
  if (!scene.is_object() || !scene.contains("cells")) return entries;
  const auto& cells = scene["cells"];
  const auto names_file = [](const nlohmann::json& entry) {
    return entry.is_object() && entry.contains("file") && entry["file"].is_string();
  };
  if (names_file(cells)) entries.emplace_back("/cells");
  for (std::size_t i = 0; cells.is_array() && i < cells.size(); ++i) {
    if (names_file(cells[i])) entries.push_back(json::child_pointer("/cells", i));
  }
  return entries;
}

}  // namespace rouleau::scene
