#include "parameters.hpp"

#include <algorithm>
#include <cmath>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "json/json_pointer.hpp"
#include "json/shown.hpp"

namespace rouleau::plugin {

namespace {

using Json = nlohmann::json;

/// Resolves the parameters of one model of the scene.
class Resolver {
 public:
  Resolver(const scene::ModelChoice& choice, const Manifest& manifest, const scene::Scene& scene,
           const units::Units& units, Faults& faults)
      : choice_(choice), manifest_(manifest), scene_(scene), units_(units), faults_(faults) {}

  ParameterValues resolve() {
    ParameterValues result;
    const std::size_t before = faults_.size();
    if (is_faulty(choice_.pointer + "/parameters")) return result;
    if (!choice_.parameters.is_null() && !choice_.parameters.is_object()) {
      faults_.attempt([&] { refuse("/parameters", json::shown(choice_.parameters) + " is no object of parameters"); });
      return result;
    }
    // Without any, a key that is wrong beside the model's may have been meant for them.
    const bool lost = choice_.parameters.empty() && is_member_faulty();
    refuse_unknown();
    for (const Parameter& parameter : manifest_.parameters) {
      const bool skipped = choice_.parameters.is_object() && choice_.parameters.contains(parameter.name)
                               ? is_faulty(choice_.pointer + pointer_of(parameter.name))
                               : lost || is_misspelt(parameter.name);
      if (skipped) continue;
      faults_.attempt([&] {
        const double value = value_of(parameter);
        result.values.push_back(value);
        if (is_unusual(value, parameter)) result.warnings.push_back(warning(parameter, value));
      });
    }
    if (faults_.size() > before || result.values.size() < manifest_.parameters.size()) return result;
    result.inactive = is_inactive(result.values);
    if (result.inactive) result.warnings.clear();  // a model that is switched off need not look usual
    return result;
  }

 private:
  [[noreturn]] void refuse(const std::string& below, const std::string& problem) const {
    throw Error(Cause::bad_input, scene_.place(choice_.pointer + below), problem);
  }
  [[nodiscard]] static std::string pointer_of(const std::string& name) {
    return json::child_pointer("/parameters", name);
  }

  [[nodiscard]] bool is_faulty(const std::string& pointer) const {
    for (std::size_t i = 0; i < faults_.size(); ++i)
      if (faults_[i].place().pointer == pointer) return true;
    return false;
  }
  [[nodiscard]] bool is_member_faulty() const {
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      const std::string& faulty = faults_[i].place().pointer;
      if (faulty.substr(0, faulty.rfind('/')) == choice_.pointer) return true;
    }
    return false;
  }

  /// Was an unknown name most likely meant to be this parameter?
  [[nodiscard]] bool is_misspelt(const std::string& name) const {
    return std::find(misspelt_.begin(), misspelt_.end(), name) != misspelt_.end();
  }

  void refuse_unknown() {
    std::vector<std::string> names;
    for (const Parameter& parameter : manifest_.parameters) names.push_back(parameter.name);
    for (const auto& [name, value] : choice_.parameters.items()) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      misspelt_.push_back(likely(name, names));
      const std::string pointer = choice_.pointer + pointer_of(name);
      faults_.add({Cause::bad_input, scene_.document ? scene_.document->key_place(pointer) : scene_.place(pointer),
                   in_quotes(manifest_.id) + " has no parameter " + in_quotes(name) + did_you_mean(name, names) +
                       "\n  its parameters: " + listed(names)});
    }
  }

  /// Value in SI, or index of a choice; within its limits.
  [[nodiscard]] double value_of(const Parameter& parameter) const {
    const bool given = choice_.parameters.is_object() && choice_.parameters.contains(parameter.name);
    if (!given && parameter.default_value) return *parameter.default_value;
    if (!given) refuse("", missing(parameter));
    const Json& written = choice_.parameters[parameter.name];
    if (!parameter.choices.empty()) return index_of(parameter, written);
    const double value = quantity(parameter, written);
    const std::string wanted = violated_limit(value, parameter, units_);
    if (!wanted.empty()) {
      refuse(pointer_of(parameter.name), parameter.name + " is " + json::shown(written) +
                                             in_unit(parameter, written, value) + "; it must be " + wanted);
    }
    require_plausible(parameter, written, value);
    return value;
  }

  /// A forgotten unit makes a length of metres; a length of an interaction beyond the box makes no sense with one,
  /// either.
  void require_plausible(const Parameter& parameter, const Json& written, double value) const {
    constexpr double unit_forgotten = 1e3;
    constexpr units::Dimension length{{0, 1}};
    if (written.is_number() && parameter.unit != "1" && parameter.usual &&
        std::abs(value) > unit_forgotten * std::max(std::abs((*parameter.usual)[0]), std::abs((*parameter.usual)[1]))) {
      const std::string plain = json::shown(written);
      refuse(pointer_of(parameter.name), parameter.name + " is " + plain +
                                             ", which has no unit: as a plain number it is taken in SI, and is then " +
                                             value_text(value, parameter, units_) + ", far beyond its usual range, " +
                                             value_text((*parameter.usual)[0], parameter, units_) + " to " +
                                             value_text((*parameter.usual)[1], parameter, units_) +
                                             "\n  write it with the unit that is meant, such as \"" + plain + ' ' +
                                             (parameter.dimension == length ? "um" : parameter.unit) + '"');
    }
    const double box = scene_.domain.size.most();
    if (manifest_.kind == ModelKind::interaction && parameter.dimension == length && value > box) {
      refuse(pointer_of(parameter.name), parameter.name + " is " + json::shown(written) +
                                             in_unit(parameter, written, value) + ", longer than the box, which is " +
                                             scene::by_axes(scene_.domain.size, 1e6, 6, " um"));
    }
  }

  [[nodiscard]] std::string missing(const Parameter& parameter) const {
    std::string text = in_quotes(manifest_.id) + " needs the parameter " + in_quotes(parameter.name) + ", ";
    if (!parameter.choices.empty()) return text + "one of: " + listed(parameter.choices);
    text += parameter.unit == "1" ? "a number" : "in " + parameter.unit;
    return parameter.doc.empty() ? text : text + "\n  " + parameter.doc;
  }

  [[nodiscard]] double index_of(const Parameter& parameter, const Json& written) const {
    const auto& words = parameter.choices;
    const std::string word = written.is_string() ? written.get<std::string>() : "";
    const auto found = std::find(words.begin(), words.end(), word);
    if (!written.is_string() || found == words.end()) {
      refuse(pointer_of(parameter.name), parameter.name + " is " + json::shown(written) + did_you_mean(word, words) +
                                             "\n  it must be one of: " + listed(words));
    }
    return static_cast<double>(found - words.begin());
  }

  [[nodiscard]] double quantity(const Parameter& parameter, const Json& written) const {
    const std::string pointer = pointer_of(parameter.name);
    double value = 0;
    if (written.is_number()) {
      value = written.get<double>();
    } else if (written.is_string()) {
      try {
        value = units_.to_si(written.get<std::string>(), parameter.unit, parameter.name);
      } catch (const units::UnitError& error) {
        refuse(pointer, error.what());
      }
    } else {
      refuse(pointer,
             parameter.name + " is " + json::shown(written) + "; it must be " +
                 (parameter.unit == "1" ? "a number"
                                        : "a quantity such as \"1 " + parameter.unit + "\", or a plain number in SI"));
    }
    if (!std::isfinite(value)) refuse(pointer, parameter.name + " is " + json::shown(written) + "; it must be finite");
    return value;
  }

  /// " (5.2e-08 J/m2)" after a value that was not written in the parameter's unit.
  [[nodiscard]] std::string in_unit(const Parameter& parameter, const Json& written, double value) const {
    const std::string text = value_text(value, parameter, units_);
    const bool same = written.is_string() ? written == text : parameter.unit == "1";
    return same ? "" : " (" + text + ')';
  }

  [[nodiscard]] std::string warning(const Parameter& parameter, double value) const {
    const auto [low, high] = *parameter.usual;
    return to_string(scene_.place(choice_.pointer + pointer_of(parameter.name))) + ": " + parameter.name + " = " +
           value_text(value, parameter, units_) + " is outside its usual range, " + value_text(low, parameter, units_) +
           " to " + value_text(high, parameter, units_);
  }

  [[nodiscard]] bool is_inactive(const std::vector<double>& values) const {
    const Json& conditions = manifest_.inactive_when;
    if (!conditions.is_object() || conditions.empty()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Parameter& parameter = manifest_.parameters[i];
      if (!conditions.contains(parameter.name)) continue;
      const Json& condition = conditions[parameter.name];
      const double wanted = parameter.choices.empty() ? condition.get<double>() * units_.scale(parameter.unit)
                                                      : index_of(parameter, condition);
      if (!same_quantity(values[i], wanted)) return false;
    }
    return true;
  }

  const scene::ModelChoice& choice_;
  const Manifest& manifest_;
  const scene::Scene& scene_;
  const units::Units& units_;
  Faults& faults_;
  std::vector<std::string> misspelt_;  ///< parameters that unknown names were most likely meant to be
};

}  // namespace

ParameterValues resolve_parameters(const scene::ModelChoice& choice, const Manifest& manifest,
                                   const scene::Scene& scene, const units::Units& units, Faults& faults) {
  return Resolver(choice, manifest, scene, units, faults).resolve();
}

ParameterValues resolve_parameters(const scene::ModelChoice& choice, const Manifest& manifest,
                                   const scene::Scene& scene, const units::Units& units) {
  Faults faults;
  ParameterValues values = resolve_parameters(choice, manifest, scene, units, faults);
  faults.raise();
  return values;
}

std::string value_text(double si, const Parameter& parameter, const units::Units& units) {
  const std::string text = number(si / units.scale(parameter.unit));
  return parameter.unit == "1" ? text : text + ' ' + parameter.unit;
}

std::string violated_limit(double value, const Parameter& parameter, const units::Units& units) {
  const auto text = [&](const char* words, double limit) { return words + value_text(limit, parameter, units); };
  if (const auto limit = parameter.minimum; limit && value < *limit && !same_quantity(value, *limit))
    return text("at least ", *limit);
  if (const auto limit = parameter.exclusive_minimum; limit && (value <= *limit || same_quantity(value, *limit)))
    return text("above ", *limit);
  if (const auto limit = parameter.maximum; limit && value > *limit && !same_quantity(value, *limit))
    return text("at most ", *limit);
  if (const auto limit = parameter.exclusive_maximum; limit && (value >= *limit || same_quantity(value, *limit)))
    return text("below ", *limit);
  return {};
}

bool is_unusual(double value, const Parameter& parameter) {
  if (!parameter.usual) return false;
  const auto [low, high] = *parameter.usual;
  return (value < low && !same_quantity(value, low)) || (value > high && !same_quantity(value, high));
}

}  // namespace rouleau::plugin
