// Everything that a run's tables hold: one entry for each column. The files cells.csv, aggregates.csv, series.csv and
// aggregate_sizes.csv, the means in summary.json, the charts of report.html, the units of a study's columns and the
// lists of columns in docs/output-tables.md all come from here.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "json/json.hpp"
#include "observable.hpp"

namespace rouleau::observe {

struct Table {
  std::string_view name;  ///< of its file, without ".csv"
  std::vector<Observable> observables;
  /// Calls `visit` for each row that an output has, in the order of the file.
  void (*for_each_row)(const Snapshot& output, const std::function<void(const Row&)>& visit);

  /// Those of a run of this kind.
  [[nodiscard]] std::vector<const Observable*> of(const RunKind& run) const;
  /// Their columns' names.
  [[nodiscard]] std::vector<std::string> columns(const RunKind& run) const;
};

/// cells, aggregates, series and aggregate_sizes, in this order.
const std::array<Table, 4>& tables();
/// That of this name; throws std::out_of_range where there is none.
const Table& table(std::string_view name);

/// [{name, columns: [{column, unit, doc, has_means, in_space, in_plane, at_openings, ...}]}], for scripts/docs.
nlohmann::json columns_json();

}  // namespace rouleau::observe
