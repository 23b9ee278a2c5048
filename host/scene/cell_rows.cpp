#include "cell_rows.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {

namespace {

std::string small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::optional<std::size_t> find(const std::string& name, const std::vector<std::string>& names,
                                const RefuseColumn& refuse) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (small_letters(names[i]) != name) continue;
    if (found) refuse(i, "the column " + in_quotes(name) + " is there twice; leave one of them out");
    found = i;
  }
  return found;
}

/// The column NAME_UNIT.
std::optional<QuantityColumn> quantity(const std::string& name, const char* wanted, const char* common,
                                       const std::vector<std::string>& names, const units::Units& units,
                                       const RefuseColumn& refuse) {
  std::optional<QuantityColumn> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& text = names[i];
    if (small_letters(text) == name) {
      refuse(i, "the column " + in_quotes(text) + " has no unit\nwrite it behind the name: " + name + '_' + common +
                    " or " + name + '_' + wanted);
    }
    if (!small_letters(text).starts_with(name + '_')) continue;
    const std::string unit = text.substr(name.size() + 1);
    if (found)
      refuse(i, in_quotes(found->name) + " and " + in_quotes(text) + " are both " + name + "; leave one of them out");
    try {
      found = {i, units.to_si("1 " + unit, wanted, name), text, unit};
    } catch (const units::UnitError& error) {
      refuse(i, error.what());
    }
  }
  return found;
}

}  // namespace

CellColumns::CellColumns(const std::vector<std::string>& names, const units::Units& units, const RefuseColumn& refuse) {
  type = find("type", names, refuse);
  step = find("step", names, refuse);
  for (int k = 0; k < 3; ++k) axis[k] = find(std::string("axis_") + axis_names[k], names, refuse);
  for (int k = 0; k < 3; ++k) place[k] = quantity({axis_names[k]}, "m", "um", names, units, refuse);
  angle = quantity("angle", "rad", "deg", names, units, refuse);
  for (const int k : {0, 1}) {
    if (place[k]) continue;
    const std::string name(1, axis_names[k]);
    std::vector<std::string> meant;
    std::copy_if(names.begin(), names.end(), std::back_inserter(meant),
                 [&](const std::string& text) { return small_letters(text).starts_with(name); });
    refuse(std::nullopt, "there is no column " + name + " with its unit" + did_you_mean(name + "_um", meant) +
                             "\nname one, such as \"" + name + "_um\" or \"" + name + "_m\"; it has: " + listed(names));
  }
  for (int k = 0; k < 3; ++k) {
    if (axis[k] || (!axis[0] && !axis[1] && !axis[2])) continue;
    refuse(std::nullopt,
           std::string("an axis has three columns, and there is no \"axis_") + axis_names[k] + "\"; add it");
  }
}

CellRows::CellRows(const std::vector<CellType>& types, const std::string& pointer, std::optional<int> type)
    : pointer_(pointer), only_type_(type) {
  for (const CellType& known : types) type_names_.push_back(known.name);
}

void CellRows::find_columns(const std::vector<std::string>& names, const units::Units& units,
                            const RefuseColumn& refuse) {
  columns = CellColumns(names, units, refuse);
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

int CellRows::type_of(std::string_view name, const RefuseColumn& refuse) const {
  const auto found = std::find(type_names_.begin(), type_names_.end(), name);
  if (found == type_names_.end()) {
    refuse(columns.type, "no cell type is called " + in_quotes(name) + did_you_mean(name, type_names_) +
                             "\ncell_types has: " + listed(type_names_));
  }
  return static_cast<int>(found - type_names_.begin());
}

void CellRows::take_step(const Value& value, const Text& text, const RefuseColumn& refuse) {
  if (!columns.step) return;
  const double step = value(*columns.step, "step");
  if (step < last_step_) {
    refuse(columns.step, "the step " + in_quotes(text(*columns.step)) + " comes after step " + number(last_step_, 15) +
                             "; sort the rows by step, or leave the column out");
  }
  if (step > last_step_) cells.clear();
  last_step_ = step;
}

void CellRows::add(std::optional<int> type, int line, const Value& value, const Text& text,
                   const RefuseColumn& refuse) {
  if (cells.size() == std::size_t{most_cells}) {
    refuse(std::nullopt,
           "these are more than " + std::to_string(most_cells) + " cells, more than can be computed; take fewer");
  }
  const auto si = [&](const QuantityColumn& column, const AllowedRange& range) {
    const double result = value(column.at, column.name) * column.scale;
    if (!(result >= range.least && result <= range.most))
      refuse(column.at, in_quotes(text(column.at)) + ' ' + column.unit + " is out of range; " + column.name +
                            " lies between " + number(range.least / column.scale) + " and " +
                            number(range.most / column.scale));
    return result;
  };
  CellPlacement& cell = cells.emplace_back();
  cell.type = type.value_or(only_type_.value_or(0));
  cell.center = Vector::filled(columns.place[2] ? 3 : 2, 0);
  for (int k = 0; k < cell.center.dimension(); ++k) cell.center[k] = si(*columns.place[k], range::place);
  cell.angle = columns.angle ? si(*columns.angle, range::angle) : 0;
  cell.pointer = pointer_;
  cell.line = line;
  if (!columns.axis[0]) return;
  Eigen::Vector3d axis;
  for (int k = 0; k < 3; ++k) axis[k] = value(*columns.axis[k], std::string("axis_") + axis_names[k]);
  if (!(axis.norm() > 1e-9 && axis.norm() < 1e9))
    refuse(columns.axis[0], "this axis has no direction; give three numbers that are not all 0");
  cell.axis = axis.normalized();
}

std::string origin_of(const CellPlacement& cell) {
  return cell.pointer + (cell.line > 0 ? ", line " + std::to_string(cell.line) + " of its file" : "");
}

std::vector<CellPlacement> read_cell_table(const std::filesystem::path& file, const std::vector<CellType>& types,
                                           const units::Units& units, const std::string& pointer,
                                           std::optional<int> type) {
  std::array<char, 8> first{};
  InputFile(file).read(first.data(), first.size(), 0);
  const CellTableSource source{file, types, units, pointer, type};
  return std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n" ? read_hdf5_cells(source)
                                                                             : read_csv_cells(source);
}

}  // namespace rouleau::scene
