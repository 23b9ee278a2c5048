#include "target.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.hpp"

namespace rouleau::study {

namespace {

/// Another run is worth while to show a setting this many times cheaper than the one shown, if it takes no longer than
/// this many times all runs before.
constexpr double worth_showing = 1.5, price_of_showing = 3;

/// Points on a point's line: all other settings equal; finest first. Empty where no axis refines.
std::vector<std::size_t> line_through(const StudyData& study, std::size_t point) {
  std::vector<std::size_t> result;
  if (study.line < 0) return result;
  const auto line = static_cast<std::size_t>(study.line);
  const std::vector<double>& spacing = study.axes[line].spacing;
  if (spacing.empty()) return result;
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    std::vector<int> setting = study.points[i].setting;
    setting[line] = study.points[point].setting[line];
    if (setting == study.points[point].setting) result.push_back(i);
  }
  std::stable_sort(result.begin(), result.end(), [&](std::size_t a, std::size_t b) {
    return spacing[study.points[a].setting[line]] < spacing[study.points[b].setting[line]];
  });
  return result;
}

double spacing_at(const StudyData& study, std::size_t point) {
  const auto line = static_cast<std::size_t>(study.line);
  return study.axes[line].spacing[study.points[point].setting[line]];
}

const MethodLimit* method_of(const StudyData& study, const QuantityAnalysis& analysis, std::size_t point) {
  for (const MethodLimit& method : analysis.by_method) {
    bool same = true;
    for (std::size_t i = 0; i < method.setting.size(); ++i)
      same = same && (method.setting[i] < 0 || method.setting[i] == study.points[point].setting[i]);
    if (same) return &method;
  }
  return nullptr;
}

bool has_value(const QuantityAnalysis& analysis, std::size_t point) {
  return std::isfinite(analysis.errors[point].error);
}

/// An error that the C h^p of its line, the reference and the limits of methods that disagree with it allow.
struct TargetEstimate {
  double error, uncertainty;
};

TargetEstimate estimate_of(const StudyData& study, std::size_t quantity, const QuantityAnalysis& analysis,
                           std::size_t point) {
  const PointError& measured = analysis.errors[point];
  const bool relative = study.quantities[quantity].error == ErrorKind::relative;
  const double scale = relative ? std::abs(analysis.reference.value) : 1;
  TargetEstimate result{measured.error, measured.uncertainty};
  const MethodLimit* method = method_of(study, analysis, point);
  // Beside a reference that was given, only a line that converges well tells more than the distance from it.
  const bool telling = analysis.reference.kind == ReferenceKind::richardson ||
                       (method != nullptr && method->extrapolation.convergence == Convergence::asymptotic);
  if (telling && method != nullptr && std::isfinite(method->extrapolation.limit))
    result.error = std::max(result.error, method->extrapolation.error_at(spacing_at(study, point)) / scale);
  const Reference& asked = study.quantities[quantity].reference;
  if (asked.kind != ReferenceKind::richardson || !asked.labels.empty() || !analysis.reference.method) return result;
  for (const auto& [i, j] : disagreements(analysis.by_method)) {
    if (i != *analysis.reference.method && j != *analysis.reference.method) continue;
    const std::size_t other = i == *analysis.reference.method ? j : i;
    const Extrapolation& limit = analysis.by_method[other].extrapolation;
    const double error = std::abs(measured.value - limit.limit) / scale, uncertainty = limit.uncertainty / scale;
    if (error + uncertainty > result.error + result.uncertainty) result = {error, uncertainty};
  }
  return result;
}

/// Whether a small distance from a reference that was given may be one that crosses zero between two grids.
std::string why_maybe_a_crossing(const StudyData& study, const QuantityAnalysis& analysis, std::size_t point) {
  const std::vector<std::size_t> line = line_through(study, point);
  const auto here = std::find(line.begin(), line.end(), point);
  if (here == line.end() || line.size() < 2) return "";
  // A finer grid that meets the target was looked at before.
  for (auto finer = line.begin(); finer != here; ++finer)
    if (has_value(analysis, *finer)) return "";
  for (auto coarser = here + 1; coarser != line.end(); ++coarser) {
    if (!has_value(analysis, *coarser)) continue;
    const double now = analysis.errors[point].deviation, before = analysis.errors[*coarser].deviation;
    // Exact on both grids, or coming nearer from one side, and no faster than a scheme does.
    constexpr double fastest_order = 4;
    const double ratio = spacing_at(study, point) / spacing_at(study, *coarser);
    const double least = std::abs(before) * std::pow(ratio, fastest_order);
    if (before * now >= 0 && std::abs(now) <= std::abs(before) && std::abs(now) >= least) return "";
    break;
  }
  return "its error may cross zero there by chance: a finer grid must tell";
}

/// Untried grid of a point's line that is finer than all that have a value: the coarsest of them.
std::optional<std::size_t> next_finer(const StudyData& study, const QuantityAnalysis& analysis, std::size_t point) {
  std::optional<std::size_t> result;
  for (const std::size_t i : line_through(study, point)) {
    if (has_value(analysis, i) || std::isfinite(analysis.errors[i].value)) break;
    if (!study.points[i].tried) result = i;
  }
  return result;
}

/// Whether a method with two grids comes nearer to the reference from one to the other as one that tends to it does.
/// True as well where it has another number of grids: then nobody can tell, or its limit tells more.
bool seems_to_agree(const StudyData& study, std::size_t quantity, const QuantityAnalysis& analysis,
                    const MethodLimit& method) {
  if (method.points.size() != 2 || !std::isfinite(analysis.reference.uncertainty)) return true;
  const std::size_t fine = method.points[0], coarse = method.points[1];
  const auto distance = [&](std::size_t point) {
    return std::abs(study.points[point].results[quantity].value - analysis.reference.value);
  };
  constexpr double slowest_order = 0.5;
  const double ratio = spacing_at(study, fine) / spacing_at(study, coarse);
  return distance(fine) <= std::pow(ratio, slowest_order) * distance(coarse) + analysis.reference.uncertainty;
}

struct Search {
  const StudyData& study;
  std::size_t quantity;
  double target, budget_s;
  QuantityAnalysis analysis;
  std::vector<double> cost;
  std::vector<TargetBound> bounds;

  [[nodiscard]] bool affordable(std::size_t point) const { return !(cost[point] > budget_s); }
  /// Cheaper first; what nobody knows the cost of comes last, in the order of the points.
  [[nodiscard]] bool cheaper(std::size_t a, std::size_t b) const {
    if (std::isnan(cost[a]) || std::isnan(cost[b])) return !std::isnan(cost[a]) && std::isnan(cost[b]);
    return cost[a] < cost[b];
  }
  template <class Wanted>
  [[nodiscard]] std::optional<std::size_t> cheapest(Wanted&& wanted) const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < study.points.size(); ++i)
      if (wanted(i) && (!best || cheaper(i, *best))) best = i;
    return best;
  }
  /// What one run of each point so far has taken, s.
  [[nodiscard]] double spent() const {
    double sum = 0;
    for (const StudyPoint& point : study.points)
      if (std::isfinite(point.wall_s)) sum += point.wall_s;
    return sum;
  }
  [[nodiscard]] bool untried(std::size_t point) const { return !study.points[point].tried && affordable(point); }

  /// Whether the line of an untried point says already that it will miss the target.
  [[nodiscard]] bool will_miss(std::size_t point) const {
    const MethodLimit* method = method_of(study, analysis, point);
    if (method == nullptr || method->extrapolation.convergence != Convergence::asymptotic) return false;
    const bool relative = study.quantities[quantity].error == ErrorKind::relative;
    const double scale = relative ? std::abs(analysis.reference.value) : 1;
    return method->extrapolation.error_at(spacing_at(study, point)) / scale > target;
  }

  /// A third grid of a method that may tend to another limit than the reference, where it is no dearer than all that
  /// has been run: a disagreement should be found before a target is said to be met.
  [[nodiscard]] std::optional<std::size_t> to_contradict() const {
    const Reference& asked = study.quantities[quantity].reference;
    if (asked.kind != ReferenceKind::richardson || !asked.labels.empty()) return std::nullopt;
    return cheapest([&](std::size_t i) {
      const MethodLimit* method = method_of(study, analysis, i);
      return untried(i) && cost[i] <= spent() && method != nullptr &&
             !seems_to_agree(study, quantity, analysis, *method);
    });
  }

  /// The run that does most to show a point that seems good enough: a finer grid of its own line where the line has
  /// none, else the cheaper one of a finer grid of its line and of the line that the reference comes from; where these
  /// have no more, any.
  [[nodiscard]] std::optional<std::size_t> to_show(std::size_t point) const {
    const auto own = next_finer(study, analysis, point);
    bool own_finer = false;
    for (const std::size_t i : line_through(study, point)) {
      if (i == point) break;
      own_finer = own_finer || has_value(analysis, i);
    }
    if (own && affordable(*own) && !own_finer) return own;
    std::vector<std::size_t> finer;
    if (own && affordable(*own)) finer.push_back(*own);
    if (analysis.reference.method) {
      const auto reference = next_finer(study, analysis, analysis.reference.points.front());
      if (reference && affordable(*reference)) finer.push_back(*reference);
    }
    if (!finer.empty())
      return *std::min_element(finer.begin(), finer.end(), [&](auto a, auto b) { return cheaper(a, b); });
    return cheapest([&](std::size_t i) { return untried(i); });
  }
};

TargetDecision ended(const Search& search, std::optional<std::size_t> point, bool met) {
  TargetDecision result;
  result.met = met;
  result.point = point;
  const Quantity& quantity = search.study.quantities[search.quantity];
  const std::string goal = quantity.name + " to " + error_in_words(quantity, search.target);
  if (!point) {
    const std::string why =
        search.analysis.reference.why_not.empty() ? "no run has a value" : search.analysis.reference.why_not;
    result.sentence = "Whether a setting gives " + goal + " is not known: " + why + ".";
    return result;
  }
  const TargetBound& bound = search.bounds[*point];
  result.estimated_error = bound.estimate;
  result.uncertainty = bound.uncertainty;
  const std::string name = name_of(search.study, search.study.points[*point].setting);
  const std::string numbers = "it runs " + time_in_words(search.study.points[*point].wall_s) +
                              ", with an estimated error of " + error_in_words(quantity, bound.estimate) + " +- " +
                              error_in_words(quantity, bound.uncertainty);
  if (met) {
    result.sentence = "For " + goal + ", take " + name + ": " + numbers + ".";
    const auto standard = find_point(search.study, search.study.default_setting);
    const double ratio = standard ? search.cost[*standard] / search.cost[*point] : 0;
    if (standard && *standard == *point) result.sentence += " This is the default.";
    if (std::isfinite(ratio) && ratio > 1.05)
      result.sentence += " It is " + rounded(ratio, 2) + " times faster than the default.";
    return result;
  }
  result.sentence = "No setting is sure to give " + goal + ". The nearest is " + name + ": " + numbers + ".";
  if (!search.analysis.disagreement.empty())
    result.sentence +=
        " " + search.analysis.disagreement + " Name the right one: \"reference\": {\"richardson\": {...}}.";
  else if (!bound.why_not.empty())
    result.sentence += " It is not sure because " + bound.why_not + ".";
  const bool left =
      std::any_of(search.study.points.begin(), search.study.points.end(), [](const auto& p) { return !p.tried; });
  result.sentence +=
      left ? " What is left to run takes longer than the budget." : " A finer grid than the study has might show it.";
  return result;
}

}  // namespace

double cost_of(const StudyData& study, std::size_t point) {
  if (std::isfinite(study.points[point].wall_s)) return study.points[point].wall_s;
  std::vector<double> ratios;
  const auto collect = [&](const std::vector<std::size_t>& among) {
    for (const std::size_t i : among) {
      const double ratio = study.points[i].wall_s / study.points[i].estimated_s;
      if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
    }
  };
  collect(line_through(study, point));
  if (ratios.empty()) {
    std::vector<std::size_t> all(study.points.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    collect(all);
  }
  if (ratios.empty()) return study.points[point].estimated_s;
  std::sort(ratios.begin(), ratios.end());
  return study.points[point].estimated_s * ratios[ratios.size() / 2];
}

TargetBound bound_of(const StudyData& study, std::size_t quantity, const QuantityAnalysis& analysis, std::size_t point,
                     double target) {
  TargetBound result;
  if (!has_value(analysis, point)) {
    result.why_not = analysis.errors[point].why_not;
    return result;
  }
  const TargetEstimate own = estimate_of(study, quantity, analysis, point);
  result.estimate = own.error;
  result.uncertainty = own.uncertainty;
  if (!std::isfinite(own.uncertainty)) {
    result.why_not = "the uncertainty of the reference is not known";
    return result;
  }
  const std::vector<std::size_t> line = line_through(study, point);
  bool finer = false;
  for (const std::size_t i : line) {
    if (i == point) break;
    if (!has_value(analysis, i)) continue;
    finer = true;
    const double error = estimate_of(study, quantity, analysis, i).error;
    if (error > target) {
      result.why_not = "the finer grid " + name_of(study, study.points[i].setting) + " is further away (" +
                       error_in_words(study.quantities[quantity], error) + ")";
      return result;
    }
  }
  const bool is_its_own_error = analysis.reference.kind == ReferenceKind::analytic;  // a size, which crosses nothing
  if (analysis.reference.kind != ReferenceKind::richardson && !is_its_own_error) {
    result.why_not = why_maybe_a_crossing(study, analysis, point);
  } else if (!is_its_own_error && !line.empty() && !finer) {
    result.why_not = "no finer grid of it has been run";
  }
  return result;
}

TargetDecision decide_target(const StudyData& study, std::size_t quantity, double target, double budget_s) {
  Search search{study, quantity, target, budget_s, analyse(study, quantity), {}, {}};
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    search.cost.push_back(cost_of(study, i));
    search.bounds.push_back(bound_of(study, quantity, search.analysis, i, target));
  }
  const auto shown = [&](std::size_t i) {
    return search.bounds[i].why_not.empty() && search.bounds[i].bound() <= target;
  };
  const auto run = [](std::size_t point) {
    TargetDecision decision;
    decision.next = point;
    return decision;
  };
  const ResolvedReference& reference = search.analysis.reference;
  if (reference.kind == ReferenceKind::point && !reference.points.empty() && search.untried(reference.points.front()))
    return run(reference.points.front());  // nothing can be said without it
  if (const auto best = search.cheapest(shown)) {
    const auto cheaper = search.cheapest(
        [&](std::size_t i) { return search.untried(i) && search.cheaper(i, *best) && !search.will_miss(i); });
    if (cheaper) return run(*cheaper);
    // A setting that seems good enough and is much cheaper may be shown by one more run, if that is no great expense.
    const auto hopeful = search.cheapest([&](std::size_t i) {
      return search.bounds[i].estimate <= target && search.cost[*best] > worth_showing * search.cost[i];
    });
    if (const auto next = hopeful ? search.to_show(*hopeful) : std::nullopt;
        next && search.cost[*next] <= price_of_showing * search.spent())
      return run(*next);
    const auto contradicting = search.to_contradict();
    return contradicting ? run(*contradicting) : ended(search, best, true);
  }
  const auto promising = search.cheapest([&](std::size_t i) { return search.bounds[i].estimate <= target; });
  if (const auto next =
          promising ? search.to_show(*promising) : search.cheapest([&](std::size_t i) { return search.untried(i); }))
    return run(*next);
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    if (std::isfinite(search.bounds[i].bound()) &&
        (!nearest || search.bounds[i].bound() < search.bounds[*nearest].bound()))
      nearest = i;
  }
  return ended(search, nearest, false);
}

}  // namespace rouleau::study
