#include "output/report_data.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>

#include "input/document.hpp"
#include "output/file.hpp"
#include "output/frames.hpp"
#include "output/report_table.hpp"

namespace rouleau::host {

namespace {

using nlohmann::json;
using Selection = std::vector<std::size_t>;

constexpr std::size_t most_outputs = 400;
constexpr std::size_t most_lines = 12;       ///< of a chart
constexpr std::size_t most_points = 300000;  ///< of all outlines: about 1.6 MB of page
constexpr std::size_t fewest_nodes = 24;     ///< of an outline
constexpr double micro = 1e6;

/// Five digits are more than a screen shows and keep the page small.
json shown(double value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 5).ptr;
  double rounded = 0;
  std::from_chars(digits.data(), end, rounded);
  return rounded;
}

json picked(const std::vector<double>& values, const Selection& selection, double factor = 1) {
  json result = json::array();
  for (const std::size_t i : selection) result.push_back(shown(factor * values[i]));
  return result;
}

/// Lines of a chart from a column of cells.csv: `count` cells per output.
json lines(const std::vector<double>& column, std::size_t count, const Selection& selection, double factor) {
  json result = json::array();
  const auto at = [&](std::size_t output, std::size_t cell) { return factor * column[output * count + cell]; };
  if (count <= most_lines) {
    for (std::size_t cell = 0; cell < count; ++cell) {
      json line = json::array();
      for (const std::size_t output : selection) line.push_back(shown(at(output, cell)));
      result.push_back(std::move(line));
    }
    return result;
  }
  json smallest = json::array(), mean = json::array(), largest = json::array();
  for (const std::size_t output : selection) {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    int finite = 0;
    for (std::size_t cell = 0; cell < count; ++cell) {
      const double value = at(output, cell);
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
      sum += value;
      ++finite;
    }
    smallest.push_back(shown(low));
    mean.push_back(shown(finite > 0 ? sum / finite : std::numeric_limits<double>::quiet_NaN()));
    largest.push_back(shown(high));
  }
  return json::array({smallest, mean, largest});
}

json cell_data(const StoredTable& table, std::size_t count, const Selection& selection) {
  json cells{{"labels", json::array()}, {"aggregate", json::array()}};
  const auto types = table.texts("type");
  if (count <= most_lines)
    for (std::size_t cell = 0; cell < count; ++cell)
      cells["labels"].push_back("cell " + std::to_string(cell) + " (" + types[cell] + ")");
  else
    cells["labels"] = {"smallest", "mean", "largest"};
  const auto aggregate = table.numbers("aggregate");
  for (const std::size_t output : selection) {
    json labels = json::array();
    for (std::size_t cell = 0; cell < count; ++cell) labels.push_back(std::lround(aggregate[output * count + cell]));
    cells["aggregate"].push_back(std::move(labels));
  }
  cells["deformation"] = lines(table.numbers("deformation"), count, selection, 1);
  cells["angle_deg"] = lines(table.numbers("angle_rad"), count, selection, 180 / std::numbers::pi);
  cells["min_gap_um"] = lines(table.numbers("min_gap_m"), count, selection, micro);
  return cells;
}

/// One output's outlines as the page holds them.
void add_outlines(json& result, const OutlineSnapshot& outlines, std::size_t stride, double quantum) {
  json origins = json::array();
  std::vector<unsigned char> bytes;
  const auto add = [&](double metres) {
    const double limit = std::numeric_limits<std::int16_t>::max();
    if (!std::isfinite(metres)) metres = 0;  // the last output of a diverged run
    const auto value = static_cast<std::int16_t>(std::lround(std::clamp(metres / quantum, -limit, limit)));
    const auto bits = static_cast<std::uint16_t>(value);
    bytes.push_back(static_cast<unsigned char>(bits & 0xff));
    bytes.push_back(static_cast<unsigned char>(bits >> 8));
  };
  for (std::size_t cell = 0; cell + 1 < outlines.first.size(); ++cell) {
    const auto begin = static_cast<std::size_t>(outlines.first[cell]),
               end = static_cast<std::size_t>(outlines.first[cell + 1]);
    // The middle of the bounding box keeps every node within half its extent.
    const auto middle = [&](const std::vector<double>& v) {
      const auto [low, high] =
          std::minmax_element(v.begin() + static_cast<long>(begin), v.begin() + static_cast<long>(end));
      return std::round((*low + *high) / 2 / quantum) * quantum;
    };
    const double x = middle(outlines.x), y = middle(outlines.y);
    origins.push_back(std::round(x * micro * 1000) / 1000);
    origins.push_back(std::round(y * micro * 1000) / 1000);
    for (std::size_t i = begin; i < end; i += stride) {
      add(outlines.x[i] - x);
      add(outlines.y[i] - y);
    }
  }
  result["origin_um"].push_back(std::move(origins));
  result["nodes"].push_back(base64(bytes));
}

json outline_data(const FrameReader& reader, const Selection& selection, std::size_t stride) {
  const auto size = reader.size();
  json result{{"size_um", {size[0] * micro, size[1] * micro}},
              {"periodic_y", reader.periodic_y()},
              {"first", json::array()},
              {"origin_um", json::array()},
              {"nodes", json::array()}};
  const double quantum = std::max(1e-9, std::hypot(size[0], size[1]) / std::numeric_limits<std::int16_t>::max());
  result["quantum_um"] = quantum * micro;
  std::vector<int> first;
  for (const std::size_t output : selection) {
    const auto outlines = reader.outlines(static_cast<int>(output));
    if (first.empty()) {
      first = outlines.first;
      std::size_t shown_nodes = 0;
      for (std::size_t cell = 0; cell < first.size(); ++cell) {
        result["first"].push_back(shown_nodes);
        if (cell + 1 < first.size()) {
          const auto nodes = static_cast<std::size_t>(first[cell + 1] - first[cell]);
          shown_nodes += (nodes + stride - 1) / stride;
        }
      }
    }
    if (first.empty() || outlines.first != first) return nullptr;
    add_outlines(result, outlines, stride, quantum);
  }
  return first.empty() ? json(nullptr) : result;
}

}  // namespace

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? unsigned{bytes[i + k]} : 0u; };
    const unsigned triple = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (unsigned k = 0; k < 4; ++k) text += i + k <= bytes.size() ? letters[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

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

json report_data(const std::filesystem::path& directory) {
  const bool ended = std::filesystem::exists(directory / "summary.json");
  if (!ended && !std::filesystem::exists(directory / "series.csv"))
    throw Error(ExitCode::bad_input, Place{directory.string(), "", 0, 0},
                "is no run's directory: it has neither summary.json nor series.csv");
  json data;
  data["summary"] = ended ? Document::read(directory / "summary.json").root() : json(nullptr);
  const bool has_scene = std::filesystem::exists(directory / "scene.json");
  data["scene"] = has_scene ? json(read_text(directory / "scene.json")) : json(nullptr);

  const StoredTable series(directory / "series.csv");
  const StoredTable cells(directory / "cells.csv");
  std::size_t outputs = series.rows(), count = 0, stride = 1;
  for (const double cell : cells.numbers("cell")) count = std::max(count, static_cast<std::size_t>(cell) + 1);
  if (count > 0) outputs = std::min(outputs, cells.rows() / count);  // a killed run may lack the last rows

  std::optional<FrameReader> reader;
  std::string note;
  try {
    reader.emplace(directory / "frames.h5");
    outputs = std::min(outputs, static_cast<std::size_t>(reader->frames()));
  } catch (const Error& error) {  // the rest of the page is worth having
    reader.reset();
    note = std::string("No animation: ") + error.what();
  }

  auto aggregate_count = series.numbers("aggregate_count");
  aggregate_count.resize(outputs);
  auto selection = shown_outputs(aggregate_count, most_outputs);
  if (reader && outputs > 0) {
    const auto outlines = reader->outlines(0);
    const std::size_t nodes = outlines.x.size(), cell_count = std::max<std::size_t>(1, count);
    while (selection.size() * nodes / stride > most_points && nodes / cell_count / (stride + 1) >= fewest_nodes)
      ++stride;
    const std::size_t per_output = std::max<std::size_t>(1, nodes / stride);
    if (selection.size() * per_output > most_points)
      selection = shown_outputs(aggregate_count, std::max<std::size_t>(50, most_points / per_output));
  }

  data["shown"] = {{"outputs", selection.size()}, {"of", series.rows()}, {"node_stride", stride}};
  for (const char* name : {"step", "time_s", "strain"}) data[name] = picked(series.numbers(name), selection);
  const auto steps = series.numbers("step");
  data["step"] = json::array();
  for (const std::size_t i : selection) data["step"].push_back(std::llround(steps[i]));
  const auto stages = series.texts("stage_name");
  data["stage"] = json::array();
  for (const std::size_t i : selection) data["stage"].push_back(stages[i]);
  for (const char* name : {"aggregate_count", "aggregate_size_weight_mean", "relative_viscosity", "particle_stress_Pa",
                           "mach_max", "area_drift_max", "area_leakage_max", "mass_drift"})
    data["series"][name] = picked(series.numbers(name), selection);
  for (const auto& [name, column] : {std::pair{"cell_free_layer_lower_um", "cell_free_layer_lower_m"},
                                     std::pair{"cell_free_layer_upper_um", "cell_free_layer_upper_m"}}) {
    data["series"][name] = picked(series.numbers(column), selection, micro);
  }
  data["cells"] = count > 0 && outputs > 0 ? cell_data(cells, count, selection) : json(nullptr);
  data["outlines"] = reader && !selection.empty() ? outline_data(*reader, selection, stride) : json(nullptr);
  if (note.empty() && count > 0 && outputs > 0 && data["outlines"].is_null())
    note = "No animation: the number of membrane nodes changes during the run.";
  data["shown"]["note"] = note;
  return data;
}

}  // namespace rouleau::host
