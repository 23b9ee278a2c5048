#include "judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/text.hpp"
#include "files/tables.hpp"
#include "files/verify.hpp"

namespace rouleau::stability {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json failure_in_summary(const Json& failure) {
  const auto value = [&](const char* key) { return failure.contains(key) ? failure[key] : Json(); };
  return {
      {"reason", value("reason")}, {"step", value("step")}, {"message", value("message")}, {"remedy", value("remedy")}};
}

/// "column in row of table" of the first value that is no number where there must be one.
std::optional<std::string> find_no_number(const fs::path& file, const std::vector<std::string>& columns) {
  if (!fs::exists(file)) return std::nullopt;
  const files::StoredTable table(file);
  std::optional<std::string> found;
  std::size_t first = table.rows();
  for (const std::string& column : columns) {
    if (!table.has(column)) continue;
    const std::vector<double> values = table.numbers(column);
    const auto at = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
    const auto row = static_cast<std::size_t>(at - values.begin());
    if (row >= first) continue;
    first = row;
    found = column + " in row " + std::to_string(row + 1) + " of " + file.filename().string() + " is " +
            table.texts(column)[row];
  }
  return found;
}

/// A number of the summary; NaN where it is null or missing.
double number_at(const Json& summary, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  return summary.contains(at) && summary[at].is_number() ? summary[at].get<double>() : std::nan("");
}

int dimension_of(const Json& summary) { return summary.is_object() ? summary.value("dimensions", 2) : 2; }

/// A run may stop for a reason, but before it writes what is no number. Null when it did.
Json garbage_written(const fs::path& directory, int dimension) {
  static const std::vector<std::string> of_cells[2] = {
      {"x_m", "y_m", "deformation", "area_m2", "perimeter_m"},
      {"x_m", "y_m", "z_m", "deformation", "volume_m3", "surface_area_m2"}};
  const auto table = [&](const char* name, const std::vector<std::string>& columns) {
    return find_no_number(directory / name, columns);
  };
  std::optional<std::string> found = table("cells.csv", of_cells[dimension - 2]);
  if (!found) found = table("series.csv", {"mach_max", "mass_drift", "kinetic_energy_J_per_m"});
  if (const fs::path frames = directory / "frames.h5"; !found && fs::exists(frames))
    found = files::find_no_number_in_frames(frames);
  return found ? failure_json(no_number_written, *found) : Json();
}

/// What a run that came to its end did not report.
Json silent_failure(const Json& summary, const HealthCriteria& criteria) {
  if (!summary.is_object()) return failure_json("no_summary", "the run has left no summary.json");
  struct Bound {
    const char *reason, *pointer, *words;
    double most;
  };
  constexpr const char* changed[2] = {"a cell has changed its area by", "a cell has changed its volume by"};
  const std::array bounds{
      Bound{"area_loss", "/conservation/area_drift_max", changed[dimension_of(summary) - 2], criteria.area_drift},
      Bound{"area_loss", "/conservation/area_leakage_max", "area_correction has kept back", criteria.area_drift},
      Bound{"energy_growth", "/energy/largest_growth_at_rest_relative", "energy at rest has grown by",
            criteria.energy_growth},
      Bound{"uneven_nodes", "/stretch/max", "a segment has been stretched to", criteria.stretch},
      Bound{"mass_loss", "/conservation/mass_drift", "the fluid's mass has changed by", criteria.mass_drift}};
  for (const Bound& bound : bounds) {
    const double value = number_at(summary, bound.pointer);
    if (value > bound.most)
      return failure_json(bound.reason, std::string(bound.words) + ' ' + number(value, 3) + ", more than " +
                                            number(bound.most, 3) + ", and nothing stopped the run");
  }
  const double least = number_at(summary, "/stretch/min");
  if (least < 1 / criteria.stretch)
    return failure_json("uneven_nodes", "a segment has shrunk to " + number(least, 3) +
                                            " of its length at rest, less than " + number(1 / criteria.stretch, 3) +
                                            ", and nothing stopped the run");
  return nullptr;
}

}  // namespace

Json failure_json(const std::string& reason, const std::string& message) {
  return {{"reason", reason}, {"step", nullptr}, {"message", message}, {"remedy", nullptr}};
}

std::string failure_text(const Json& failure) {
  std::string text = failure["reason"].is_string() ? failure["reason"].get<std::string>() : "";
  if (failure["step"].is_number()) text += " at step " + failure["step"].dump();
  return text;
}

Judgement judge(const trial::TrialResult& result, const fs::path& directory, const HealthCriteria& criteria) {
  Judgement judgement;
  judgement.end = trial::to_string(result.end);
  const bool ended = result.end == trial::TrialEnd::completed || result.end == trial::TrialEnd::diverged;
  if (Json garbage = ended ? garbage_written(directory, dimension_of(result.summary)) : Json(); !garbage.is_null()) {
    judgement.failure = std::move(garbage);
  } else if (result.end == trial::TrialEnd::completed) {
    judgement.failure = silent_failure(result.summary, criteria);
  } else if (result.end == trial::TrialEnd::diverged && result.summary.is_object() &&
             result.summary.contains("failure")) {
    judgement.failure = failure_in_summary(result.summary["failure"]);
  } else {
    judgement.failure = failure_json(trial::to_string(result.end), result.message);
    if (result.summary.is_object() && result.summary.contains("steps"))
      judgement.failure["step"] = result.summary["steps"];
  }
  judgement.healthy = judgement.failure.is_null();
  return judgement;
}

}  // namespace rouleau::stability
