#include "analysis_json.hpp"

#include "json/number_or_null.hpp"
#include "run/summary.hpp"

namespace rouleau::study {

namespace {

using Json = nlohmann::json;

Json said(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json labels_json(const StudyData& study, const std::vector<int>& setting) {
  Json labels = Json::object();
  for (std::size_t i = 0; i < setting.size(); ++i)
    if (setting[i] >= 0) labels[study.axes[i].name] = study.axes[i].labels[setting[i]];
  return labels;
}

Json reference_json(const ResolvedReference& reference) {
  return {{"kind", name_of(reference.kind)},
          {"value", json::number_or_null(reference.value)},
          {"uncertainty", json::number_or_null(reference.uncertainty)},
          {"order", json::number_or_null(reference.order)},
          {"source", said(reference.source)},
          {"points", reference.points},
          {"why_not", said(reference.why_not)}};
}

Json quantity_json(const StudyData& study, const Quantity& quantity, const QuantityAnalysis& analysis) {
  Json methods = Json::array();
  for (const MethodLimit& method : analysis.by_method) {
    const Extrapolation& e = method.extrapolation;
    methods.push_back({{"method", labels_json(study, method.setting)},
                       {"order", json::number_or_null(e.order)},
                       {"limit", json::number_or_null(e.limit)},
                       {"uncertainty", json::number_or_null(e.uncertainty)},
                       {"points", method.used},
                       {"why_not", said(e.remark)}});
  }
  return {{"name", quantity.name},           {"kind", name_of(quantity.kind)},
          {"unit", quantity.unit},           {"error", quantity.error == ErrorKind::relative ? "relative" : "absolute"},
          {"target", quantity.target},       {"reference", reference_json(analysis.reference)},
          {"by_method", std::move(methods)}, {"disagreement", said(analysis.disagreement)}};
}

Json sensitivities_json(const StudyData& study, const std::vector<Sensitivity>& sensitivities) {
  Json result = Json::array();
  for (const Sensitivity& sensitivity : sensitivities) {
    std::vector<int> fixed = study.points[sensitivity.from].setting;
    const auto label = [&](std::size_t point) {
      return study.axes[sensitivity.axis].labels[study.points[point].setting[sensitivity.axis]];
    };
    fixed[sensitivity.axis] = -1;
    result.push_back({{"axis", study.axes[sensitivity.axis].name},
                      {"from", label(sensitivity.from)},
                      {"to", label(sensitivity.to)},
                      {"fixed", labels_json(study, fixed)},
                      {"error_factor", sensitivity.error_factor},
                      {"time_factor", sensitivity.time_factor},
                      {"gain", json::number_or_null(sensitivity.gain)},
                      {"free", std::isinf(sensitivity.gain)}});
  }
  return result;
}

}  // namespace

void add_analysis(Json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses) {
  Json quantities = Json::array(), fronts = Json::object(), sensitivities = Json::object(), sentences = Json::array();
  for (std::size_t q = 0; q < analyses.size(); ++q) {
    const Quantity& quantity = study.quantities[q];
    quantities.push_back(quantity_json(study, quantity, analyses[q]));
    fronts[quantity.name] = analyses[q].front;
    sensitivities[quantity.name] = sensitivities_json(study, analyses[q].sensitivities);
    for (const StudySentence& sentence : analyses[q].sentences) {
      sentences.push_back({{"quantity", quantity.name},
                           {"text", sentence.text},
                           {"target", json::number_or_null(sentence.target)},
                           {"point", sentence.point ? Json(*sentence.point) : Json()}});
    }
    for (std::size_t i = 0; i < study.points.size(); ++i) {
      const PointError& error = analyses[q].errors[i];
      result["points"][i]["results"][quantity.name] = {{"value", json::number_or_null(error.value)},
                                                       {"error", json::number_or_null(error.error)},
                                                       {"deviation", json::number_or_null(error.deviation)},
                                                       {"uncertainty", json::number_or_null(error.uncertainty)},
                                                       {"why_not", said(error.why_not)}};
    }
  }
  result["quantities"] = std::move(quantities);
  result["fronts"] = std::move(fronts);
  result["knobs"] = std::move(sensitivities);
  result["sentences"] = std::move(sentences);
}

}  // namespace rouleau::study
