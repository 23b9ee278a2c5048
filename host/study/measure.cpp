#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text.hpp"
#include "files/csv_reader.hpp"
#include "files/file.hpp"
#include "history.hpp"
#include "json/document.hpp"
#include "plan/read_scene.hpp"
#include "quantity.hpp"

namespace rouleau::study {

namespace {

using Json = nlohmann::json;

Measured undefined_because(std::string why_not) {
  return {std::numeric_limits<double>::quiet_NaN(), 0, std::move(why_not)};
}

Measured defined_or(double value, const std::string& why_not) {
  return std::isfinite(value) ? Measured{value, 0, ""} : undefined_because(why_not);
}

/// Rows of a table as columns, of one cell or (negative) all that there are.
struct Rows {
  Column strain, time;
};

struct CellRows : Rows {
  const files::StoredTable& table;
  std::vector<std::size_t> rows;

  CellRows(const files::StoredTable& cells, int cell) : table(cells) {
    const Column number = cells.numbers("cell");
    for (std::size_t i = 0; i < number.size(); ++i)
      if (number[i] == cell) rows.push_back(i);
    strain = of("strain");
    time = of("time_s");
  }
  [[nodiscard]] Column of(const std::string& column) const {
    const Column all = table.numbers(column);
    Column chosen;
    for (const std::size_t i : rows) chosen.push_back(all[i]);
    return chosen;
  }
};

/// The value of a column when it is due.
Measured taken(const Rows& rows, const Column& values, const When& when) {
  if (values.empty()) return undefined_because("the run has no output");
  const std::string nothing = "it is not defined at that instant";
  if (when.kind == When::Kind::end) return defined_or(values.back(), "it is not defined at the end of the run");
  const bool by_time = when.kind == When::Kind::time;
  const Column& x = by_time ? rows.time : rows.strain;
  // A stage ends on a whole step, which may lie a little before the strain it was given.
  constexpr double end_of_run = 1e-3;
  if (when.value < x.front() || when.value > x.back() + end_of_run * std::abs(x.back() - x.front())) {
    return undefined_because(std::string("the run has no ") + (by_time ? "time " : "strain ") + number(when.value) +
                             ": it goes from " + number(x.front()) + " to " + number(x.back()));
  }
  if (when.kind == When::Kind::mean_from_strain)
    return defined_or(mean_from(x, values, when.value), "it is not defined at every output from that strain on");
  if (when.value >= x.back()) return defined_or(values.back(), nothing);
  return defined_or(interpolated_at(x, values, when.value), nothing);
}

Measured of_cell(const Quantity& quantity, const files::StoredTable& cells) {
  const CellRows rows(cells, quantity.cell);
  if (rows.rows.empty()) return undefined_because("the run has no cell " + std::to_string(quantity.cell));
  const When when = quantity.at.value_or(When{});
  constexpr double degrees = 180 / std::numbers::pi;
  switch (quantity.kind) {
    case QuantityKind::deformation:
      return taken(rows, rows.of("deformation"), when);
    case QuantityKind::angle: {
      Measured angle = taken(rows, rows.of("angle_rad"), when);
      angle.value *= degrees;
      return angle;
    }
    case QuantityKind::passage:
      return defined_or(interpolated_at(rows.of("angle_rad"), rows.strain, quantity.passed_angle),
                        "the long axis never passes " + number(quantity.passed_angle * degrees) + " deg");
    case QuantityKind::period:
      return defined_or(
          length_of_turns(rows.strain, rows.of(quantity.of_long_axis ? "angle_rad" : "tank_treading_angle_rad"),
                          quantity.turns, quantity.from_strain),
          std::string(quantity.of_long_axis ? "the long axis" : "the outline") + " does not turn " +
              number(quantity.turns) + " times in the run");
    default:
      return taken(rows, rows.of(quantity.column), when);
  }
}

Measured smallest_gap(const Quantity& quantity, const files::StoredTable& cells) {
  const Column number_of = cells.numbers("cell"), step = cells.numbers("step"), gaps = cells.numbers("min_gap_m");
  const Column strain = cells.numbers("strain"), time = cells.numbers("time_s");
  Rows rows;
  Column least;
  double last = -1;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (quantity.cell >= 0 && number_of[i] != quantity.cell) continue;
    if (step[i] != last) {
      rows.strain.push_back(strain[i]);
      rows.time.push_back(time[i]);
      least.push_back(gaps[i]);
    }
    least.back() = std::min(least.back(), gaps[i]);
    last = step[i];
  }
  if (quantity.at) return taken(rows, least, *quantity.at);
  const auto smallest = std::min_element(least.begin(), least.end());
  return smallest == least.end() ? undefined_because("the run has no cell to measure a gap of")
                                 : defined_or(*smallest, "there is no second cell or image to measure a gap to");
}

Measured of_series(const Quantity& quantity, const std::filesystem::path& directory, const files::StoredTable& series) {
  const Rows rows{series.numbers("strain"), series.numbers("time_s")};
  const bool viscosity = quantity.kind == QuantityKind::relative_viscosity;
  const Column values = series.numbers(viscosity ? "relative_viscosity" : quantity.column);
  Measured result = taken(rows, values, quantity.at.value_or(When{}));
  if (!quantity.intrinsic || !result.why_not.empty()) return result;
  const files::StoredTable cells(directory / "cells.csv");
  const Column area = cells.numbers("area_m2"), step = cells.numbers("step");
  double covered = 0;
  for (std::size_t i = 0; i < area.size() && step[i] == step[0]; ++i) covered += area[i];
  if (!(covered > 0)) return undefined_because("the run has no cells that could thicken the fluid");
  const scene::Scene scene = plan::read_unpacked_scene(directory / "scene.json").scene;
  result.value = (result.value - 1) / (covered / scene.domain.size.prod());
  return result;
}

Measured of_dissociation(const Quantity& quantity, const std::filesystem::path& directory, const Json& summary) {
  const files::StoredTable series(directory / "series.csv"), cells(directory / "cells.csv");
  const int count = quantity.count.value_or(static_cast<int>(cells.count_of("cell")));
  const Column strain = series.numbers("strain"), time = series.numbers("time_s"), stage = series.numbers("stage");
  std::size_t sheared = 1;
  while (sheared < strain.size() && strain[sheared] == strain[sheared - 1]) ++sheared;
  if (sheared >= strain.size()) return undefined_because("the run has no sheared stage");
  // The end of the stage before is the beginning of this one.
  std::size_t start = sheared;
  while (start > 0 && stage[start] == stage[sheared]) --start;
  std::vector<CountChange> changes;
  if (summary.contains("contacts") && summary.at("contacts").at("attracting").empty())
    return undefined_because("no interaction attracts the cells to each other");
  for (const Json& event : summary.at("aggregate_history"))
    changes.push_back(
        {event.at("time_s"), event.at("strain"),
         event.contains("joined") ? static_cast<int>(event.at("joined").size()) : event.at("count").get<int>()});
  const Dissociation found = dissociation(changes, strain, time[start], strain[start], count, quantity.for_good);
  if (found.at_start)
    return undefined_because("there are " + std::to_string(count) + " aggregates or more already when shear begins");
  Measured result = defined_or(found.strain, "there are never " + std::to_string(count) + " aggregates" +
                                                 (quantity.for_good ? " that stay apart" : ""));
  if (result.why_not.empty()) result.uncertainty = found.uncertainty;
  return result;
}

Measured of_summary(const Json& value, const std::string& what) {
  return value.is_number() ? Measured{value.get<double>(), 0, ""} : undefined_because("summary.json has no " + what);
}

std::string why_incomplete(const Json& summary) {
  const std::string status = summary.value("status", "unknown");
  if (status == "completed") return "";
  const Json failure = summary.value("failure", Json());
  return "the run " + (status == "diverged" ? std::string("diverged") : "was " + status) +
         (failure.is_object() ? ": " + failure.value("message", "") : "");
}

}  // namespace

Measured measure(const Quantity& quantity, const std::filesystem::path& run_directory) {
  const Json summary = json::Document::read(run_directory / "summary.json").root();
  if (const std::string why_not = why_incomplete(summary); !why_not.empty()) return undefined_because(why_not);
  switch (quantity.kind) {
    case QuantityKind::deformation:
    case QuantityKind::angle:
    case QuantityKind::passage:
    case QuantityKind::period:
      return of_cell(quantity, files::StoredTable(run_directory / "cells.csv"));
    case QuantityKind::gap:
      return smallest_gap(quantity, files::StoredTable(run_directory / "cells.csv"));
    case QuantityKind::area_drift:
      return of_summary(summary.at("conservation").at("area_drift_max"), "area drift: the scene has no cells");
    case QuantityKind::mass_drift:
      return of_summary(summary.at("conservation").at("mass_drift"), "mass drift");
    case QuantityKind::aggregate_count:
      return of_summary(summary.at("aggregates_final"), "number of aggregates");
    case QuantityKind::dissociation_strain:
      return of_dissociation(quantity, run_directory, summary);
    case QuantityKind::relative_viscosity:
      return of_series(quantity, run_directory, files::StoredTable(run_directory / "series.csv"));
    case QuantityKind::velocity_l2:
      return velocity_error(quantity, run_directory);
    case QuantityKind::column:
      return quantity.table == "cells"
                 ? of_cell(quantity, files::StoredTable(run_directory / "cells.csv"))
                 : of_series(quantity, run_directory, files::StoredTable(run_directory / "series.csv"));
  }
  return undefined_because("");
}

}  // namespace rouleau::study
