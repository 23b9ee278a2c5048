// References, errors, fronts, sensitivities and sentences of studies whose answers are known.
#include "study/analysis.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "made_up_study.hpp"
#include "study/analysis_json.hpp"

using namespace rouleau::study;
using namespace rouleau::test;

namespace {

/// 2 + first-order error of the plain scheme, second-order error of the corrected one.
MadeUpStudy two_schemes() {
  MadeUpStudy study;
  study.value = [](double a, int scheme) { return scheme == 0 ? 2 + 0.8 / a : 2 - 4 / (a * a); };
  study.time = [](double a, int scheme) { return std::pow(a / 10, 4) * (scheme == 0 ? 1 : 1.1); };
  return study;
}

bool dominated(const std::vector<double>& time, const std::vector<double>& error, std::size_t i) {
  for (std::size_t j = 0; j < time.size(); ++j) {
    if (!std::isfinite(time[j]) || !std::isfinite(error[j])) continue;
    const bool as_good = time[j] <= time[i] && error[j] <= error[i];
    const bool better = time[j] < time[i] || error[j] < error[i];
    if (as_good && (better || j < i)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("without a reference the surest limit of the methods is taken, and both methods are told", "[analysis]") {
  const QuantityAnalysis a = analyse(two_schemes().data(), 0);
  REQUIRE(a.by_method.size() == 2);
  CHECK(a.by_method[0].extrapolation.order == Approx(1));
  CHECK(a.by_method[1].extrapolation.order == Approx(2));
  REQUIRE(a.reference.method.has_value());
  CHECK(*a.reference.method == 1);
  CHECK(a.reference.value == Approx(2));
  CHECK(a.reference.source == "Richardson extrapolation over 4 grids of scheme corrected");
  CHECK(a.reference.points == std::vector<std::size_t>{9, 7, 5, 3});
  CHECK(a.disagreement.empty());
  CHECK(a.errors[4].error == Approx(0.02));  // plain at 20
  CHECK(a.errors[4].deviation == Approx(0.02));
  CHECK(a.errors[5].deviation == Approx(-0.005));  // corrected at 20
  CHECK(a.errors[5].uncertainty == Approx(a.reference.uncertainty / 2));
}

TEST_CASE("methods whose limits lie further apart than their uncertainties are said to disagree", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.value = [](double a, int scheme) { return scheme == 0 ? 2.1 + 0.8 / (a * a) : 2 - 4 / (a * a); };
  const QuantityAnalysis a = analyse(study.data(), 0);
  CHECK(disagreements(a.by_method).size() == 1);
  CHECK(a.disagreement.find("The methods disagree about deformation: scheme plain tends to 2.1 +- ") == 0);
  CHECK(a.disagreement.find("scheme corrected tends to 2 +- ") != std::string::npos);
  // A study may say whose limit it is.
  study.reference.labels = {{"scheme", "corrected"}};
  CHECK(analyse(study.data(), 0).reference.value == Approx(2));
  study.reference.labels = {{"scheme", "plain"}};
  CHECK(analyse(study.data(), 0).reference.value == Approx(2.1));
  study.reference.labels = {{"scheme", "plane"}};
  const ResolvedReference wrong = analyse(study.data(), 0).reference;
  CHECK(std::isnan(wrong.value));
  CHECK(wrong.why_not == "the axis \"scheme\" has no \"plane\": it has plain, corrected");
}

TEST_CASE("a reference that is given is used, with its uncertainty", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference = {ReferenceKind::value, 1.99, 0.01, "a book", {}};
  const QuantityAnalysis a = analyse(study.data(), 0);
  CHECK(a.errors[5].error == Approx(0.0).margin(1e-12));
  CHECK(a.errors[5].uncertainty == Approx(0.01 / 1.99));
  CHECK(resolved_error(a.errors[5]) == Approx(0.01 / 1.99));
}

TEST_CASE("another point as reference is as uncertain as its distance from its own line's limit", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference.kind = ReferenceKind::point;
  study.reference.labels = {{"resolution", "40"}, {"scheme", "corrected"}};
  const QuantityAnalysis a = analyse(study.data(), 0);
  CHECK(a.reference.value == Approx(2 - 0.0025));
  CHECK(a.reference.uncertainty == Approx(0.0025 + a.by_method[1].extrapolation.uncertainty));
  CHECK(a.reference.points == std::vector<std::size_t>{9});
  study.reference.labels = {{"scheme", "corrected"}};  // the rest is the default's
  CHECK(analyse(study.data(), 0).reference.value == Approx(2 - 0.01));
}

TEST_CASE("points without a value have no error but a reason, and the rest is judged without them", "[analysis]") {
  MadeUpStudy study = two_schemes();
  const auto all = study.value;
  study.value = [all](double a, int scheme) { return a == 40 && scheme == 1 ? std::nan("") : all(a, scheme); };
  const QuantityAnalysis a = analyse(study.data(), 0);
  CHECK(std::isnan(a.errors[9].error));
  CHECK(a.errors[9].why_not == "the run diverged");
  CHECK(a.reference.value == Approx(2));
  CHECK(std::find(a.front.begin(), a.front.end(), 9) == a.front.end());
  for (const Sensitivity& sensitivity : a.sensitivities) CHECK((sensitivity.from != 9 && sensitivity.to != 9));
}

TEST_CASE("a study that cannot be extrapolated says why", "[analysis]") {
  MadeUpStudy study = two_schemes();
  StudyData data = study.data();
  data.axes[0].spacing.clear();
  const QuantityAnalysis a = analyse(data, 0);
  CHECK(std::isnan(a.reference.value));
  CHECK(a.reference.why_not.find("no axis along the line refines the lattice") == 0);
  CHECK(a.front.empty());
  REQUIRE(a.sentences.size() == 1);
  CHECK(a.sentences[0].text.find("Nothing is known about the error of deformation: no axis along the line refines") ==
        0);
  study.resolutions = {10, 20};
  study.schemes = {"plain"};
  StudyData few = study.data();
  few.default_setting = {0, 0};
  CHECK(analyse(few, 0).reference.why_not == "fewer than three grids have a value");
}

TEST_CASE("the front is what a comparison of all pairs leaves, sorted by time", "[analysis]") {
  std::mt19937_64 random(3);
  for (int round = 0; round < 300; ++round) {
    std::vector<double> time, error;
    // Few different numbers, so that ties of all kinds come about.
    const auto some = [&] { return std::uniform_int_distribution<int>(0, 6)(random) + 1.0; };
    for (int i = 0; i < 15; ++i) {
      time.push_back(some() < 2 ? std::nan("") : some());
      error.push_back(some() < 2 ? std::nan("") : some());
    }
    const auto front = pareto_front(time, error);
    for (std::size_t i = 0; i < time.size(); ++i) {
      const bool on_it = std::find(front.begin(), front.end(), i) != front.end();
      const bool defined = std::isfinite(time[i]) && std::isfinite(error[i]);
      CHECK(on_it == (defined && !dominated(time, error, i)));
    }
    for (std::size_t k = 1; k < front.size(); ++k) {
      CHECK(time[front[k]] > time[front[k - 1]]);
      CHECK(error[front[k]] < error[front[k - 1]]);
    }
  }
}

TEST_CASE("a sensitivity is of one axis moved by one step, and gains the ratio of the logarithms", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference = {ReferenceKind::value, 2, 0, "made up", {}};
  const QuantityAnalysis a = analyse(study.data(), 0);
  // 4 steps of 2 schemes, and 5 changes of scheme.
  REQUIRE(a.sensitivities.size() == 13);
  for (std::size_t i = 1; i < a.sensitivities.size(); ++i)
    CHECK(a.sensitivities[i - 1].gain >= a.sensitivities[i].gain);
  for (const Sensitivity& sensitivity : a.sensitivities) {
    CHECK(sensitivity.error_factor >= 1);
    if (sensitivity.axis == 0)
      CHECK(sensitivity.gain == Approx(sensitivity.to % 2 == 0 ? 1.0 / 4 : 2.0 / 4));  // order over four
    if (sensitivity.axis == 1) CHECK(sensitivity.time_factor == Approx(1.1));
  }
  // Corrected at 40: an error of 0.00125 for 0.01 and 1.1 times the time.
  CHECK(a.sensitivities[0].axis == 1);
  CHECK(a.sensitivities[0].from == 8);
  CHECK(a.sensitivities[0].to == 9);
  CHECK(a.sensitivities[0].gain == Approx(std::log(8) / std::log(1.1)));
}

TEST_CASE("a sensitivity costs nothing where the repeats' times overlap", "[analysis]") {
  MadeUpStudy made_up;
  made_up.resolutions = {10, 20};
  made_up.value = [](double radius, int scheme) { return 1 + (scheme == 0 ? 1 : 0.1) / (radius * radius); };
  made_up.time = [](double radius, int scheme) { return std::pow(radius / 10, 4) * (scheme == 0 ? 1 : 1.02); };
  made_up.reference.kind = ReferenceKind::value;
  made_up.reference.value = 1;
  StudyData study = made_up.data();
  const auto of_scheme = [&] {
    for (const Sensitivity& sensitivity : analyse(study, 0).sensitivities) {
      if (sensitivity.axis == 1 && sensitivity.to == 1) return sensitivity;
    }
    return Sensitivity{};
  };
  CHECK(of_scheme().time_factor == Approx(1.02));
  study.points[0].wall_range = {0.95, 1.01};
  study.points[1].wall_range = {1.015, 1.03};
  CHECK(of_scheme().time_factor == Approx(1.02));
  study.points[0].wall_range = {0.95, 1.03};
  CHECK(of_scheme().time_factor == 1);
  CHECK(std::isinf(of_scheme().gain));
}

TEST_CASE("what makes the error smaller and the run shorter is free, and comes first", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference = {ReferenceKind::value, 2, 0, "made up", {}};
  study.time = [](double a, int scheme) { return a * a * (scheme == 0 ? 1 : 0.5); };
  const QuantityAnalysis a = analyse(study.data(), 0);
  CHECK(std::isinf(a.sensitivities[0].gain));
  CHECK(a.sensitivities[0].time_factor == Approx(0.5));
  CHECK(a.sensitivities[0].error_factor == Approx(8));
}

TEST_CASE("a coarse grid whose error is small by chance is not named as the cheapest setting", "[analysis]") {
  MadeUpStudy study;  // as a red cell that turns in three dimensions: 0.6 % at 4 spacings, 3 % at 6, less from there on
  study.schemes = {"plain"};
  study.reference = {ReferenceKind::value, 1, 0, "known", {}};
  study.value = [](double a, int) { return a == 10 ? 1.006 : 1 + 10 / (a * a); };
  const QuantityAnalysis found = analyse(study.data(), 0);
  REQUIRE(found.sentences[0].point);
  CHECK(*found.sentences[0].point == 4);
  CHECK(found.sentences[0].text.find("take resolution 40, scheme plain") != std::string::npos);
}

TEST_CASE("one sentence names the cheapest setting below the target and what it saves", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference = {ReferenceKind::value, 2, 0, "made up", {}};
  const QuantityAnalysis a = analyse(study.data(), 0);
  REQUIRE(a.sentences.size() == 2);
  CHECK(
      a.sentences[0].text ==
      "To keep the error of deformation below 1 %, take resolution 15, scheme corrected: it runs 5.6 s, with an error "
      "of 0.89 %. The default runs 16 s, 2.9 times longer, with an error of 2 %.");
  CHECK(a.sentences[0].point == std::optional<std::size_t>(3));
  CHECK(a.sentences[0].target == 0.01);
  CHECK(a.sentences[1].text ==
        "What helps most: scheme corrected instead of plain, at resolution 40, makes the error of deformation 8 times "
        "smaller and the run 1.1 times longer.");
  StudyData strict = study.data();
  strict.quantities[0].target = 1e-6;
  CHECK(analyse(strict, 0).sentences[0].text ==
        "No setting is sure to keep the error of deformation below 0.0001 %. The nearest is resolution 40, scheme "
        "corrected: it runs 4.7 min, with an error of 0.12 %.");
  strict.quantities[0].target = 0.5;
  strict.default_setting = {0, 0};
  CHECK(
      analyse(strict, 0).sentences[0].text ==
      "To keep the error of deformation below 50 %, take resolution 10, scheme plain: it runs 1 s, with an error of 4 "
      "%. This is the default.");
}

TEST_CASE("the error of a quantity that is an error is called by its name", "[analysis]") {
  MadeUpStudy study = two_schemes();
  study.reference = {ReferenceKind::value, 2, 0, "made up", {}};
  StudyData data = study.data();
  data.quantities[0].name = "velocity error";
  const QuantityAnalysis a = analyse(data, 0);
  CHECK(a.sentences[0].text.find("To keep the velocity error below ") == 0);
  CHECK(a.sentences[1].text.find(" makes the velocity error 8 times smaller") != std::string::npos);
}

TEST_CASE("study.json gets the conclusions, with null where nothing is defined", "[analysis]") {
  MadeUpStudy study = two_schemes();
  const auto all = study.value;
  study.value = [all](double a, int scheme) { return a == 40 && scheme == 1 ? std::nan("") : all(a, scheme); };
  const StudyData data = study.data();
  nlohmann::json result{{"points", nlohmann::json::array()}};
  for (std::size_t i = 0; i < data.points.size(); ++i) result["points"].push_back({{"id", i}});
  add_analysis(result, data, analyse(data));
  CHECK(result["points"][9]["results"]["deformation"]["value"].is_null());
  CHECK(result["points"][9]["results"]["deformation"]["why_not"] == "the run diverged");
  CHECK(result["points"][4]["results"]["deformation"]["error"].get<double>() == Approx(0.02));
  CHECK(result["points"][4]["results"]["deformation"]["why_not"].is_null());
  CHECK(result["quantities"][0]["reference"]["kind"] == "richardson");
  CHECK(result["quantities"][0]["reference"]["order"].get<double>() == Approx(2));
  CHECK(result["quantities"][0]["by_method"][0]["method"] == nlohmann::json{{"scheme", "plain"}});
  CHECK(result["quantities"][0]["disagreement"].is_null());
  CHECK(result["fronts"]["deformation"][0] == 0);
  CHECK(result["knobs"]["deformation"][0]["fixed"].size() == 1);
  CHECK(result["sentences"][0]["quantity"] == "deformation");
  CHECK(result.dump().find("nan") == std::string::npos);
}
