#include "report_data.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "files/file.hpp"
#include "files/frames.hpp"
#include "files/tables.hpp"
#include "files/verify.hpp"
#include "json/document.hpp"
#include "observe/observables.hpp"
#include "report_cells.hpp"
#include "report_fields.hpp"
#include "report_outlines.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;
using Selection = std::vector<std::size_t>;

constexpr std::size_t most_outputs = 400;
constexpr std::size_t most_points = 300000;  ///< of all outlines: about 1.6 MB of page
constexpr std::size_t fewest_nodes = 24;     ///< of an outline
constexpr std::size_t most_fields = 120;     ///< outputs whose flow is shown
// Larger files are not read: there is no page for as many cells, and a run that has ended must not fail for its page.
constexpr std::uintmax_t most_bytes = 1'000'000'000;  ///< of cells.csv
constexpr std::size_t most_nodes_read = 20'000'000;   ///< of a frame
/// Five digits are more than a screen shows and keep the page small; an axis needs more where a run is long.
Json shown_value(double value, int precision = 5) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, precision).ptr;
  double rounded = 0;
  std::from_chars(digits.data(), end, rounded);
  return rounded;
}

Json picked(const std::vector<double>& values, const Selection& selection, double factor = 1, int precision = 5) {
  Json result = Json::array();
  for (const std::size_t i : selection) result.push_back(shown_value(factor * values[i], precision));
  return result;
}

/// A line for each cell from a column of cells.csv, from the output on at which it came to the last one.
Json lines(const std::vector<double>& column, const CellRows& rows, const ShownCells& shown, const Selection& selection,
           double factor) {
  constexpr int precision = 4;
  Json result = Json::array();
  for (std::size_t i = 0; i < shown.cells.size(); ++i) {
    Json line = Json::array();
    for (std::size_t k = shown.from[i]; k <= shown.to[i]; ++k) {
      const std::optional<std::size_t> row = rows.row(selection[k], shown.cells[i]);
      line.push_back(row ? shown_value(factor * column[*row], precision) : Json());
    }
    result.push_back(std::move(line));
  }
  return result;
}

/// Speeds of all cells' centroids from the outputs before and after, laid out as a column of cells.csv, m/s.
std::vector<double> cell_speeds(const files::StoredTable& cells, const CellRows& rows, std::size_t outputs) {
  const auto x = cells.numbers("x_m"), y = cells.numbers("y_m"), time = cells.numbers("time_s");
  std::vector<double> speeds(rows.end(outputs - 1), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t output = 0; output < outputs; ++output) {
    const std::size_t before = output > 0 ? output - 1 : 0, after = std::min(output + 1, outputs - 1);
    for (std::size_t row = rows.begin(output); row < rows.end(output); ++row) {
      const std::size_t cell = rows.cell(row), a = rows.row(before, cell).value_or(row),
                        b = rows.row(after, cell).value_or(row);
      if (time[b] > time[a]) speeds[row] = std::hypot(x[b] - x[a], y[b] - y[a]) / (time[b] - time[a]);
    }
  }
  return speeds;
}

/// How a page shows an observable: lengths in micrometres, angles in degrees.
struct Shown {
  std::string name, unit;
  double factor;
};

Shown shown(const observe::Observable& observable) {
  const std::string name(observable.name);
  if (observable.unit == "m") return {name + "_um", "µm", micro};
  if (observable.unit == "rad") return {name + "_deg", "°", 180 / std::numbers::pi};
  return {observable.column(), std::string(observable.unit), 1};
}

/// What charts there are and which lines each has, in the order of the columns. Of what not every run has, those that
/// cells.csv (null: not read) or series.csv has.
Json charts(const files::StoredTable* cells, const files::StoredTable& series) {
  Json list = Json::array();
  for (const char* table : {"cells", "series"}) {
    for (const observe::Observable& observable : observe::table(table).observables) {
      const bool in_some = observable.of_traffic || observable.of_forces;
      const auto there = [&](const auto* one) { return one != nullptr && one->has(observable.column()); };
      if (observable.chart.empty() || (in_some && !there(cells) && !there(&series))) continue;
      const Shown as = shown(observable);
      auto chart =
          std::find_if(list.begin(), list.end(), [&](const Json& c) { return c["title"] == observable.chart; });
      if (chart == list.end()) {
        list.push_back({{"title", observable.chart}, {"unit", as.unit}, {"table", table}, {"lines", Json::array()}});
        chart = list.end() - 1;
      }
      (*chart)["lines"].push_back({{"name", as.name}, {"label", observable.line}, {"doc", observable.doc}});
    }
  }
  return list;
}

Json cell_data(const files::StoredTable& table, const CellRows& rows, std::size_t outputs, const Selection& selection) {
  const auto types = table.texts("type");
  const ShownCells shown_cells(rows, selection);
  Json cells{{"ids", shown_cells.cells}, {"types", Json::array()}, {"aggregate", Json::array()}};
  for (const std::size_t row : shown_cells.row) cells["types"].push_back(types[row]);
  if (shown_cells.changes) cells["from"] = shown_cells.from;
  const auto aggregate = table.numbers("aggregate");
  for (const std::size_t output : selection) {
    Json labels = Json::array();
    for (const std::size_t cell : shown_cells.cells) {
      const std::optional<std::size_t> row = rows.row(output, cell);
      labels.push_back(row ? Json(std::lround(aggregate[*row])) : Json());
    }
    while (!labels.empty() && labels.back().is_null()) labels.erase(labels.size() - 1);
    cells["aggregate"].push_back(std::move(labels));
  }
  for (const observe::Observable& observable : observe::table("cells").observables) {
    if (observable.chart.empty() || !table.has(observable.column())) continue;
    const Shown as = shown(observable);
    cells[as.name] = lines(table.numbers(observable.column()), rows, shown_cells, selection, as.factor);
  }
  cells["speed_um_per_s"] = lines(cell_speeds(table, rows, outputs), rows, shown_cells, selection, micro);
  return cells;
}

Json series_data(const files::StoredTable& series, const Selection& selection) {
  Json data;
  for (const observe::Observable& observable : observe::table("series").observables) {
    // Runs of earlier versions do not have all columns.
    if (observable.chart.empty() || !series.has(observable.column())) continue;
    const Shown as = shown(observable);
    auto values = series.numbers(observable.column());
    // The fluid's kinetic energy is that of a fluid density_factor times too dense: a page's total is without it.
    if (observable.name == "total_energy" && series.has("kinetic_energy_J_per_m")) {
      const auto kinetic = series.numbers("kinetic_energy_J_per_m");
      std::transform(values.begin(), values.end(), kinetic.begin(), values.begin(), std::minus<>());
    }
    data[as.name] = picked(values, selection, as.factor);
  }
  return data;
}

/// Which outputs a page shows, and how many of their nodes.
struct Choice {
  Selection outputs;
  std::size_t stride = 1;
};

Choice choose(const std::vector<double>& aggregate_count, std::size_t nodes, std::size_t cells,
              const Selection& with_fields) {
  Choice choice{shown_outputs(aggregate_count, most_outputs)};
  while (choice.outputs.size() * nodes / choice.stride > most_points &&
         nodes / std::max<std::size_t>(1, cells) / (choice.stride + 1) >= fewest_nodes)
    ++choice.stride;
  const std::size_t per_output = std::max<std::size_t>({1, nodes / choice.stride, cells * fewest_nodes});
  if (choice.outputs.size() * per_output > most_points)
    choice.outputs = shown_outputs(aggregate_count, std::max<std::size_t>(50, most_points / per_output));

  std::set<std::size_t> outputs(choice.outputs.begin(), choice.outputs.end());
  for (const std::size_t output : with_fields)
    if (output < aggregate_count.size() && (outputs.size() + 1) * per_output <= most_points) outputs.insert(output);
  choice.outputs.assign(outputs.begin(), outputs.end());
  return choice;
}

/// Summary and scene as the run has written them; null where it has not.
Json as_written(const std::filesystem::path& directory) {
  if (!has_run(directory))
    throw Error(Cause::bad_input, Place{directory.string()},
                "is no run's directory: it has neither summary.json nor series.csv");
  const bool ended = std::filesystem::exists(directory / "summary.json");
  for (const char* name : {"summary.json", "scene.json"}) files::require_own(directory / name);
  Json data;
  data["summary"] = ended ? json::Document::read(directory / "summary.json").root() : Json(nullptr);
  const bool has_scene = std::filesystem::exists(directory / "scene.json");
  data["scene"] = has_scene ? Json(files::read_text(directory / "scene.json")) : Json(nullptr);
  return data;
}

/// What has changed since the run wrote it, of the files that a page is made of.
Json damage_of(const std::filesystem::path& directory, const Json& summary) {
  Json damage = Json::array();
  if (summary.contains("files")) {
    const auto shown_here = [](const std::string& name) { return name.ends_with(".csv") || name == "scene.json"; };
    for (const std::string& difference : files::verify(directory, shown_here).differences) damage.push_back(difference);
  }
  return damage;
}

/// When each output was, in time, strain, steps and stages.
void add_instants(const files::StoredTable& series, const std::vector<std::size_t>& selection, Json& data) {
  constexpr int axis_precision = 9;
  for (const char* name : {"time_s", "strain"}) data[name] = picked(series.numbers(name), selection, 1, axis_precision);
  const auto steps = series.numbers("step");
  const auto stages = series.texts("stage_name");
  data["step"] = data["stage"] = Json::array();
  for (const std::size_t i : selection) {
    data["step"].push_back(std::llround(steps[i]));
    data["stage"].push_back(stages[i]);
  }
  data["shear_rate"] =
      series.has("shear_rate_1_per_s") ? picked(series.numbers("shear_rate_1_per_s"), selection) : Json();
}

/// All or none. `stride`: 0: no membranes.
void add_frames(const files::FrameReader& reader, const std::filesystem::path& frames, const Selection& selection,
                std::size_t stride, Json& data) {
  data["domain"] = {{"size_um", reader.size()}, {"periodic", reader.periodic()}};
  for (Json& length : data["domain"]["size_um"]) length = length.get<double>() * micro;
  Json outlines, surfaces, walls = wall_data(reader);
  if (stride > 0) outlines = outline_data(reader, selection, stride), surfaces = surface_data(reader, selection);
  data["fields"] = field_data(frames, selection);
  data["outlines"] = std::move(outlines), data["surfaces"] = std::move(surfaces), data["walls"] = std::move(walls);
}

/// Without the folder, which readers of a page need not know.
std::string words_of(const Error& error, const std::filesystem::path& directory) {
  std::string words = error.what();
  const std::string folder = (directory / "").string();
  for (auto at = words.find(folder); at != std::string::npos; at = words.find(folder)) words.erase(at, folder.size());
  return words;
}

std::string words_without_cells(std::uintmax_t bytes) {
  return "No animation, no charts of cells: cells.csv has " + std::to_string(bytes / 1'000'000) +
         " MB, and a page is made of up to " + std::to_string(most_bytes / 1'000'000) + ". The files have all of it.";
}

}  // namespace

std::vector<std::size_t> shown_outputs(const std::vector<double>& aggregate_count, std::size_t most) {
  const std::size_t n = aggregate_count.size();
  std::set<std::size_t> selected;
  if (n <= most) {
    for (std::size_t i = 0; i < n; ++i) selected.insert(i);
  } else {
    for (std::size_t k = 0; k < most; ++k) selected.insert(k * (n - 1) / (most - 1));
    std::size_t changes = 0;
    for (std::size_t i = 1; i < n && changes < most / 2; ++i)
      if (aggregate_count[i] != aggregate_count[i - 1]) {
        selected.insert({i - 1, i});
        ++changes;
      }
  }
  return {selected.begin(), selected.end()};
}

bool has_run(const std::filesystem::path& directory) {
  return std::filesystem::exists(directory / "summary.json") || std::filesystem::exists(directory / "series.csv");
}

Json report_data(const std::filesystem::path& directory) {
  Json data = as_written(directory);
  const bool ended = !data["summary"].is_null();

  const files::StoredTable series(directory / "series.csv");
  std::error_code missing;
  const std::uintmax_t bytes = std::filesystem::file_size(directory / "cells.csv", missing);
  std::optional<files::StoredTable> cells;
  if (missing || bytes <= most_bytes) cells.emplace(directory / "cells.csv");
  std::optional<CellRows> rows;
  if (cells && cells->rows() > 0) rows.emplace(*cells, series);
  std::size_t outputs = series.rows();
  Json damage = damage_of(directory, data["summary"]);
  // A run that goes on, or was killed, may lack the last rows of a file; one that has ended may not.
  const auto take = [&](const char* file, std::size_t has) {
    if (ended && has < series.rows())
      damage.push_back(std::string(file) + " holds " + std::to_string(has) + " of the " +
                       std::to_string(series.rows()) + " outputs of series.csv: it was cut short; bring the whole " +
                       "file back, or run the scene again. What is shown here ends where it ends.");
    outputs = std::min(outputs, has);
  };
  if (rows) take("cells.csv", rows->outputs());

  std::optional<files::FrameReader> reader;
  std::string note;
  const auto without_animation = [&](const Error& error) {  // the rest of the page is worth having
    reader.reset();
    const std::string words = words_of(error, directory);
    note = "No animation: " + words;
    if (ended) damage.push_back(words);
  };
  if (!cells) note = words_without_cells(bytes);
  std::size_t nodes = 0;
  bool drawn = cells.has_value();
  Selection with_fields;
  try {
    reader.emplace(directory / "frames.h5");
    take("frames.h5", static_cast<std::size_t>(reader->frames()));
    if (outputs > 0) {
      const int fullest = rows ? static_cast<int>(std::min(rows->fullest(), outputs - 1)) : 0;
      if (reader->nodes(fullest) > most_nodes_read && drawn) {
        drawn = false;
        note = "No animation: a frame has " + std::to_string(reader->nodes(fullest)) +
               " nodes of membranes, and a page is made of up to " + std::to_string(most_nodes_read) +
               ". frames.h5 has all of them.";
      }
      const auto outlines = drawn ? reader->outlines(fullest) : observe::OutlineSnapshot{};
      if (outlines.triangles.empty()) nodes = outlines.x.size();  // surfaces are thinned on their own
      with_fields = field_outputs(directory / "frames.h5", most_fields);
    }
  } catch (const Error& error) {
    without_animation(error);
  }

  auto aggregate_count = series.numbers("aggregate_count");
  aggregate_count.resize(outputs);
  const std::size_t count = rows && rows->outputs() > 0 ? rows->count(rows->fullest()) : 0;
  const auto [selection, stride] = choose(aggregate_count, nodes, count, with_fields);

  data["shown"] = {{"outputs", selection.size()}, {"of", outputs}, {"node_stride", stride}};
  add_instants(series, selection, data);
  data["charts"] = charts(cells ? &*cells : nullptr, series);
  data["series"] = series_data(series, selection);
  data["cells"] = count > 0 && outputs > 0 ? cell_data(*cells, *rows, outputs, selection) : Json(nullptr);
  data["outlines"] = data["fields"] = data["surfaces"] = data["walls"] = nullptr;
  if (reader && outputs > 0) {
    try {
      add_frames(*reader, directory / "frames.h5", selection, drawn ? stride : 0, data);
    } catch (const Error& error) {
      without_animation(error);
    }
  }
  if (note.empty() && count > 0 && outputs > 0 && data["outlines"].is_null() && data["surfaces"].is_null())
    note = "No animation: the number of membrane nodes changes during the run.";
  data["shown"]["note"] = note;
  data["shown"]["damage"] = damage;
  return data;
}

}  // namespace rouleau::report
