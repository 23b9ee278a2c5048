#include "cell_table.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>

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

class CellTable {
 public:
  CellTable(const std::filesystem::path& file, const std::vector<CellType>& types, const units::Units& units,
            const std::string& pointer, std::optional<int> type)
      : file_(file), types_(types), units_(units), pointer_(pointer), only_type_(type) {
    for (const CellType& known : types) type_names_.push_back(known.name);
  }

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
      refuse(0, "this file of cells is empty; its first line names the columns: type,x_um,y_um,angle_deg");
    if (cells_.empty()) refuse(0, "this file has no cells: there is no row below the header");
    return std::move(cells_);
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
    columns_ = entries_.size();
    type_ = find("type");
    step_ = find("step");
    x_ = quantity("x", "m", "um");
    y_ = quantity("y", "m", "um");
    z_ = quantity("z", "m", "um");
    angle_ = quantity("angle", "rad", "deg");
    for (const auto* needed : {&x_, &y_}) {
      if (needed->has_value()) continue;
      const std::string name = needed == &x_ ? "x" : "y";
      refuse(1, "there is no column " + name + " with its unit\nthe first line names the columns, such as \"" + name +
                    "_um\" or \"" + name + "_m\"; it has: " + listed(header()));
    }
    if (type_ && only_type_) {
      refuse(entries_[*type_].column,
             "the scene gives all cells of this file a type, and the file has a column \"type\" of "
             "its own; leave one of them out");
    }
    if (!type_ && !only_type_ && types_.size() != 1) {
      refuse(1,
             "there is no column \"type\", and " + std::to_string(types_.size()) +
                 " cell types\nadd it, or \"type\" to the entry of the scene; cell_types has: " + listed(type_names_));
    }
  }

  [[nodiscard]] std::vector<std::string> header() const {
    std::vector<std::string> names;
    for (const Entry& entry : entries_) names.emplace_back(entry.text);
    return names;
  }

  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (entries_[i].text != name) continue;
      if (found) refuse(entries_[i].column, "the column " + in_quotes(name) + " is there twice; leave one of them out");
      found = i;
    }
    return found;
  }

  /// The column NAME_UNIT.
  [[nodiscard]] std::optional<QuantityColumn> quantity(const std::string& name, const char* wanted,
                                                       const char* common) const {
    std::optional<QuantityColumn> found;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const auto [text, column] = entries_[i];
      if (text == name) {
        refuse(column, "the column " + in_quotes(text) + " has no unit\nwrite it behind the name: " + name + '_' +
                           common + " or " + name + '_' + wanted);
      }
      if (!text.starts_with(name + '_')) continue;
      const std::string unit(text.substr(name.size() + 1));
      if (found) {
        refuse(column,
               in_quotes(found->name) + " and " + in_quotes(text) + " are both " + name + "; leave one of them out");
      }
      try {
        found = {i, units_.to_si("1 " + unit, wanted, name), std::string(text), unit};
      } catch (const units::UnitError& error) {
        refuse(column, error.what());
      }
    }
    return found;
  }

  void read_row() {
    if (entries_.size() != columns_) {
      refuse(entries_.back().column, "this line has " + std::to_string(entries_.size()) + " entries, and the header " +
                                         std::to_string(columns_) + "; give one for each column");
    }
    if (step_) {
      const double step = value(*step_, "step");
      if (step < last_step_) {
        refuse(entries_[*step_].column, "the step " + in_quotes(entries_[*step_].text) + " comes after step " +
                                            number(last_step_, 15) +
                                            "; sort the rows by step, or leave the column out");
      }
      if (step > last_step_) cells_.clear();
      last_step_ = step;
    }
    if (cells_.size() == std::size_t{most_cells}) {
      refuse(1, "these are more than " + std::to_string(most_cells) + " cells, more than can be computed; take fewer");
    }
    cells_.push_back({type_ ? type_of(entries_[*type_]) : only_type_.value_or(0),
                      {si(*x_, range::place), si(*y_, range::place)},
                      angle_ ? si(*angle_, range::angle) : 0,
                      pointer_,
                      line_,
                      z_ ? si(*z_, range::place) : std::nan(""),
                      {}});
  }

  [[nodiscard]] int type_of(const Entry& entry) const {
    const auto found = std::find(type_names_.begin(), type_names_.end(), entry.text);
    if (found != type_names_.end()) return static_cast<int>(found - type_names_.begin());
    refuse(entry.column, "no cell type is called " + in_quotes(entry.text) + did_you_mean(entry.text, type_names_) +
                             "\ncell_types has: " + listed(type_names_));
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

  [[nodiscard]] double si(const QuantityColumn& column, const AllowedRange& range) const {
    const double result = value(column.at, column.name) * column.scale;
    if (result >= range.least && result <= range.most) return result;
    refuse(entries_[column.at].column, in_quotes(entries_[column.at].text) + ' ' + column.unit + " is out of range; " +
                                           column.name + " lies between " + number(range.least / column.scale) +
                                           " and " + number(range.most / column.scale));
  }

  /// `column` 0: of the file as a whole.
  [[noreturn]] void refuse(std::size_t column, const std::string& problem) const {
    throw Error(Cause::bad_input, Place{file_.string(), {}, column == 0 ? 0 : line_, static_cast<int>(column)},
                indented(problem));
  }

  const std::filesystem::path& file_;
  const std::vector<CellType>& types_;
  const units::Units& units_;
  const std::string& pointer_;
  std::optional<int> only_type_;
  std::vector<std::string> type_names_;
  std::vector<Entry> entries_;  ///< of the present line
  int line_ = 0;
  std::size_t columns_ = 0;
  std::optional<std::size_t> type_, step_;
  std::optional<QuantityColumn> x_, y_, z_, angle_;
  double last_step_ = 0;
  std::vector<CellPlacement> cells_;
};

}  // namespace

std::string origin_of(const CellPlacement& cell) {
  return cell.pointer + (cell.line > 0 ? ", line " + std::to_string(cell.line) + " of its file" : "");
}

std::vector<CellPlacement> read_cell_table(const std::filesystem::path& file, const std::vector<CellType>& types,
                                           const units::Units& units, const std::string& pointer,
                                           std::optional<int> type) {
  return CellTable(file, types, units, pointer, type).read();
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
