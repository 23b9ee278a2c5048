#include "rheology_history.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "base/curve.hpp"
#include "json/shown.hpp"
#include "observables.hpp"

namespace rouleau::observe {

namespace {

using Json = nlohmann::json;

/// The observables whose means are wanted.
const std::vector<Observable>& averaged() {
  static const std::vector<Observable> list = [] {
    std::vector<Observable> wanted;
    for (const Observable& observable : table("series").observables)
      if (observable.has_means) wanted.push_back(observable);
    return wanted;
  }();
  return list;
}

/// First instant of the second half of a history, by time.
template <class Instants>
std::size_t second_half(const Instants& instants) {
  const double middle = instants.back().time / 2;
  std::size_t first = 0;
  while (first + 1 < instants.size() && instants[first].time < middle) ++first;
  return first;
}

/// Mean in time from `begin` on of the outputs that have a value; nothing where none has one.
std::optional<double> mean_of(const Column& time, const Column& values, double begin) {
  if (time.empty()) return std::nullopt;
  const double mean = mean_from(time, values, std::max(begin, time.front()));
  if (std::isfinite(mean)) return mean;
  return time.back() >= begin ? std::optional(values.back()) : std::nullopt;  // a single one
}

/// Whether all (or, `any`, some two) of these cells share an aggregate.
template <class Instant>
bool together(const Instant& instant, const std::vector<int>& members, bool any) {
  std::set<int> labels;
  for (const int cell : members) labels.insert(instant.label[instant.place(cell)]);
  return any ? labels.size() < members.size() : labels.size() == 1;
}

/// Of two or more cells, by label.
template <class Instant>
std::map<int, std::vector<int>> aggregates_of(const Instant& instant) {
  std::map<int, std::vector<int>> aggregates;
  for (std::size_t i = 0; i < instant.cell.size(); ++i) aggregates[instant.label[i]].push_back(instant.cell[i]);
  std::erase_if(aggregates, [](const auto& aggregate) { return aggregate.second.size() < 2; });
  return aggregates;
}

template <class Instant>
bool all_there(const Instant& instant, const std::vector<int>& cells) {
  return std::all_of(cells.begin(), cells.end(), [&](int cell) { return instant.has(cell); });
}

/// A moment between two instants, and the angles there.
struct Turned {
  double strain, time, marker, axis;
};

}  // namespace

void RheologyHistory::follow(const Snapshot& snapshot) {
  if (snapshot.stage != stage_) {
    // The end of a stage is the beginning of the next one and is not written again.
    std::vector<Instant> first;
    if (!stages_.empty()) first.push_back(stages_.back().instants.back());
    for (Instant& instant : first) {
      start_strain_ += instant.strain;
      start_time_ += instant.time;
      instant.strain = instant.time = 0;
      std::fill(instant.values.begin(), instant.values.end(), std::nan(""));
    }
    stages_.push_back({snapshot.stage_name, std::move(first)});
    stage_ = snapshot.stage;
  }
  Instant now{snapshot.strain - start_strain_, snapshot.time - start_time_, {}, {}, {}, {}, {}};
  RunKind any(snapshot.dimension, true, true, true, true);
  any.openings.fill(most_openings + 1);
  for (const Observable& observable : averaged())
    now.values.push_back(observable.is_in(any) ? std::get<double>(observable.value({.output = snapshot}))
                                               : std::nan(""));
  if (snapshot.cells.size() <= most_cells_remembered) {
    for (const CellSnapshot& cell : snapshot.cells) {
      now.cell.push_back(cell.cell);
      now.label.push_back(cell.bonded);
      now.marker.push_back(cell.tank_treading_angle);
      now.axis.push_back(cell.angle);
    }
  }
  stages_.back().instants.push_back(std::move(now));
}

Json RheologyHistory::means(const StageHistory& stage) {
  const std::size_t first = second_half(stage.instants);
  const double middle = stage.instants.back().time / 2;
  Json result{{"from_s", middle}, {"outputs", stage.instants.size() - first}};
  for (std::size_t k = 0; k < averaged().size(); ++k) {
    Column time, values, late;
    for (std::size_t i = 0; i < stage.instants.size(); ++i) {
      const Instant& instant = stage.instants[i];
      if (!std::isfinite(instant.values[k])) continue;
      time.push_back(instant.time);
      values.push_back(instant.values[k]);
      if (i >= first) late.push_back(values.back());
    }
    const std::optional<double> mean = mean_of(time, values, middle);
    if (!mean && !averaged()[k].is_in(2)) continue;    // not there in every run
    Json& of_column = result[averaged()[k].column()];  // null
    if (!mean) continue;
    const auto count = static_cast<double>(late.size());
    double squares = 0;
    for (const double value : late) squares += (value - *mean) * (value - *mean);
    of_column = {{"mean", *mean}, {"deviation", count > 1 ? Json(std::sqrt(squares / (count - 1))) : Json()}};
  }
  return result;
}

Statistics RheologyHistory::statistics(const StageHistory& stage, std::size_t column) {
  Column time, values;
  for (const Instant& instant : stage.instants) {
    time.push_back(instant.time);
    values.push_back(instant.values[column]);
  }
  return observe::statistics(time, values);
}

Json RheologyHistory::statistics(const StageHistory& stage) {
  Json result = Json::object();
  for (std::size_t k = 0; k < averaged().size(); ++k) {
    const auto has_value = [k](const Instant& instant) { return std::isfinite(instant.values[k]); };
    if (std::any_of(stage.instants.begin(), stage.instants.end(), has_value))
      result[averaged()[k].column()] = statistics(stage, k);
  }
  return result;
}

bool RheologyHistory::knows(int stage, std::string_view column, double standard_error) const {
  const auto found = std::find_if(averaged().begin(), averaged().end(),
                                  [column](const Observable& observable) { return observable.column() == column; });
  if (stage_ != stage || found == averaged().end()) return false;
  const Statistics known = statistics(stages_.back(), static_cast<std::size_t>(found - averaged().begin()));
  return known.steady() && known.standard_error <= standard_error;
}

bool RheologyHistory::parted(int stage) const {
  if (stage_ != stage) return false;
  const Instant& now = stages_.back().instants.back();
  const auto aggregates = aggregates_of(stages_.back().instants.front());
  return !aggregates.empty() && std::none_of(aggregates.begin(), aggregates.end(), [&](const auto& aggregate) {
    return all_there(now, aggregate.second) && together(now, aggregate.second, false);
  });
}

Json RheologyHistory::dissociation(const StageHistory& stage) {
  Json result = Json::array();
  for (const auto& [label, members] : aggregates_of(stage.instants.front())) {
    const auto since = [&, &cells = members](bool any) -> Json {
      std::size_t end = 1;
      while (end < stage.instants.size() && all_there(stage.instants[end], cells)) ++end;
      std::size_t i = end;
      while (i > 0 && !together(stage.instants[i - 1], cells, any)) --i;
      if (i == end) return nullptr;
      return {{"strain", stage.instants[i].strain},
              {"strain_before", stage.instants[i - 1].strain},
              {"time_s", stage.instants[i].time}};
    };
    result.push_back({{"members", members}, {"parted", since(false)}, {"separate", since(true)}});
  }
  return result;
}

Json RheologyHistory::rotation(const StageHistory& stage) {
  Json result = Json::array();
  const auto& instants = stage.instants;
  const double turn = 2 * std::numbers::pi;
  for (const int cell : instants.back().cell) {
    // A round cell has no long axis (NaN) and does not tumble.
    const auto at = [&](std::size_t i) {
      const std::size_t k = instants[i].place(cell);
      const double axis = instants[i].axis[k];
      return Turned{instants[i].strain, instants[i].time, instants[i].marker[k], std::isfinite(axis) ? axis : 0.0};
    };
    const Turned end = at(instants.size() - 1);
    std::size_t came = instants.size() - 1;  // the first instant at which it was there
    while (came > 0 && instants[came - 1].has(cell)) --came;
    const std::size_t half = std::max(came, second_half(instants));
    Turned start = at(half);
    const auto turns_since = [&](const Turned& t) { return std::floor(std::abs(end.marker - t.marker) / turn); };
    double turns = turns_since(start);
    for (std::size_t i = half; turns < 1 && i-- > came;) turns = std::min(1.0, turns_since(at(i)));
    // The last moment at which the outline was so many turns behind its end, between two outputs.
    for (std::size_t i = instants.size() - 1; turns >= 1 && i-- > came;) {
      const Turned before = at(i), after = at(i + 1);
      const double behind = std::abs(end.marker - before.marker), behind_after = std::abs(end.marker - after.marker);
      if (behind < turns * turn) continue;
      const double s = (behind - turns * turn) / (behind - behind_after);
      const auto between = [s](double a, double b) { return a + s * (b - a); };
      start = {between(before.strain, after.strain), between(before.time, after.time),
               between(before.marker, after.marker), between(before.axis, after.axis)};
      break;
    }
    const double strain = end.strain - start.strain, time = end.time - start.time;
    const double treading = end.marker - start.marker - (end.axis - start.axis), tumbling = end.axis - start.axis;
    result.push_back({{"cell", cell},
                      {"turns", turns},
                      {"strain", strain},
                      {"time_s", time},
                      {"tank_treading_rad_per_strain", json::number_or_null(treading / strain)},
                      {"tumbling_rad_per_strain", json::number_or_null(tumbling / strain)},
                      {"tank_treading_rad_per_s", json::number_or_null(treading / time)},
                      {"tumbling_rad_per_s", json::number_or_null(tumbling / time)}});
  }
  return result;
}

bool RheologyHistory::fits() const {
  const auto fitting = [](const Instant& instant) {
    const std::size_t cells = instant.cell.size();
    return instant.values.size() == averaged().size() && instant.label.size() == cells &&
           instant.marker.size() == cells && instant.axis.size() == cells;
  };
  return std::all_of(stages_.begin(), stages_.end(), [&](const StageHistory& stage) {
    return std::all_of(stage.instants.begin(), stage.instants.end(), fitting);
  });
}

Json RheologyHistory::stages() const {
  Json result = Json::array();
  for (const StageHistory& stage : stages_) {
    result.push_back({{"stage", stage.name},
                      {"means", means(stage)},
                      {"statistics", statistics(stage)},
                      {"dissociation", dissociation(stage)},
                      {"rotation", rotation(stage)}});
  }
  return result;
}

}  // namespace rouleau::observe
