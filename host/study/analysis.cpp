#include "analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/text.hpp"

namespace rouleau::study {

namespace {

constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();

double value_of(const StudyPoint& point, std::size_t quantity) {
  return quantity < point.results.size() ? point.results[quantity].value : unknown_number;
}

/// Index of the label of each axis that a reference names; -1 where it names none. Empty with the reason where a name
/// is not there.
std::vector<int> settings_named(const StudyData& study, const std::map<std::string, std::string>& labels,
                                std::string& why_not) {
  std::vector<int> setting(study.axes.size(), -1);
  for (const auto& wanted : labels) {
    const std::string &name = wanted.first, &label = wanted.second;
    const auto axis = std::find_if(study.axes.begin(), study.axes.end(), [&](const auto& a) { return a.name == name; });
    if (axis == study.axes.end()) {
      why_not = "the study has no axis " + in_quotes(name);
      return {};
    }
    const auto found = std::find(axis->labels.begin(), axis->labels.end(), label);
    if (found == axis->labels.end()) {
      why_not = "the axis " + in_quotes(name) + " has no " + in_quotes(label) + ": it has " + listed(axis->labels);
      return {};
    }
    setting[axis - study.axes.begin()] = static_cast<int>(found - axis->labels.begin());
  }
  return setting;
}

bool agrees(const std::vector<int>& setting, const std::vector<int>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] >= 0 && setting[i] >= 0 && setting[i] != wanted[i]) return false;
  return true;
}

void resolve_richardson(const StudyData& study, const Reference& asked, const std::vector<MethodLimit>& by_method,
                        ResolvedReference& result) {
  const std::vector<int> pinned = settings_named(study, asked.labels, result.why_not);
  if (!result.why_not.empty()) return;
  for (std::size_t i = 0; i < by_method.size(); ++i) {
    const Extrapolation& e = by_method[i].extrapolation;
    if (!agrees(by_method[i].setting, pinned) || !std::isfinite(e.limit)) continue;
    if (!result.method || e.uncertainty < by_method[*result.method].extrapolation.uncertainty) result.method = i;
  }
  if (!result.method) {
    const bool refines = study.line >= 0 && !study.axes[study.line].spacing.empty();
    result.why_not = refines
                         ? "no method has three grids whose values converge"
                         : "no axis along the line refines the lattice: give a reference, or an axis with \"refine\"";
    if (refines && !by_method.empty() && by_method.size() == 1) result.why_not = by_method[0].extrapolation.remark;
    return;
  }
  const MethodLimit& best = by_method[*result.method];
  result.value = best.extrapolation.limit;
  result.uncertainty = best.extrapolation.uncertainty;
  result.order = best.extrapolation.order;
  result.points = best.used;
  result.why_not = best.extrapolation.remark;
  const std::string method = name_of(study, best.setting);
  result.source = "Richardson extrapolation over " + std::to_string(best.used.size()) + " grids" +
                  (method.empty() ? "" : " of " + method);
}

void resolve_point(const StudyData& study, std::size_t quantity, const Reference& asked,
                   const std::vector<MethodLimit>& by_method, ResolvedReference& result) {
  std::vector<int> setting = settings_named(study, asked.labels, result.why_not);
  if (!result.why_not.empty()) return;
  for (std::size_t i = 0; i < setting.size(); ++i)
    if (setting[i] < 0) setting[i] = study.default_setting[i];
  const auto point = find_point(study, setting);
  result.source = "the point " + name_of(study, setting);
  if (point) result.points = {*point};
  if (!point || !std::isfinite(value_of(study.points[*point], quantity))) {
    result.why_not = result.source + " has no value";
    return;
  }
  result.value = value_of(study.points[*point], quantity);
  result.uncertainty = unknown_number;
  for (const MethodLimit& method : by_method) {
    if (!agrees(setting, method.setting) || !std::isfinite(method.extrapolation.limit)) continue;
    result.uncertainty = std::abs(result.value - method.extrapolation.limit) + method.extrapolation.uncertainty;
  }
}

PointError error_of(const Quantity& quantity, const ResolvedReference& reference, const StudyPoint& point,
                    std::size_t index) {
  if (index >= point.results.size())
    return {unknown_number, unknown_number, unknown_number, unknown_number, "it was not run"};
  const Measured& measured = point.results[index];
  PointError result{measured.value, unknown_number, unknown_number, unknown_number, measured.why_not};
  if (!std::isfinite(measured.value)) {
    if (result.why_not.empty()) result.why_not = "the run has no such value";
    return result;
  }
  if (!std::isfinite(reference.value)) {
    result.why_not = "there is no reference: " + reference.why_not;
    return result;
  }
  const double scale = quantity.error == ErrorKind::relative ? std::abs(reference.value) : 1;
  if (scale == 0) {
    result.why_not = "the reference is 0, and the error should be relative to it";
    return result;
  }
  result.deviation = (measured.value - reference.value) / scale;
  result.error = std::abs(result.deviation);
  result.uncertainty = (reference.uncertainty + measured.uncertainty) / scale;
  return result;
}

std::string limit_in_words(const StudyData& study, const MethodLimit& method, const std::string& unit) {
  return name_of(study, method.setting) + " tends to " + number(method.extrapolation.limit) + " +- " +
         number(method.extrapolation.uncertainty, 2) + (unit.empty() ? "" : " " + unit);
}

/// What the second takes over what the first takes. A clock that cannot tell them apart says nothing about their price.
double time_factor(const StudyPoint& a, const StudyPoint& b) {
  const bool repeated = a.wall_range[0] < a.wall_range[1] || b.wall_range[0] < b.wall_range[1];
  if (repeated && a.wall_range[0] <= b.wall_range[1] && b.wall_range[0] <= a.wall_range[1]) return 1;
  return b.wall_s / a.wall_s;
}

}  // namespace

double resolved_error(const PointError& error) {
  return std::isfinite(error.uncertainty) ? std::max(error.error, error.uncertainty) : error.error;
}

std::optional<std::size_t> find_point(const StudyData& study, const std::vector<int>& setting) {
  for (std::size_t i = 0; i < study.points.size(); ++i)
    if (study.points[i].setting == setting) return i;
  return std::nullopt;
}

std::vector<MethodLimit> limits_of_methods(const StudyData& study, std::size_t quantity) {
  std::vector<MethodLimit> methods;
  if (study.line < 0) return methods;
  const auto line = static_cast<std::size_t>(study.line);
  const std::vector<double>& spacing = study.axes[line].spacing;
  const auto spacing_of = [&](std::size_t point) { return spacing[study.points[point].setting[line]]; };
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    std::vector<int> setting = study.points[i].setting;
    setting[line] = -1;
    auto method = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.setting == setting; });
    if (method == methods.end()) method = methods.insert(methods.end(), MethodLimit{setting, {}, {}, {}});
    if (std::isfinite(value_of(study.points[i], quantity))) method->points.push_back(i);
  }
  for (MethodLimit& method : methods) {
    if (spacing.empty()) {
      method.extrapolation = extrapolate({});
      method.extrapolation.remark = "the axis " + in_quotes(study.axes[line].name) + " does not refine the lattice";
      continue;
    }
    std::stable_sort(method.points.begin(), method.points.end(),
                     [&](std::size_t a, std::size_t b) { return spacing_of(a) < spacing_of(b); });
    std::vector<GridValue> grids;
    for (const std::size_t point : method.points) {
      const Measured& measured = study.points[point].results[quantity];
      grids.push_back({spacing_of(point), measured.value, measured.uncertainty});
    }
    method.extrapolation = extrapolate(grids);
    for (const std::size_t used : method.extrapolation.used) method.used.push_back(method.points[used]);
  }
  return methods;
}

std::vector<std::pair<std::size_t, std::size_t>> disagreements(const std::vector<MethodLimit>& by_method) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < by_method.size(); ++i) {
    for (std::size_t j = i + 1; j < by_method.size(); ++j) {
      const Extrapolation &a = by_method[i].extrapolation, &b = by_method[j].extrapolation;
      const double round_off = 1e-12 * (std::abs(a.limit) + std::abs(b.limit));
      if (std::abs(a.limit - b.limit) > a.uncertainty + b.uncertainty + round_off) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

ResolvedReference resolve_reference(const StudyData& study, std::size_t quantity,
                                    const std::vector<MethodLimit>& by_method) {
  const Reference& asked = study.quantities[quantity].reference;
  ResolvedReference result{asked.kind, unknown_number, unknown_number, unknown_number, "", {}, {}, ""};
  if (asked.kind == ReferenceKind::richardson) {
    resolve_richardson(study, asked, by_method, result);
  } else if (asked.kind == ReferenceKind::point) {
    resolve_point(study, quantity, asked, by_method, result);
  } else {
    result.value = asked.value;
    result.uncertainty = asked.uncertainty;
    result.source = asked.source;
  }
  return result;
}

QuantityAnalysis analyse(const StudyData& study, std::size_t quantity) {
  QuantityAnalysis result;
  result.by_method = limits_of_methods(study, quantity);
  result.reference = resolve_reference(study, quantity, result.by_method);
  const Quantity& measured = study.quantities[quantity];
  std::vector<double> time, error;
  for (const StudyPoint& point : study.points) {
    result.errors.push_back(error_of(measured, result.reference, point, quantity));
    time.push_back(point.wall_s);
    error.push_back(resolved_error(result.errors.back()));
  }
  result.front = pareto_front(time, error);
  result.sensitivities = sensitivities_of(study, result.errors);
  double widest = 0;
  for (const auto& [i, j] : disagreements(result.by_method)) {
    const MethodLimit &a = result.by_method[i], &b = result.by_method[j];
    const double apart = std::abs(a.extrapolation.limit - b.extrapolation.limit);
    if (apart <= widest) continue;
    widest = apart;
    result.disagreement = "The methods disagree about " + measured.name + ": " +
                          limit_in_words(study, a, measured.unit) + ", " + limit_in_words(study, b, measured.unit) +
                          ", further apart than their uncertainties together.";
  }
  result.sentences = sentences_of(study, quantity, result);
  return result;
}

std::vector<QuantityAnalysis> analyse(const StudyData& study) {
  std::vector<QuantityAnalysis> result;
  for (std::size_t i = 0; i < study.quantities.size(); ++i) result.push_back(analyse(study, i));
  return result;
}

std::vector<std::size_t> pareto_front(const std::vector<double>& time, const std::vector<double>& error) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (std::isfinite(time[i]) && std::isfinite(error[i])) candidates.push_back(i);
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return time[a] != time[b] ? time[a] < time[b] : error[a] < error[b];
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : candidates)
    if (front.empty() || error[i] < error[front.back()]) front.push_back(i);
  return front;
}

std::vector<Sensitivity> sensitivities_of(const StudyData& study, const std::vector<PointError>& errors) {
  std::vector<Sensitivity> sensitivities;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    for (std::size_t i = 0; i < study.points.size(); ++i) {
      const auto label = static_cast<std::size_t>(study.points[i].setting[axis]);
      const std::size_t last = study.axes[axis].ordered ? std::min(label + 2, study.axes[axis].labels.size())
                                                        : study.axes[axis].labels.size();
      for (std::size_t other = label + 1; other < last; ++other) {
        std::vector<int> setting = study.points[i].setting;
        setting[axis] = static_cast<int>(other);
        const auto j = find_point(study, setting);
        if (!j) continue;
        Sensitivity sensitivity{axis,
                                i,
                                *j,
                                resolved_error(errors[i]) / resolved_error(errors[*j]),
                                time_factor(study.points[i], study.points[*j]),
                                0};
        if (sensitivity.error_factor < 1) {
          std::swap(sensitivity.from, sensitivity.to);
          sensitivity.error_factor = 1 / sensitivity.error_factor;
          sensitivity.time_factor = 1 / sensitivity.time_factor;
        }
        if (!std::isfinite(sensitivity.error_factor) || !std::isfinite(sensitivity.time_factor)) continue;
        const bool free = sensitivity.time_factor <= 1 && sensitivity.error_factor > 1;
        sensitivity.gain = free ? std::numeric_limits<double>::infinity()
                                : (sensitivity.error_factor == 1
                                       ? 0
                                       : std::log(sensitivity.error_factor) / std::log(sensitivity.time_factor));
        sensitivities.push_back(sensitivity);
      }
    }
  }
  std::stable_sort(sensitivities.begin(), sensitivities.end(), [](const Sensitivity& a, const Sensitivity& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.error_factor > b.error_factor;
  });
  return sensitivities;
}

}  // namespace rouleau::study
