#include "quantities.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "files/tables.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "observe/cell_free_layer.hpp"
#include "observe/observables.hpp"
#include "plan/error_model.hpp"

namespace rouleau::accuracy {

namespace {

using Json = nlohmann::json;
using Column = std::vector<double>;

constexpr std::size_t most_single_cells = 8;

/// Columns of series.csv that measure an error themselves, or hold the energy of a fluid that is made denser.
constexpr std::array<std::string_view, 6> no_results{"mach_max",         "area_drift_max", "mass_drift",
                                                     "area_leakage_max", "kinetic_energy", "total_energy"};

void add(std::vector<Quantity>& all, Quantity quantity) {
  if (std::isfinite(quantity.value)) all.push_back(std::move(quantity));
}

/// Columns of cells.csv, those of three dimensions, that are reported as they are at the end.
constexpr std::array<const char*, 8> last_values{
    "extent_x_m",         "extent_y_m",         "extent_z_m",    "tank_treading_frequency_1_per_s",
    "velocity_x_m_per_s", "velocity_over_mean", "rear_hollow_m", "offset_from_axis_m"};

/// Rows of one cell.
struct CellColumns {
  long number = 0;
  std::array<double, last_values.size()> last{};
  Column strain, time, angle, deformation, y;
  std::size_t rows = 0;  ///< until the end of the scene's own stages
};

/// Rows of series.csv until the end of the scene's own stages.
std::size_t own_rows(const files::StoredTable& series, const std::string& beyond) {
  if (beyond.empty()) return series.rows();
  const std::vector<std::string> stages = series.texts("stage_name");
  return static_cast<std::size_t>(std::find(stages.begin(), stages.end(), beyond) - stages.begin());
}

/// The cells that are there at the end. end: time of the last of these rows.
std::vector<CellColumns> read_cells(const std::filesystem::path& file, double end) {
  const files::StoredTable table(file);
  std::map<double, CellColumns> cells;
  const Column number = table.numbers("cell"), strain = table.numbers("strain"), time = table.numbers("time_s"),
               angle = table.numbers("angle_rad"), deformation = table.numbers("deformation"), y = table.numbers("y_m");
  std::array<Column, last_values.size()> others;
  for (std::size_t k = 0; k < others.size(); ++k)
    if (table.has(last_values[k])) others[k] = table.numbers(last_values[k]);
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (!std::isfinite(number[i])) continue;
    CellColumns& cell = cells[number[i]];
    cell.number = std::lround(number[i]);
    cell.strain.push_back(strain[i]);
    cell.time.push_back(time[i]);
    cell.angle.push_back(angle[i]);
    cell.deformation.push_back(deformation[i]);
    cell.y.push_back(y[i]);
    if (!(time[i] <= end)) continue;
    cell.rows = cell.time.size(), last = std::max(last, time[i]);
    for (std::size_t k = 0; k < others.size(); ++k) cell.last[k] = others[k].empty() ? std::nan("") : others[k][i];
  }
  std::vector<CellColumns> there;
  for (auto& [key, cell] : cells)
    if (cell.rows > 0 && cell.time[cell.rows - 1] == last) there.push_back(std::move(cell));
  return there;
}

void add_passages(std::vector<Quantity>& all, const CellColumns& cell, const std::string& prefix, bool principal) {
  const bool strained = cell.strain.back() > cell.strain.front();
  constexpr double part = std::numbers::pi / 4;
  const std::vector<Passage> found = passages(strained ? cell.strain : cell.time, cell.angle, part);
  if (found.size() < 3) return;  // a cell that keeps its inclination may rock about one of them
  for (const Passage& passage : found) {
    const bool told = principal && passage.multiple % 2 == 0;
    add(all, {.name = prefix + (strained ? "passage_strain_" : "passage_time_s_") +
                      std::to_string(45 * passage.multiple) + "_deg",
              .value = passage.at,
              .uncertainty = passage.uncertainty,
              .principal = told,
              .moment = true,
              .least_whole = strained ? std::min(plan::first_events, cell.strain.back()) : 0});
  }
}

void add_cells(std::vector<Quantity>& all, const std::vector<CellColumns>& cells) {
  if (cells.empty()) return;
  double sum = 0;
  for (const CellColumns& cell : cells) sum += cell.deformation[cell.rows - 1];
  const double mean = sum / static_cast<double>(cells.size());
  add(all, {.name = "deformation", .value = mean, .part_of_cells = mean, .principal = true});
  if (cells.size() > most_single_cells) return;
  std::size_t most = 0;
  for (const CellColumns& cell : cells) most = std::max(most, cell.rows);
  for (const CellColumns& cell : cells) {
    if (cell.rows < most) continue;  // it has come in: another run may have another one
    const bool lone = cells.size() == 1;
    const std::string prefix = lone ? "" : "cell_" + std::to_string(cell.number) + "_";
    const double deformation = cell.deformation[cell.rows - 1], angle = cell.angle[cell.rows - 1];
    if (!lone) add(all, {.name = prefix + "deformation", .value = deformation, .part_of_cells = deformation});
    const bool inclined = std::abs(angle) < std::numbers::pi / 2;  // an angle that turns on is large for another reason
    add(all, {.name = prefix + "angle_rad", .value = angle, .part_of_cells = inclined ? angle : 0, .principal = lone});
    add(all, {.name = prefix + "y_m", .value = cell.y[cell.rows - 1]});
    for (std::size_t k = 0; k < last_values.size(); ++k)
      add(all, {.name = prefix + last_values[k], .value = cell.last[k]});
    add_passages(all, cell, prefix, lone);
  }
}

/// How much of an instant's value of series.csv is the cells' doing.
double part_of_cells(std::string_view name, double value, double relative_viscosity) {
  if (name == "elastic_energy" || name == "bending_energy" || name == "particle_stress") return value;
  const bool power = name == "viscous_dissipation" || name == "wall_power";
  return power && std::isfinite(relative_viscosity) ? value * (1 - 1 / relative_viscosity) : 0;
}

/// Whether cells attract each other: aggregates of those that do not are nothing that could have an error.
bool attracts(const Json& summary) { return !summary.at("contacts").at("attracting").empty(); }

void add_series(std::vector<Quantity>& all, const files::StoredTable& table, std::size_t rows, bool attracting) {
  if (rows == 0) return;
  const double viscosity = table.numbers("relative_viscosity")[rows - 1];
  for (const observe::Observable& observable : observe::table("series").observables) {
    const bool result = std::find(no_results.begin(), no_results.end(), observable.name) == no_results.end();
    const std::string column = observable.column();
    if (!result || observable.has_means || observable.chart.empty() || !table.has(column)) continue;
    const double value = table.numbers(column)[rows - 1];
    if (observable.name == "aggregate_count") {
      if (attracting) add(all, {.name = "aggregates", .value = value, .nature = Nature::count});
    } else if (value != 0)
      add(all, {.name = column, .value = value, .part_of_cells = part_of_cells(observable.name, value, viscosity)});
  }
}

/// Whether a mean of a stage is a result, rather than what says whether another one is.
bool is_result(const std::string& column, const Json& means, bool attracting) {
  if (column.starts_with("aggregate_size") || column.starts_with("contact")) return attracting;
  if (!column.starts_with("cell_free_layer")) return column.find("normal_stress") == std::string::npos;
  const Json& empty = means.at("cell_free_layer_empty");
  return column != "cell_free_layer_empty" && empty.is_object() &&
         empty.at("mean").get<double>() < observe::most_empty_columns;
}

void add_means(std::vector<Quantity>& all, const Json& stages, bool attracting) {
  std::set<std::string> named;  // by a later stage
  for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
    for (const auto& [column, mean] : stage->at("means").items()) {
      if (!mean.is_object() || !mean.at("mean").is_number()) continue;
      if (!is_result(column, stage->at("means"), attracting)) continue;
      const double value = mean.at("mean");
      const bool last = named.insert(column).second, viscosity = column == "relative_viscosity";
      add(all, {.name = (last ? "" : stage->at("stage").get<std::string>() + ": ") + column,
                .value = value,
                .part_of_cells = viscosity ? value - 1 : 0,
                .principal = last && (viscosity || column == "flow_rate_m2_per_s")});
    }
  }
}

void add_turning(std::vector<Quantity>& all, const Json& stage) {
  const Json& cells = stage.at("rotation");
  if (cells.size() > most_single_cells) return;
  for (const Json& cell : cells) {
    if (!(cell.value("turns", 0.0) >= 1)) continue;  // a part of a turn has no mean rate
    for (const char* rate : {"tank_treading_rad_per_strain", "tumbling_rad_per_strain"}) {
      if (!cell.contains(rate) || !cell.at(rate).is_number()) continue;
      const double value = cell.at(rate);
      const std::string number = std::to_string(cell.at("cell").get<int>());
      add(all, {.name = (cells.size() == 1 ? "" : "cell_" + number + "_") + rate, .value = value});
    }
  }
}

void add_partings(std::vector<Quantity>& all, const Json& stages, double strain_of_run) {
  std::set<std::string> named;  // by a later stage
  for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
    for (const Json& aggregate : stage->at("dissociation")) {
      std::string members;
      for (const Json& cell : aggregate.at("members")) members += (members.empty() ? "" : "+") + cell.dump();
      for (const char* event : {"parted", "separate"}) {
        const Json& when = aggregate.at(event);
        if (event == std::string("separate") && aggregate.at("members").size() == 2) continue;  // the same as parted
        if (!when.is_object() || !when.at("strain").is_number() || when.at("strain") == 0) continue;
        const double strain = when.at("strain"), before = when.at("strain_before");
        const std::string name = std::string(event) + "_strain_" + members;
        const bool last = named.insert(name).second;
        add(all, {.name = (last ? "" : stage->at("stage").get<std::string>() + ": ") + name,
                  .value = strain,
                  .uncertainty = strain - before,
                  .principal = last,
                  .moment = true,
                  .least_whole = std::min(plan::first_events, strain_of_run)});
      }
    }
  }
}

/// The angle at which a cell was placed: the multiple of `part` that it is up to rounding, for what a cell leaves it
/// does not pass.
double without_rounding(double angle, double part) {
  constexpr double rounding = 1e-9;
  const double nearest = part * std::round(angle / part);
  return std::abs(angle - nearest) < rounding ? nearest : angle;
}

}  // namespace

std::vector<Passage> passages(const std::vector<double>& x, const std::vector<double>& angle, double part) {
  std::vector<Passage> found;
  std::set<int> passed;
  for (std::size_t i = 0; i + 1 < angle.size(); ++i) {
    const double from = i == 0 ? without_rounding(angle[i], part) : angle[i], to = angle[i + 1];
    if (!std::isfinite(from) || !std::isfinite(to) || from == to) continue;
    const bool falls = to < from;
    // Multiples in (from, to], in the order in which they are passed.
    const double first = falls ? std::ceil(from / part) - 1 : std::floor(from / part) + 1;
    const double last = falls ? std::ceil(to / part) : std::floor(to / part);
    double bend = 0;  // largest second difference at the two rows
    for (const std::size_t middle : {i, i + 1}) {
      if (middle == 0 || middle + 1 >= angle.size()) continue;
      const double second = angle[middle + 1] - 2 * angle[middle] + angle[middle - 1];
      if (std::isfinite(second)) bend = std::max(bend, std::abs(second));
    }
    for (double k = first; falls ? k >= last : k <= last; k += falls ? -1 : 1) {
      if (!passed.insert(static_cast<int>(k)).second) continue;
      const double slope = (to - from) / (x[i + 1] - x[i]);
      // A parabola lies at most an eighth of its second difference beside its chord.
      const double uncertainty = std::min(bend / 8 / std::abs(slope), std::abs(x[i + 1] - x[i]));
      found.push_back({static_cast<int>(k), x[i] + (k * part - from) / slope, uncertainty});
    }
  }
  return found;
}

std::vector<Quantity> reported_quantities(const std::filesystem::path& run_directory, const std::string& beyond) {
  std::vector<Quantity> all;
  const Json summary = json::Document::read(run_directory / "summary.json").root();
  const files::StoredTable series(run_directory / "series.csv");
  const std::size_t rows = own_rows(series, beyond);
  if (rows > 0) add_cells(all, read_cells(run_directory / "cells.csv", series.numbers("time_s")[rows - 1]));
  Json stages = summary.at("rheology");
  if (!beyond.empty() && !stages.empty() && stages.back().at("stage") == beyond) stages.erase(stages.size() - 1);
  add_means(all, stages, attracts(summary));
  if (!stages.empty()) add_turning(all, stages.back());
  add_partings(all, stages, rows > 0 ? series.numbers("strain")[rows - 1] : 0);
  add_series(all, series, rows, attracts(summary));
  return all;
}

}  // namespace rouleau::accuracy
