#include "quantity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "json/shown.hpp"
#include "observe/observables.hpp"
#include "scene/scene_reader.hpp"

namespace rouleau::study {

namespace {

/// What the kinds have in common, in the order of QuantityKind; study.schema.json has their keys.
struct KindTraits {
  const char* name;
  const char* unit;
  ErrorKind error;
  double target;  ///< 1 %, or what the field takes for good
  bool exactly_zero = false;
};

const std::array<KindTraits, 15>& kinds() {
  using enum ErrorKind;
  static const std::array<KindTraits, 15> table{{
      {"deformation", "", relative, 0.01},
      {"angle", "deg", absolute, 1},
      {"area_drift", "", absolute, 1e-3, true},
      {"mass_drift", "", absolute, 1e-9, true},
      {"passage", "", relative, 0.01},
      {"period", "", relative, 0.01},
      {"gap", "m", relative, 0.01},
      {"speed", "m/s", relative, 0.01},
      {"contact_area", "m2", relative, 0.01},
      {"contact_length", "m", relative, 0.01},
      {"dissociation_strain", "", relative, 0.1},
      {"aggregate_count", "", absolute, 0.5},
      {"relative_viscosity", "", relative, 0.01},
      {"velocity_l2", "", absolute, 0.01, true},
      {"column", "", relative, 0.01},
  }};
  return table;
}

using Json = nlohmann::json;

double time_of(const scene::SceneFields& fields, const std::string& pointer) {
  return fields.quantity(pointer, "s", {0, scene::range::time.most});
}

When read_when(const scene::SceneFields& fields, const std::string& pointer) {
  const Json& written = fields.at(pointer);
  if (written.is_string()) return {};
  const std::string key = written.begin().key();
  if (key == "strain") return {When::Kind::strain, written[key]};
  if (key == "mean_from_strain") return {When::Kind::mean_from_strain, written[key]};
  return {key == "time" ? When::Kind::time : When::Kind::mean_from_time, time_of(fields, pointer + "/" + key)};
}

void read_column(const scene::SceneFields& fields, const std::string& pointer, Quantity& quantity) {
  quantity.table = fields.at(pointer + "/table");
  quantity.column = fields.at(pointer + "/column");
  const observe::Table& table = observe::table(quantity.table);
  std::vector<std::string> columns;
  for (const observe::Observable& observable : table.observables) columns.push_back(observable.column());
  const auto found = std::find(columns.begin(), columns.end(), quantity.column);
  if (found == columns.end()) {
    fields.refuse(pointer + "/column", quantity.table + ".csv has no column " + in_quotes(quantity.column) +
                                           did_you_mean(quantity.column, columns) + "\nit has " + listed(columns));
  }
  quantity.unit = table.observables[found - columns.begin()].unit;
}

/// Keys of one kind or a few.
void read_own_keys(const scene::SceneFields& fields, const std::string& pointer, Quantity& quantity) {
  const Json& written = fields.at(pointer);
  quantity.cell = written.value("cell", quantity.kind == QuantityKind::gap ? -1 : 0);
  if (written.contains("at")) quantity.at = read_when(fields, pointer + "/at");
  if (written.contains("angle"))
    quantity.passed_angle = fields.quantity(pointer + "/angle", "rad", scene::range::angle);
  quantity.of_long_axis = written.value("of", "") == "rotation";
  quantity.turns = written.value("turns", quantity.turns);
  if (written.contains("from_strain")) quantity.from_strain = written["from_strain"];
  if (written.contains("from_time")) quantity.from_time = time_of(fields, pointer + "/from_time");
  if (quantity.kind == QuantityKind::speed) quantity.column = written.value("along", "x") + "_m";
  if (written.contains("count")) quantity.count = written["count"];
  quantity.for_good = written.value("for_good", quantity.for_good);
  quantity.intrinsic = written.value("intrinsic", quantity.intrinsic);
  quantity.poiseuille = written.value("flow", "") == "poiseuille";
  quantity.steady = written.value("steady", quantity.steady);
  if (quantity.kind == QuantityKind::column) read_column(fields, pointer, quantity);
}

/// The number at a JSON pointer of a file that the study names.
double number_of_file(const scene::SceneFields& fields, const json::Document& file, const std::string& pointer) {
  const std::string inside = fields.line(pointer);
  const auto tokens = json::split_pointer(inside);
  if (!tokens) fields.refuse(pointer, in_quotes(inside) + " is no JSON pointer (for example \"/0/steady/D\")");
  const nlohmann::json* at = &file.root();
  std::string reached;
  for (const std::string& token : *tokens) {
    const auto index = json::array_index(token);
    const nlohmann::json* next = nullptr;
    if (at->is_object() && at->contains(token)) next = &at->at(token);
    if (at->is_array() && index && *index < at->size()) next = &at->at(*index);
    if (next == nullptr) {
      std::vector<std::string> names;
      if (at->is_object())
        for (const auto& [name, value] : at->items()) names.push_back(name);
      fields.refuse(pointer,
                    file.file() + " has nothing at " + in_quotes(inside) + ": " +
                        (reached.empty() ? "the document" : in_quotes(reached)) +
                        (at->is_array() ? " has the entries 0 to " + std::to_string(static_cast<long>(at->size()) - 1)
                                        : " has " + listed(names)) +
                        did_you_mean(token, names));
    }
    at = next;
    reached = json::child_pointer(reached, token);
  }
  if (!at->is_number())
    fields.refuse(pointer,
                  file.file() + " has " + json::shown(*at) + " at " + in_quotes(inside) + ", which is not a number");
  return at->get<double>();
}

Reference reference_of_file(const scene::SceneFields& fields, const json::Document& document,
                            const std::string& pointer) {
  const nlohmann::json& written = fields.at(pointer);
  const std::string name = fields.line(pointer + "/file");
  const json::Document file = json::Document::read(std::filesystem::path(document.file()).parent_path() / name);
  const double factor = written.value("factor", 1.0);
  Reference result;
  result.kind = ReferenceKind::file;
  result.value = factor * number_of_file(fields, file, pointer + "/pointer") + written.value("offset", 0.0);
  if (written.contains("uncertainty")) {
    result.uncertainty = written["uncertainty"].is_string()
                             ? std::abs(factor * number_of_file(fields, file, pointer + "/uncertainty"))
                             : written["uncertainty"].get<double>();
  }
  result.source = fields.has(pointer + "/source") ? fields.line(pointer + "/source")
                                                  : name + " " + fields.line(pointer + "/pointer");
  return result;
}

}  // namespace

const char* name_of(QuantityKind kind) { return kinds()[static_cast<std::size_t>(kind)].name; }

Quantity read_quantity(const json::Document& document, const std::string& pointer) {
  const scene::SceneFields fields(document);
  const Json& written = fields.at(pointer);
  const auto traits = std::find_if(kinds().begin(), kinds().end(),
                                   [&](const KindTraits& known) { return written["kind"] == known.name; });
  Quantity quantity;
  quantity.name = fields.line(pointer + "/name");
  quantity.kind = static_cast<QuantityKind>(traits - kinds().begin());
  quantity.unit = traits->unit;
  quantity.error = traits->error;
  if (written.contains("error"))
    quantity.error = written["error"] == "relative" ? ErrorKind::relative : ErrorKind::absolute;
  quantity.target = written.value("target", traits->target);
  read_own_keys(fields, pointer, quantity);
  if (written.contains("reference")) quantity.reference = read_reference(document, pointer + "/reference");
  if (traits->exactly_zero) {
    if (written.contains("reference") && quantity.reference.kind != ReferenceKind::analytic)
      fields.refuse(pointer + "/reference",
                    std::string(traits->name) + " should be exactly 0: leave the reference out");
    quantity.reference = {ReferenceKind::analytic, 0, 0, "exactly zero", {}};
    if (quantity.kind == QuantityKind::velocity_l2) quantity.reference.source = "the exact flow";
  }
  if (quantity.error == ErrorKind::relative && quantity.reference.value == 0) {
    fields.refuse(pointer + (written.contains("error") ? "/error" : ""),
                  "there is no error relative to a reference of 0: say \"error\": \"absolute\"");
  }
  return quantity;
}

Reference read_reference(const json::Document& document, const std::string& pointer) {
  const scene::SceneFields fields(document);
  const nlohmann::json& written = fields.at(pointer);
  Reference result;
  if (written.is_string()) return result;
  if (written.contains("file")) return reference_of_file(fields, document, pointer);
  if (written.contains("value")) {
    result.kind = ReferenceKind::value;
    result.value = written["value"];
    result.uncertainty = written.value("uncertainty", 0.0);
    result.source = fields.has(pointer + "/source") ? fields.line(pointer + "/source") : "given in the study";
  } else if (written.contains("analytic")) {
    result = {ReferenceKind::analytic, 0, 0, "exactly zero", {}};
  } else if (written.contains("point")) {
    result.kind = ReferenceKind::point;
    result.labels = written["point"];
  } else {
    result.labels = written["richardson"];
  }
  return result;
}

const char* name_of(ReferenceKind kind) {
  constexpr std::array words{"value", "file", "analytic", "richardson", "point"};
  return words.at(static_cast<std::size_t>(kind));
}

Dissociation dissociation(const std::vector<CountChange>& changes, const Column& output_strain, double start_time,
                          double start_strain, int count, bool for_good) {
  constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();
  double found = not_a_value;  // over all stages, as in the tables
  bool at_start = false;
  for (const CountChange& change : changes) {
    const bool enough = change.count >= count;
    if (change.time <= start_time) {
      at_start = enough;
    } else if (!enough && for_good) {
      found = not_a_value;
      at_start = false;  // they met: what was apart when shear began can come apart
    } else if (enough && std::isnan(found)) {
      found = change.strain;
    }
  }
  if (at_start) return {not_a_value, not_a_value, true};
  double before = start_strain;
  for (const double strain : output_strain)
    if (strain < found) before = std::max(before, strain);
  return {found - start_strain, found - before, false};
}

}  // namespace rouleau::study
