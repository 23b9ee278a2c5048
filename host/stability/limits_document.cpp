#include "limits_document.hpp"

#include <cmath>
#include <cstdlib>

#include "base/text.hpp"
#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "units/units.hpp"

namespace rouleau::stability {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct NumberWithUnit {
  double value = 0;
  std::string unit;
};

/// "6e-6 N/m" in its parts; a plain number has no unit.
NumberWithUnit read_value(const json::Document& document, const std::string& pointer) {
  const Json& given = document.root().at(Json::json_pointer(pointer));
  if (given.is_number()) return {given.get<double>(), ""};
  const std::string text = given.get<std::string>();
  char* end = nullptr;
  NumberWithUnit read{std::strtod(text.c_str(), &end), ""};
  const auto used = static_cast<std::size_t>(end - text.c_str());
  const std::size_t unit = text.find_first_not_of(' ', used);
  if (unit != std::string::npos) read.unit = text.substr(unit);
  try {
    if (used == 0) throw units::UnitError("it does not begin with a number");
    if (!read.unit.empty()) (void)units::Units().dimension(read.unit);
  } catch (const units::UnitError& error) {
    throw Error(
        Cause::bad_input, document.place(pointer),
        in_quotes(text) + " is no value with a unit: " + error.what() + "; write for example \"6e-6 N/m\" or 6");
  }
  return read;
}

std::vector<std::string> read_pointers(const json::Document& document) {
  const Json& given = document.root()["parameter"];
  const bool one = given.contains("pointer"), several = given.contains("pointers");
  if (one == several)
    throw Error(Cause::bad_input, document.place("/parameter"),
                one ? "has both pointer and pointers; leave one of them out"
                    : "wants \"pointer\", the place of the parameter in the scene, for example "
                      "\"/numerics/density_factor\"");
  return one ? std::vector<std::string>{given["pointer"].get<std::string>()}
             : given["pointers"].get<std::vector<std::string>>();
}

LimitsParameter read_parameter(const json::Document& document, const Json& scene) {
  const Json& given = document.root()["parameter"];
  const auto refuse = [&document](const std::string& pointer, const std::string& problem) {
    throw Error(Cause::bad_input, document.place(pointer), problem);
  };
  LimitsParameter parameter;
  parameter.name = given["name"];
  parameter.pointers = read_pointers(document);
  const NumberWithUnit from = read_value(document, "/parameter/from"), to = read_value(document, "/parameter/to");
  if (from.unit != to.unit)
    refuse("/parameter/to",
           "is in " + in_quotes(to.unit) + ", and from in " + in_quotes(from.unit) + "; write both in the same unit");
  parameter.unit = from.unit;
  SearchRange& range = parameter.range;
  range = {from.value, to.value};
  range.whole = given.value("whole", false);
  range.scale = given.value("scale", "log") == "linear" ? Scale::linear : Scale::logarithmic;
  if (!(range.from < range.to) || !std::isfinite(range.to))
    refuse("/parameter/to", number(range.to) + " is not above from, " + number(range.from) + "; exchange them");
  const bool logarithmic = range.scale == Scale::logarithmic;
  if (logarithmic && !(range.from > 0))
    refuse("/parameter/from", number(range.from) + " has no logarithm; begin above zero, or set scale to \"linear\"");
  range.precision = given.value("precision", logarithmic ? 1.1 : (range.to - range.from) / 100);
  if (logarithmic && !(range.precision > 1.0001))
    refuse("/parameter/precision",
           number(range.precision) + " is a ratio on the log scale; write one above 1.0001, for example 1.1");
  if (!logarithmic && !(range.precision >= 1e-4 * (range.to - range.from)))
    refuse("/parameter/precision",
           number(range.precision) + " is finer than a ten-thousandth of the range; write more");
  for (const double end : {range.from, range.to}) {
    Json tried = scene;
    try {
      for (const std::string& pointer : parameter.pointers)
        (void)json::put_value(tried, pointer, parameter.written(end));
      if (end == range.from) trial::check_scene(tried, "the scene");
    } catch (const json::PutError& error) {
      refuse(given.contains("pointer") ? "/parameter/pointer" : "/parameter/pointers", error.what());
    } catch (const Error& error) {
      refuse("/parameter/from", "the scene with this value, " + error.place().pointer + "\n  " + error.words());
    }
  }
  return parameter;
}

}  // namespace

Json LimitsParameter::written(double value) const {
  if (unit.empty()) return range.whole ? Json(std::lround(value)) : Json(value);
  return number(value) + ' ' + unit;
}

LimitsFile read_limits(const fs::path& file) {
  LimitsFile limits;
  static_cast<trial::CampaignFile&>(limits) = trial::read_campaign_file(trial::limits_kind, file, limits_schema());
  const json::Document& document = *limits.document;
  const Json& root = document.root();
  limits.steps = root.value("steps", 0L);
  limits.parameter = read_parameter(document, limits.scene);
  if (root.contains("sound")) limits.criteria = root["sound"];
  return limits;
}

}  // namespace rouleau::stability
