// A scene's parameters against a manifest: conversion, defaults, limits, and messages that say what to write instead.
#include "plugin/parameters.hpp"
#include "plugin/manifest_reader.hpp"

#include "json/document.hpp"
#include "plugin_folder.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::json;
using namespace rouleau::plugin;
using namespace rouleau::scene;
using namespace rouleau::test;
using namespace rouleau::units;
using namespace rouleau::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

/// A model of a scene with these parameters, and the manifest that they are meant for.
class Case {
 public:
  explicit Case(const std::string& parameters, const Json& manifest = good_manifest())
      : manifest_(read_manifest(folder_.write("m.json", manifest), units_)) {
    const std::string text = "{\"model\": {\n  \"parameters\": " + parameters + "}}";
    scene_.document = std::make_shared<const Document>(Document::parse(text, "scene.json"));
    choice_ = {"good", scene_.document->root()["model"]["parameters"], "/model"};
  }
  [[nodiscard]] ParameterValues resolve() const { return resolve_parameters(choice_, manifest_, scene_, units_); }
  [[nodiscard]] Error error() const {
    return thrown_by([&] { (void)resolve(); });
  }

 private:
  PluginFolder folder_;
  Units units_;
  Manifest manifest_;
  Scene scene_;
  ModelChoice choice_;
};

struct Fault {
  const char* parameters;
  const char* pointer;
  std::vector<std::string> words;
};

}  // namespace

TEST_CASE("quantities, plain numbers, words and defaults become values in SI in the manifest's order") {
  const auto result = Case(R"({"form": "sharp", "depth": "2 uJ/m2", "temperature": 300})").resolve();
  REQUIRE(result.values.size() == 4);
  CHECK(result.values[0] == Approx(2e-6).epsilon(1e-14));
  CHECK(result.values[1] == Approx(3.84e6).epsilon(1e-14));
  CHECK(result.values[2] == 300);
  CHECK(result.values[3] == 0);
  CHECK(result.warnings.empty());
  CHECK_FALSE(result.inactive);
}

TEST_CASE("another unit of the same kind is converted, and a plain number is SI") {
  CHECK(Case(R"({"depth": "2e-3 dyn/cm"})").resolve().values[0] == Approx(2e-6).epsilon(1e-14));
  CHECK(Case(R"({"depth": 2e-6})").resolve().values[0] == 2e-6);
}

TEST_CASE("a wrong parameter is bad input at its place, with what was found and what is wanted") {
  const std::vector<Fault> faults = {
      {R"({"depth": "6 Pa"})", "/model/parameters/depth", {"6 Pa", "uJ/m2"}},
      {R"({"depth": "deep"})", "/model/parameters/depth", {"deep"}},
      {R"({"depth": "1 uJ/m2", "deth": 1})",
       "/model/parameters/deth",
       {"deth", "did you mean \"depth\"?", "depth, decay, temperature, form"}},
      {R"({"depth": "-1 uJ/m2"})", "/model/parameters/depth", {"-1 uJ/m2", "at least 0 uJ/m2"}},
      {R"({"depth": 1})", "/model/parameters/depth", {"(1e+06 uJ/m2)", "at most 100 uJ/m2"}},
      {R"({"depth": 0, "decay": "0 1/um"})", "/model/parameters/decay", {"above 0 1/um"}},
      {R"({"depth": true})", "/model/parameters/depth", {"true", "\"1 uJ/m2\""}},
      {R"({"depth": null})", "/model/parameters/depth", {"null"}},
      {R"({"depth": [1]})", "/model/parameters/depth", {"[1]"}},
      {R"({"depth": "1e999 uJ/m2"})", "/model/parameters/depth", {"1e999"}},
      {R"({"depth": "nan uJ/m2"})", "/model/parameters/depth", {"nan"}},
      {R"({"depth": 0, "form": "smoth"})", "/model/parameters/form", {"smoth", "did you mean \"smooth\"?", "sharp"}},
      {R"({"depth": 0, "form": 1})", "/model/parameters/form", {"sharp, smooth"}},
      {R"({"decay": "3 1/um"})", "/model", {"\"good\" needs the parameter \"depth\"", "uJ/m2", "How deep."}},
      {R"([1])", "/model/parameters", {"[1]"}},
  };
  for (const Fault& fault : faults) {
    INFO(fault.parameters);
    const Error error = Case(fault.parameters).error();
    INFO(error.what());
    CHECK(error.cause() == Cause::bad_input);
    CHECK(error.place().pointer == fault.pointer);
    CHECK(error.place().file == "scene.json");
    CHECK(error.place().line > 0);
    for (const auto& word : fault.words) CHECK_THAT(error.what(), Contains(word));
  }
}

TEST_CASE("a value on its limit is accepted in whatever unit it is written") {
  CHECK_NOTHROW(Case(R"({"depth": "100 uJ/m2"})").resolve());
  CHECK_NOTHROW(Case(R"({"depth": "0.1 mJ/m2"})").resolve());
  CHECK_NOTHROW(Case(R"({"depth": "0.1 dyn/cm"})").resolve());
  CHECK_NOTHROW(Case(R"({"depth": 1e-4})").resolve());
}

TEST_CASE("a value outside its usual range is a warning with its place") {
  const auto result = Case(R"({"depth": "50 uJ/m2"})").resolve();
  REQUIRE(result.warnings.size() == 1);
  CHECK_THAT(result.warnings[0],
             Contains("scene.json:") && Contains("depth = 50 uJ/m2") && Contains("0.001 uJ/m2 to 10 uJ/m2"));
}

TEST_CASE("a model is inactive when all conditions of its manifest hold") {
  CHECK(Case(R"({"depth": 0})").resolve().inactive);
  CHECK(Case(R"({"depth": "0 dyn/cm"})").resolve().inactive);
  CHECK_FALSE(Case(R"({"depth": "1e-9 uJ/m2"})").resolve().inactive);
  Json manifest = good_manifest();
  manifest["inactive_when"] = {{"depth", 1}, {"form", "sharp"}};
  CHECK(Case(R"({"depth": 1e-6, "form": "sharp"})", manifest).resolve().inactive);
  CHECK_FALSE(Case(R"({"depth": 1e-6})", manifest).resolve().inactive);
  manifest.erase("inactive_when");
  CHECK_FALSE(Case(R"({"depth": 0})", manifest).resolve().inactive);
}

TEST_CASE("a model without parameters takes none") {
  Json manifest = good_manifest();
  manifest.erase("parameters");
  manifest.erase("inactive_when");
  CHECK(Case("{}", manifest).resolve().values.empty());
  CHECK(Case("null", manifest).resolve().values.empty());
  CHECK_THAT(Case(R"({"magic": 1})", manifest).error().what(), Contains("its parameters: none"));
}
