#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text.hpp"
#include "files/file.hpp"
#include "files/tables.hpp"
#include "json/document.hpp"
#include "plan/read_scene.hpp"
#include "quantity.hpp"

namespace rouleau::study {

namespace {

using Json = nlohmann::json;

Measured defined_or(double value, const std::string& why_not) {
  return std::isfinite(value) ? Measured{value, 0, ""} : undefined_because(why_not);
}

using Combine = double (*)(double, double);
double latest(double, double next) { return next; }
double least(double so_far, double next) { return std::min(so_far, next); }
double sum(double so_far, double next) { return std::isnan(next) ? so_far : so_far + next; }

/// What a column of a table has at each output: of the rows of one cell or, where that is negative, of all rows.
struct Outputs {
  Column strain, time, values;

  Outputs(const files::StoredTable& table, const std::string& column, int cell, Combine combine = latest,
          double start = 0) {
    const Column step = table.numbers("step"), all = table.numbers(column);
    const Column all_strain = table.numbers("strain"), all_time = table.numbers("time_s");
    const Column number_of = cell < 0 ? Column() : table.numbers("cell");
    double last = -1;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (cell >= 0 && number_of[i] != cell) continue;
      if (step[i] != last) {
        strain.push_back(all_strain[i]);
        time.push_back(all_time[i]);
        values.push_back(start);
      }
      values.back() = combine(values.back(), all[i]);
      last = step[i];
    }
  }
};

/// The value of a column when it is due.
Measured taken(const Outputs& rows, const When& when) {
  const Column& values = rows.values;
  if (values.empty()) return undefined_because("the run has no output");
  const std::string nothing = "it is not defined at that instant";
  if (when.kind == When::Kind::end) return defined_or(values.back(), "it is not defined at the end of the run");
  const bool by_time = when.kind == When::Kind::time || when.kind == When::Kind::mean_from_time;
  const Column& x = by_time ? rows.time : rows.strain;
  // A stage ends on a whole step, which may lie a little before the strain it was given.
  constexpr double end_of_run = 1e-3;
  if (when.value < x.front() || when.value > x.back() + end_of_run * std::abs(x.back() - x.front())) {
    return undefined_because(std::string("the run has no ") + (by_time ? "time " : "strain ") + number(when.value) +
                             ": it goes from " + number(x.front()) + " to " + number(x.back()));
  }
  if (when.kind == When::Kind::mean_from_strain || when.kind == When::Kind::mean_from_time)
    return defined_or(mean_from(x, values, when.value), std::string("it is not defined at every output from that ") +
                                                            (by_time ? "time" : "strain") + " on");
  if (when.value >= x.back()) return defined_or(values.back(), nothing);
  return defined_or(interpolated_at(x, values, when.value), nothing);
}

/// How far the centroid comes along an axis in a second, from a time to the end.
Measured speed(const Quantity& quantity, const Outputs& place) {
  const double end = place.time.back(), from = quantity.from_time.value_or((place.time.front() + end) / 2);
  if (!(from < end)) return undefined_because("the run ends at " + number(end) + " s");
  return defined_or((place.values.back() - interpolated_at(place.time, place.values, from)) / (end - from),
                    "the run begins after " + number(from) + " s");
}

/// Columns of cells.csv that kinds are made of; others name their own.
const std::string& column_of(const Quantity& quantity) {
  static const std::string deformation = "deformation", angle = "angle_rad", treading = "tank_treading_angle_rad";
  const bool turns = quantity.kind == QuantityKind::period && !quantity.of_long_axis;
  if (quantity.kind == QuantityKind::deformation) return deformation;
  return !quantity.column.empty() ? quantity.column : turns ? treading : angle;
}

Measured of_cell(const Quantity& quantity, const files::StoredTable& cells) {
  const std::string& column = column_of(quantity);
  if (!cells.has(column)) return undefined_because("a run in two dimensions has no " + column);
  const Outputs rows(cells, column, quantity.cell);
  if (rows.values.empty()) return undefined_because("the run has no cell " + std::to_string(quantity.cell));
  constexpr double degrees = 180 / std::numbers::pi;
  switch (quantity.kind) {
    case QuantityKind::passage:
      return defined_or(interpolated_at(rows.values, rows.strain, quantity.passed_angle),
                        "the long axis never passes " + number(quantity.passed_angle * degrees) + " deg");
    case QuantityKind::period:
      return defined_or(length_of_turns(rows.strain, rows.values, quantity.turns, quantity.from_strain),
                        std::string(quantity.of_long_axis ? "the long axis" : "the outline") + " does not turn " +
                            number(quantity.turns) + " times in the run");
    case QuantityKind::speed:
      return speed(quantity, rows);
    default: {
      Measured result = taken(rows, quantity.at.value_or(When{}));
      if (quantity.kind == QuantityKind::angle) result.value *= degrees;
      return result;
    }
  }
}

Measured smallest_gap(const Quantity& quantity, const files::StoredTable& cells) {
  const Outputs gaps(cells, "min_gap_m", quantity.cell, least, std::numeric_limits<double>::infinity());
  if (quantity.at) return taken(gaps, *quantity.at);
  const auto smallest = std::min_element(gaps.values.begin(), gaps.values.end());
  return smallest == gaps.values.end() ? undefined_because("the run has no cell to measure a gap of")
                                       : defined_or(*smallest, "there is no second cell or image to measure a gap to");
}

/// Of all contacts together; cells without one add nothing.
Measured contact(const Quantity& quantity, const files::StoredTable& aggregates) {
  const std::string area = "contact_area_m2", length = "contact_length_m";
  const std::string& wanted = quantity.kind == QuantityKind::contact_area ? area : length;
  if ((wanted == area) != aggregates.has(area))
    return undefined_because(wanted == area ? "contacts in two dimensions have no area: ask for contact_length"
                                            : "contacts in three dimensions have an area: ask for contact_area");
  return taken(Outputs(aggregates, wanted, -1, sum), quantity.at.value_or(When{}));
}

Measured of_series(const Quantity& quantity, const std::filesystem::path& directory, const files::StoredTable& series) {
  const bool viscosity = quantity.kind == QuantityKind::relative_viscosity;
  const Outputs rows(series, viscosity ? "relative_viscosity" : quantity.column, -1);
  Measured result = taken(rows, quantity.at.value_or(When{}));
  if (!quantity.intrinsic || !result.why_not.empty()) return result;
  const scene::Scene scene = plan::read_unpacked_scene(directory / "scene.json").scene;
  const files::StoredTable cells(directory / "cells.csv");
  const Outputs enclosed(cells, scene.domain.words().content_column, -1, sum);
  if (enclosed.values.empty() || !(enclosed.values[0] > 0))
    return undefined_because("the run has no cells that could thicken the fluid");
  result.value = (result.value - 1) / (enclosed.values[0] / scene.domain.content());
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
    case QuantityKind::speed:
      return of_cell(quantity, files::StoredTable(run_directory / "cells.csv"));
    case QuantityKind::gap:
      return smallest_gap(quantity, files::StoredTable(run_directory / "cells.csv"));
    case QuantityKind::contact_area:
    case QuantityKind::contact_length:
      return contact(quantity, files::StoredTable(run_directory / "aggregates.csv"));
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
