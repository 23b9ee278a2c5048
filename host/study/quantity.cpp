#include "quantity.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "base/synonyms.hpp"
#include "json/document.hpp"
#include "observe/observables.hpp"
#include "study_reader.hpp"

namespace rouleau::study {

namespace {

/// What the kinds have in common, in the order of QuantityKind.
struct KindTraits {
  const char* name;
  const char* unit;
  ErrorKind error;
  double target;  ///< 1 %, or what the field takes for good
  std::vector<std::string> needed, optional;
  bool exactly_zero = false;
};

const std::array<KindTraits, 15>& kinds() {
  using enum ErrorKind;
  static const std::array<KindTraits, 15> table{{
      {"deformation", "", relative, 0.01, {}, {"cell", "at"}},
      {"angle", "deg", absolute, 1, {}, {"cell", "at"}},
      {"area_drift", "", absolute, 1e-3, {}, {}, true},
      {"mass_drift", "", absolute, 1e-9, {}, {}, true},
      {"passage", "", relative, 0.01, {"angle"}, {"cell"}},
      {"period", "", relative, 0.01, {}, {"cell", "of", "turns", "from_strain"}},
      {"gap", "m", relative, 0.01, {}, {"cell", "at"}},
      {"speed", "m/s", relative, 0.01, {}, {"cell", "along", "from_time"}},
      {"contact_area", "m2", relative, 0.01, {}, {"at"}},
      {"contact_length", "m", relative, 0.01, {}, {"at"}},
      {"dissociation_strain", "", relative, 0.1, {}, {"count", "for_good"}},
      {"aggregate_count", "", absolute, 0.5, {}, {}},
      {"relative_viscosity", "", relative, 0.01, {}, {"at", "intrinsic"}},
      {"velocity_l2", "", absolute, 0.01, {"flow"}, {"steady"}, true},
      {"column", "", relative, 0.01, {"table", "column"}, {"cell", "at"}},
  }};
  return table;
}

double time_of(const StudyReader& reader, const std::string& pointer) {
  return reader.scene_fields().quantity(pointer, "s", {0, scene::range::time.most});
}

When read_when(const StudyReader& reader, const std::string& pointer) {
  if (reader.scene_fields().at(pointer).is_string()) {
    reader.choice(pointer, {"end"});
    return {};
  }
  const std::vector<std::string> keys{"strain", "time", "mean_from_strain", "mean_from_time"};
  reader.only(pointer, keys, "\"at\"");
  if (reader.scene_fields().at(pointer).size() != 1)
    reader.scene_fields().refuse(pointer, "\"at\" is \"end\", or an object with one of " + listed(keys));
  for (const auto& [key, kind] :
       {std::pair("/time", When::Kind::time), {"/mean_from_time", When::Kind::mean_from_time}})
    if (reader.has(pointer + key)) return {kind, time_of(reader, pointer + key)};
  if (reader.has(pointer + "/strain")) return {When::Kind::strain, reader.number(pointer + "/strain")};
  return {When::Kind::mean_from_strain, reader.number(pointer + "/mean_from_strain")};
}

void read_column(const StudyReader& reader, const std::string& pointer, Quantity& quantity) {
  quantity.table =
      std::array<const char*, 2>{"cells", "series"}[reader.choice(pointer + "/table", {"cells", "series"})];
  quantity.column = reader.text(pointer + "/column");
  const observe::Table& table = observe::table(quantity.table);
  std::vector<std::string> columns;
  for (const observe::Observable& observable : table.observables) columns.push_back(observable.column());
  const auto found = std::find(columns.begin(), columns.end(), quantity.column);
  if (found == columns.end()) {
    reader.scene_fields().refuse(pointer + "/column",
                                 quantity.table + ".csv has no column " + in_quotes(quantity.column) +
                                     did_you_mean(quantity.column, columns) + "\nit has " + listed(columns));
  }
  quantity.unit = table.observables[found - columns.begin()].unit;
}

/// Keys of one kind or a few.
void read_own_keys(const StudyReader& reader, const std::string& pointer, Quantity& quantity) {
  if (reader.has(pointer + "/cell"))
    quantity.cell = reader.count(pointer + "/cell", 0);
  else if (quantity.kind == QuantityKind::gap)
    quantity.cell = -1;
  if (reader.has(pointer + "/at")) quantity.at = read_when(reader, pointer + "/at");
  if (reader.has(pointer + "/angle"))
    quantity.passed_angle = reader.scene_fields().quantity(pointer + "/angle", "rad", scene::range::angle);
  if (reader.has(pointer + "/of"))
    quantity.of_long_axis = reader.choice(pointer + "/of", {"tank_treading", "rotation"}) == 1;
  if (reader.has(pointer + "/turns")) quantity.turns = reader.positive(pointer + "/turns");
  if (reader.has(pointer + "/from_strain")) quantity.from_strain = reader.number(pointer + "/from_strain");
  if (reader.has(pointer + "/from_time")) quantity.from_time = time_of(reader, pointer + "/from_time");
  if (quantity.kind == QuantityKind::speed) quantity.column = "x_m";
  if (reader.has(pointer + "/along"))
    quantity.column = std::array{"x_m", "y_m", "z_m"}[reader.choice(pointer + "/along", {"x", "y", "z"})];
  if (reader.has(pointer + "/count")) quantity.count = reader.count(pointer + "/count", 1);
  if (reader.has(pointer + "/for_good")) quantity.for_good = reader.yes(pointer + "/for_good");
  if (reader.has(pointer + "/intrinsic")) quantity.intrinsic = reader.yes(pointer + "/intrinsic");
  if (reader.has(pointer + "/flow"))
    quantity.poiseuille = reader.choice(pointer + "/flow", {"couette", "poiseuille"}) == 1;
  if (reader.has(pointer + "/steady")) quantity.steady = reader.yes(pointer + "/steady");
  if (quantity.kind == QuantityKind::column) read_column(reader, pointer, quantity);
}

}  // namespace

const char* name_of(QuantityKind kind) { return kinds()[static_cast<std::size_t>(kind)].name; }

Quantity read_quantity(const json::Document& document, const std::string& pointer) {
  const scene::SceneFields scene_fields(document);
  const StudyReader reader(scene_fields);
  if (!scene_fields.at(pointer).is_object())
    scene_fields.refuse(pointer, "a quantity is an object {\"name\", \"kind\", ...}");
  for (const char* key : {"name", "kind"}) reader.needs(pointer, key, "a quantity");
  std::vector<std::string> names;
  for (const KindTraits& traits : kinds()) names.emplace_back(traits.name);
  const std::size_t index = reader.choice(pointer + "/kind", names);
  const KindTraits& traits = kinds()[index];

  std::vector<std::string> keys{"name", "kind", "target", "reference", "error"};
  keys.insert(keys.end(), traits.needed.begin(), traits.needed.end());
  keys.insert(keys.end(), traits.optional.begin(), traits.optional.end());
  const std::string whose = std::string("a quantity of kind ") + traits.name;
  reader.only(pointer, keys, whose);
  for (const std::string& key : traits.needed) reader.needs(pointer, key, whose);

  Quantity quantity;
  quantity.name = reader.text(pointer + "/name");
  quantity.kind = static_cast<QuantityKind>(index);
  quantity.unit = traits.unit;
  quantity.error = traits.error;
  if (reader.has(pointer + "/error"))
    quantity.error =
        reader.choice(pointer + "/error", {"relative", "absolute"}) == 0 ? ErrorKind::relative : ErrorKind::absolute;
  quantity.target = reader.has(pointer + "/target") ? reader.positive(pointer + "/target") : traits.target;
  read_own_keys(reader, pointer, quantity);
  if (reader.has(pointer + "/reference"))
    quantity.reference = read_reference(scene_fields, document, pointer + "/reference");
  if (traits.exactly_zero) {
    if (reader.has(pointer + "/reference") && quantity.reference.kind != ReferenceKind::analytic)
      scene_fields.refuse(pointer + "/reference",
                          std::string(traits.name) + " should be exactly 0: leave the reference out");
    quantity.reference = {ReferenceKind::analytic, 0, 0, "exactly zero", {}};
    if (quantity.kind == QuantityKind::velocity_l2) quantity.reference.source = "the exact flow";
  }
  if (quantity.error == ErrorKind::relative && quantity.reference.value == 0) {
    scene_fields.refuse(reader.has(pointer + "/error") ? pointer + "/error" : pointer,
                        "there is no error relative to a reference of 0: say \"error\": \"absolute\"");
  }
  return quantity;
}

}  // namespace rouleau::study
