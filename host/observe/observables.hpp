// Everything that a run's tables hold: one entry for each column. The files cells.csv, aggregates.csv, series.csv and
// aggregate_sizes.csv, the means in summary.json, the charts of report.html, the units of a study's columns and the
// lists of columns in docs/output.md all come from here.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "json/json.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

/// Cells that hang together, and where that is so.
struct AggregateMembers {
  int label;            ///< smallest of its cells
  int count = 0;        ///< of its cells
  std::string members;  ///< these, joined by "+"
  bool through_image = false;
  std::vector<const ContactSnapshot*> contacts;
};

/// What a row of a table is about: an output, and something of it.
struct Row {
  const Snapshot& output;
  const CellSnapshot* cell = nullptr;
  const AggregateMembers* aggregate = nullptr;
  const ContactSnapshot* contact = nullptr;  ///< none: the aggregate is a cell without contacts
  int size = 0, aggregates_of_size = 0;
};

/// Nothing where the column does not apply to the row.
using Value = std::variant<std::monostate, double, long, bool, std::string>;

struct Observable {
  std::string_view name;  ///< without the unit
  std::string_view unit;  ///< coherent SI, such as "J/m"; empty: a number or a text
  std::string_view doc;   ///< what it is, for the list of columns: Markdown, signs and what `nan` means included
  Value (*value)(const Row& row);
  std::string_view chart = {};  ///< title of the report's chart that draws it; empty: none does
  std::string_view line = {};   ///< which line of that chart it is, where there are several
  bool has_means = false;       ///< summary.json has its means over the stages (RheologyHistory)
  bool in_space = false;        ///< there in three dimensions only

  /// The column's name: the name and the unit, "kinetic_energy_J_per_m".
  [[nodiscard]] std::string column() const;
};

struct Table {
  std::string_view name;  ///< of its file, without ".csv"
  std::vector<Observable> observables;
  /// Calls `visit` for each row that an output has, in the order of the file.
  void (*for_each_row)(const Snapshot& output, const std::function<void(const Row&)>& visit);

  /// Those of a run of so many dimensions.
  [[nodiscard]] std::vector<const Observable*> of(int dimension) const;
  /// Their columns' names.
  [[nodiscard]] std::vector<std::string> columns(int dimension) const;
};

/// cells, aggregates, series and aggregate_sizes, in this order.
const std::array<Table, 4>& tables();
/// That of this name; throws std::out_of_range where there is none.
const Table& table(std::string_view name);

/// [{name, columns: [{column, unit, doc, has_means, in_space}]}], for scripts/docs.
nlohmann::json columns_json();

}  // namespace rouleau::observe
