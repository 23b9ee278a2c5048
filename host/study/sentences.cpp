#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis.hpp"
#include "base/text.hpp"

namespace rouleau::study {

namespace {

constexpr double of_no_target = std::numeric_limits<double>::quiet_NaN();

/// "the error of deformation", "the velocity error"
std::string the_error(const Quantity& quantity) {
  return (quantity.name.ends_with("error") ? "the " : "the error of ") + quantity.name;
}

/// "it runs 5.6 s, with an error of 0.89 % +- 0.1 %"
std::string described(const StudyData& study, const Quantity& quantity, const PointError& error, std::size_t point) {
  return "it runs " + time_in_words(study.points[point].wall_s) + ", with an error of " +
         error_in_words(quantity, error.error) +
         (std::isfinite(error.uncertainty) && error.uncertainty > 0
              ? " +- " + error_in_words(quantity, error.uncertainty)
              : "");
}

/// " The default runs 16 s, 2.9 times longer, with an error of 2 %."
std::string against_default(const StudyData& study, const Quantity& quantity, const std::vector<PointError>& errors,
                            std::size_t chosen) {
  const auto standard = find_point(study, study.default_setting);
  if (!standard) return "";
  if (*standard == chosen) return " This is the default.";
  const double ratio = study.points[*standard].wall_s / study.points[chosen].wall_s;
  const PointError& error = errors[*standard];
  if (!std::isfinite(ratio) || !std::isfinite(error.error)) return " The default setting gave no result.";
  const double times = std::max(ratio, 1 / ratio);
  const std::string compared =
      times < 1.05 ? "as long" : rounded(times, 2) + " times " + (ratio >= 1 ? "longer" : "shorter");
  return " The default runs " + time_in_words(study.points[*standard].wall_s) + ", " + compared +
         ", with an error of " + error_in_words(quantity, error.error) + ".";
}

StudySentence cheapest_below(const StudyData& study, const Quantity& quantity, const QuantityAnalysis& analysis) {
  const std::string target = error_in_words(quantity, quantity.target);
  std::optional<std::size_t> chosen, nearest;
  const auto bound = [&](std::size_t i) {
    const PointError& e = analysis.errors[i];
    return e.error + (std::isfinite(e.uncertainty) ? e.uncertainty : 0);
  };
  /// Errors that grow again on finer grids of the line were small by chance.
  const auto borne_out = [&](std::size_t i) {
    for (const MethodLimit& method : analysis.by_method) {
      const auto here = std::find(method.points.begin(), method.points.end(), i);
      if (here == method.points.end()) continue;
      return std::all_of(method.points.begin(), here, [&](std::size_t j) { return bound(j) <= quantity.target; });
    }
    return true;
  };
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    if (!std::isfinite(bound(i)) || !std::isfinite(study.points[i].wall_s)) continue;
    if (!nearest || bound(i) < bound(*nearest)) nearest = i;
    const bool cheaper = !chosen || study.points[i].wall_s < study.points[*chosen].wall_s;
    if (bound(i) <= quantity.target && cheaper && borne_out(i)) chosen = i;
  }
  const auto setting = [&](std::size_t i) {
    return name_of(study, study.points[i].setting) + ": " + described(study, quantity, analysis.errors[i], i) + ".";
  };
  if (chosen) {
    return {"To keep " + the_error(quantity) + " below " + target + ", take " + setting(*chosen) +
                against_default(study, quantity, analysis.errors, *chosen),
            quantity.target, chosen};
  }
  if (!nearest) {
    const std::string why = analysis.reference.why_not.empty() ? "no run has a value" : analysis.reference.why_not;
    return {"Nothing is known about " + the_error(quantity) + ": " + why + ".", quantity.target, std::nullopt};
  }
  return {"No setting is sure to keep " + the_error(quantity) + " below " + target + ". The nearest is " +
              setting(*nearest),
          quantity.target, nearest};
}

StudySentence largest_sensitivity(const StudyData& study, const Quantity& quantity, const Sensitivity& sensitivity) {
  std::vector<int> rest = study.points[sensitivity.to].setting;
  rest[sensitivity.axis] = -1;
  const StudyAxis& axis = study.axes[sensitivity.axis];
  const auto label = [&](std::size_t point) { return axis.labels[study.points[point].setting[sensitivity.axis]]; };
  const std::string elsewhere = name_of(study, rest);
  const double longer = sensitivity.time_factor, times = std::max(longer, 1 / longer);
  const std::string time = times < 1.05
                               ? " in the same time"
                               : " and the run " + rounded(times, 2) + " times " + (longer > 1 ? "longer" : "shorter");
  return {"What helps most: " + axis.name + " " + label(sensitivity.to) + " instead of " + label(sensitivity.from) +
              (elsewhere.empty() ? "" : ", at " + elsewhere + ",") + " makes " + the_error(quantity) + " " +
              rounded(sensitivity.error_factor, 2) + " times smaller" + time + ".",
          of_no_target, sensitivity.to};
}

}  // namespace

std::vector<StudySentence> sentences_of(const StudyData& study, std::size_t quantity,
                                        const QuantityAnalysis& analysis) {
  std::vector<StudySentence> sentences{cheapest_below(study, study.quantities[quantity], analysis)};
  // A change of the error by less than this is lost in the noise of the clock.
  constexpr double worth_a_sentence = 1.2;
  const auto best =
      std::find_if(analysis.sensitivities.begin(), analysis.sensitivities.end(),
                   [](const Sensitivity& sensitivity) { return sensitivity.error_factor >= worth_a_sentence; });
  if (best != analysis.sensitivities.end())
    sentences.push_back(largest_sensitivity(study, study.quantities[quantity], *best));
  if (!analysis.disagreement.empty()) sentences.push_back({analysis.disagreement, of_no_target, std::nullopt});
  return sentences;
}

std::string name_of(const StudyData& study, const std::vector<int>& setting) {
  std::string name;
  for (std::size_t i = 0; i < setting.size(); ++i) {
    if (setting[i] < 0) continue;
    name += (name.empty() ? "" : ", ") + study.axes[i].name + " " + study.axes[i].labels[setting[i]];
  }
  return name;
}

std::string error_in_words(const Quantity& quantity, double error) {
  if (quantity.error == ErrorKind::relative) return rounded(100 * error, 2) + " %";
  return rounded(error, 2) + (quantity.unit.empty() ? "" : " " + quantity.unit);
}

}  // namespace rouleau::study
