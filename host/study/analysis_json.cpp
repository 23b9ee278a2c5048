#include "study/analysis_json.hpp"

#include "output/summary.hpp"

namespace rouleau::host {

namespace {

using nlohmann::json;

json said(const std::string& text) { return text.empty() ? json() : json(text); }

json labels_json(const StudyData& study, const std::vector<int>& setting) {
  json labels = json::object();
  for (std::size_t i = 0; i < setting.size(); ++i)
    if (setting[i] >= 0) labels[study.axes[i].name] = study.axes[i].labels[static_cast<std::size_t>(setting[i])];
  return labels;
}

json reference_json(const ResolvedReference& reference) {
  return {{"kind", name_of(reference.kind)},
          {"value", number_or_null(reference.value)},
          {"uncertainty", number_or_null(reference.uncertainty)},
          {"order", number_or_null(reference.order)},
          {"source", said(reference.source)},
          {"points", reference.points},
          {"why_not", said(reference.why_not)}};
}

json quantity_json(const StudyData& study, const Quantity& quantity, const QuantityAnalysis& analysis) {
  json methods = json::array();
  for (const MethodLimit& method : analysis.by_method) {
    const Extrapolation& e = method.extrapolation;
    methods.push_back({{"method", labels_json(study, method.setting)},
                       {"order", number_or_null(e.order)},
                       {"limit", number_or_null(e.limit)},
                       {"uncertainty", number_or_null(e.uncertainty)},
                       {"points", method.used},
                       {"why_not", said(e.remark)}});
  }
  return {{"name", quantity.name},           {"kind", name_of(quantity.kind)},
          {"unit", quantity.unit},           {"error", quantity.error == ErrorKind::relative ? "relative" : "absolute"},
          {"target", quantity.target},       {"reference", reference_json(analysis.reference)},
          {"by_method", std::move(methods)}, {"disagreement", said(analysis.disagreement)}};
}

json knobs_json(const StudyData& study, const std::vector<Knob>& knobs) {
  json result = json::array();
  for (const Knob& knob : knobs) {
    std::vector<int> fixed = study.points[knob.from].setting;
    const auto label = [&](std::size_t point) {
      return study.axes[knob.axis].labels[static_cast<std::size_t>(study.points[point].setting[knob.axis])];
    };
    fixed[knob.axis] = -1;
    result.push_back({{"axis", study.axes[knob.axis].name},
                      {"from", label(knob.from)},
                      {"to", label(knob.to)},
                      {"fixed", labels_json(study, fixed)},
                      {"error_factor", knob.error_factor},
                      {"time_factor", knob.time_factor},
                      {"gain", number_or_null(knob.gain)},
                      {"free", std::isinf(knob.gain)}});
  }
  return result;
}

}  // namespace

void add_analysis(json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses) {
  json quantities = json::array(), fronts = json::object(), knobs = json::object(), sentences = json::array();
  for (std::size_t q = 0; q < analyses.size(); ++q) {
    const Quantity& quantity = study.quantities[q];
    quantities.push_back(quantity_json(study, quantity, analyses[q]));
    fronts[quantity.name] = analyses[q].front;
    knobs[quantity.name] = knobs_json(study, analyses[q].knobs);
    for (const StudySentence& sentence : analyses[q].sentences) {
      sentences.push_back({{"quantity", quantity.name},
                           {"text", sentence.text},
                           {"target", number_or_null(sentence.target)},
                           {"point", sentence.point ? json(*sentence.point) : json()}});
    }
    for (std::size_t i = 0; i < study.points.size(); ++i) {
      const PointError& error = analyses[q].errors[i];
      result["points"][i]["results"][quantity.name] = {{"value", number_or_null(error.value)},
                                                       {"error", number_or_null(error.error)},
                                                       {"deviation", number_or_null(error.deviation)},
                                                       {"uncertainty", number_or_null(error.uncertainty)},
                                                       {"why_not", said(error.why_not)}};
    }
  }
  result["quantities"] = std::move(quantities);
  result["fronts"] = std::move(fronts);
  result["knobs"] = std::move(knobs);
  result["sentences"] = std::move(sentences);
}

json target_json(const StudyData& study, std::size_t quantity, double target, const TargetDecision& decision) {
  return {{"quantity", study.quantities[quantity].name},
          {"value", target},
          {"met", decision.met},
          {"point", decision.point ? json(*decision.point) : json()},
          {"estimated_error", number_or_null(decision.estimated_error)},
          {"uncertainty", number_or_null(decision.uncertainty)},
          {"sentence", decision.sentence}};
}

}  // namespace rouleau::host
