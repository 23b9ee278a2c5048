// Stages of a scene, and what is written when.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/text.hpp"
#include "driving_flow.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::scene {
namespace {

void check_mean_velocity(const SceneFields& fields, const Stage& stage, const Scene& scene) {
  if (!stage.mean_velocity) return;
  const std::string key = stage.pointer + "/mean_velocity";
  if (fields.has(stage.pointer + "/pressure_gradient"))
    fields.refuse_key(key, "the pressure gradient is what keeps the mean velocity; leave one of the two out");
  if (walls_move(stage))
    fields.refuse_key(key, "a mean velocity is kept between walls at rest; leave it out, or shear_rate and walls");
  if (scene.domain.periodic[1] && !scene.domain.has_shapes()) {
    fields.refuse_key(
        key,
        "a mean velocity is kept against walls, but domain.y is \"periodic\"\n"
        "write \"y\": {\"lower\": {\"wall\": {}}, \"upper\": {\"wall\": {}}}, or leave out mean_velocity");
  }
  if (*stage.mean_velocity == 0)
    fields.refuse(key, "a mean velocity of 0 drives nothing; leave it out for a stage at rest");
}

/// Faults that the schema cannot see because they lie between the keys of a stage.
void check_stage(const SceneFields& fields, const Stage& stage, const Scene& scene) {
  const auto& pointer = stage.pointer;
  const bool flows = scene.domain.is_open() || scene.domain.shape_speed > 0 || walls_move(stage) ||
                     stage.pressure_gradient.x() != 0.0 || stage.mean_velocity || stage.changes();
  if (fields.has(pointer + "/walls") && fields.has(pointer + "/shear_rate"))
    fields.refuse_key(pointer + "/walls", "walls and shear_rate both say how the walls move; leave one of them out");
  for (const char* key : {"shear_rate", "walls"}) {
    if (!fields.has(pointer + "/" + key)) continue;
    if (scene.domain.tube_radius || scene.domain.has_shapes()) {
      fields.refuse_key(pointer + "/" + key,
                        std::string(scene.domain.tube_radius ? "the wall of a tube does not move"
                                                             : "walls do not move where others are of any shape") +
                            "\ngive pressure_gradient or mean_velocity in place of " + key);
    }
    if (scene.domain.walled(1)) continue;
    fields.refuse_key(pointer + "/" + key,
                      std::string("shear needs walls that move, but domain.y is ") +
                          (scene.domain.periodic[1] ? "\"periodic\"" : "open") +
                          "\nwrite \"y\": {\"lower\": {\"wall\": {}}, \"upper\": {\"wall\": {}}}, or leave out " +
                          std::string(key));
  }
  check_mean_velocity(fields, stage, scene);
  if (fields.has(pointer + "/start") && !flows) {
    fields.refuse_key(pointer + "/start",
                      "start says how a flow begins, but this stage has neither shear_rate, walls that move, "
                      "pressure_gradient nor mean_velocity");
  }
  if (stage.start == WallStart::developed && stage.oscillates() && !scene.fluid.layers.empty()) {
    fields.refuse(
        pointer + "/start",
        "the flow that an oscillation settles to is not known in a fluid with layers\nleave start out, and let "
        "some periods pass");
  }
  if (stage.strain && stage.changes()) {
    fields.refuse_key(pointer + "/strain", "strain does not grow evenly in a flow that " +
                                               std::string(stage.oscillates() ? "oscillates" : "a ramp changes") +
                                               "; end the stage by duration");
  }
  if (stage.oscillation.ramp && !stage.duration)
    fields.refuse(pointer, "a ramp lasts as long as its stage\ngive the stage a duration (such as \"2 s\")");
  if (stage.oscillation.ramp && stage.start == WallStart::developed) {
    fields.refuse(
        pointer + "/start",
        "a flow that a ramp changes is not developed\nlet a stage at the ramp's first value go before, or leave "
        "start out");
  }
  if (stage.strain && stage.mean_wall_speed != 0 && stage.shear_rate == 0) {
    fields.refuse_key(pointer + "/strain",
                      "both walls move at the same speed, so that nothing is sheared and strain never grows; "
                      "give them different speeds, or end the stage by duration");
  }
  if (stage.strain && stage.shear_rate == 0) {
    fields.refuse_key(pointer + "/strain",
                      "strain grows only where walls move, and this stage has no shear_rate; "
                      "give one, or end the stage by duration");
  }
  check_until(fields, stage, scene, flows);
  if (!stage.duration && !stage.strain) {
    fields.refuse(pointer, "this stage never ends; give duration (such as \"2 s\")" +
                               std::string(stage.shears_steadily() ? " or strain (such as 15)" : ""));
  }
}

/// Speeds of both walls, as shear rate and mean: of a stage, or of what oscillates in it.
template <class Drive>
void read_walls(const SceneFields& fields, const std::string& pointer, double height, Drive& drive) {
  const double lower = fields.quantity(pointer + "/lower", "m/s", range::velocity),
               upper = fields.quantity(pointer + "/upper", "m/s", range::velocity);
  drive.mean_wall_speed = (lower + upper) / 2;
  // Equal speeds that are written in different units differ by rounding.
  const double difference = upper - lower;
  drive.shear_rate =
      std::abs(difference) > 1e-12 * std::max(std::abs(lower), std::abs(upper)) ? difference / height : 0.0;
}

/// A value, or a ramp from one to another: then their mean, and half of what it rises by.
double read_drive(const SceneFields& fields, const std::string& pointer, const char* unit, AllowedRange range,
                  Stage& stage, double& half_rise) {
  if (!fields.has(pointer) || !fields.at(pointer).is_object()) return fields.quantity_or(pointer, unit, range, 0.0);
  const double from = fields.quantity(pointer + "/from", unit, range),
               to = fields.quantity(pointer + "/to", unit, range);
  if (from == to) fields.refuse(pointer, "a ramp between equal values changes nothing; give the value alone");
  stage.oscillation.ramp = true;
  half_rise = (to - from) / 2;
  return (from + to) / 2;
}

/// The amplitude is of that which drives the stage, in its unit and form.
Oscillation read_oscillation(const SceneFields& fields, const std::string& stage, double height) {
  const std::string pointer = stage + "/oscillation", amplitude = pointer + "/amplitude";
  std::vector<std::string> driven;
  for (const char* key : {"shear_rate", "walls", "pressure_gradient"})
    if (fields.has(stage + "/" + key)) driven.emplace_back(key);
  if (driven.empty()) {
    fields.refuse_key(pointer,
                      "an oscillation is added to what drives the stage, and nothing does\n"
                      "give shear_rate, walls or pressure_gradient, which may be 0: the oscillation is around it (a "
                      "mean_velocity is kept, and does not oscillate)");
  }
  if (driven.size() > 1) {
    fields.refuse_key(pointer, "this stage has both " + driven[0] + " and " + driven[1] +
                                   ", and an oscillation is of one of them; leave the other out");
  }
  if (fields.at(stage + "/" + driven[0]).contains("from"))
    fields.refuse_key(pointer, "a ramp does not oscillate at the same time; leave one of the two out");
  Oscillation oscillation;
  oscillation.frequency = fields.quantity(pointer + "/frequency", "Hz", range::frequency);
  const bool of_walls = driven[0] == "walls";
  if (of_walls != fields.at(amplitude).is_object()) {
    fields.refuse(amplitude, of_walls ? "the amplitude is of the walls' speeds, so it has one for each wall\n"
                                        "write {\"lower\": \"0 mm/s\", \"upper\": \"1 mm/s\"}, for example"
                                      : "the amplitude is of " + driven[0] +
                                            ", so it is one quantity; those of two "
                                            "walls go with \"walls\"");
  }
  if (of_walls)
    read_walls(fields, amplitude, height, oscillation);
  else if (driven[0] == "shear_rate")
    oscillation.shear_rate = fields.quantity(amplitude, "1/s", range::shear_rate);
  else
    oscillation.pressure_gradient = fields.quantity(amplitude, "Pa/m", range::force_density);
  if (oscillation.shear_rate == 0 && oscillation.mean_wall_speed == 0 && oscillation.pressure_gradient == 0)
    fields.refuse(amplitude, "an amplitude of 0 oscillates nothing; leave oscillation out");
  return oscillation;
}

/// `former`: that of the stage before at the same place of its list, or null.
CellForce read_force(const SceneFields& fields, const std::string& pointer, const Stage& stage, int dimension,
                     const CellForce* former) {
  CellForce force;
  force.pointer = pointer;
  const std::string toward = pointer + "/patch/toward", ramp = pointer + "/ramp";
  force.cells = fields.value_or(pointer + "/cells", std::vector<int>{});
  std::sort(force.cells.begin(), force.cells.end());
  force.share = fields.value_or(pointer + "/patch/share", 1.0);
  force.force = fields.vector(pointer + "/force", std::array{"N/m", "N"}[dimension - 2], range::force, dimension);
  if (fields.has(toward)) {
    force.toward = fields.vector(toward, "1", range::component, dimension);
    if (!(force.toward.norm() > 0)) fields.refuse(toward, "this has no direction\ngive numbers that are not all 0");
    force.toward *= 1 / force.toward.norm();
  }
  const bool same = former != nullptr && former->cells == force.cells && former->toward == force.toward &&
                    former->share == force.share;
  force.before = same ? former->force : Vector::filled(dimension, 0);
  if (!fields.has(ramp)) return force;
  force.ramp = fields.quantity(ramp, "s", range::time);
  const double strained = stage.strain ? *stage.strain / std::abs(stage.shear_rate) : INFINITY;
  if (stage.may_end_early() || force.ramp > std::min(stage.duration.value_or(INFINITY), strained) * (1 + 1e-9))
    fields.refuse(
        ramp,
        "this stage may end before the force has come to its value\ngive a shorter ramp, or let another stage "
        "follow that has the same force");
  return force;
}

void read_forces(const SceneFields& fields, Stage& stage, int dimension, const Stage* former) {
  const std::string pointer = stage.pointer + "/forces";
  const std::size_t count = fields.has(pointer) ? fields.count(pointer) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const CellForce* const before = former != nullptr && i < former->forces.size() ? &former->forces[i] : nullptr;
    fields.attempt(
        [&] { stage.forces.push_back(read_force(fields, json::child_pointer(pointer, i), stage, dimension, before)); });
  }
}

void read_strengths(const SceneFields& fields, Stage& stage, std::size_t interactions) {
  const std::string pointer = stage.pointer + "/interactions";
  if (!fields.has(pointer)) return;
  if (fields.count(pointer) != interactions && fields.settled("/interactions"))
    fields.refuse(pointer, "this has " + std::to_string(fields.count(pointer)) + " entries, and the scene has " +
                               std::to_string(interactions) +
                               " interactions\ngive one for each, in their order; {} leaves one as it is");
  for (std::size_t i = 0; i < fields.count(pointer); ++i) {
    Strength& strength = stage.strengths.emplace_back();
    const std::string key = json::child_pointer(pointer, i) + "/strength";
    if (!fields.has(key)) continue;
    const nlohmann::json& value = fields.at(key);
    strength.steps = value.contains("steps");
    if (value.is_number())
      strength.values = {value.get<double>()};
    else if (strength.steps)
      strength.values = value.at("steps").get<std::vector<double>>();
    else
      strength.values = {value.at("from").get<double>(), value.at("to").get<double>()};
    if (!value.is_number() && !stage.duration)
      fields.refuse(key, "ramps and steps last as long as their stage\ngive the stage a duration (such as \"2 s\")");
    if (!value.is_number() && stage.until_equilibrium)
      fields.refuse(key,
                    "what changes an interaction puts energy in, so that there is no equilibrium\nend the stage by "
                    "duration");
  }
}

void read_until(const SceneFields& fields, const std::string& pointer, Stage& stage) {
  const nlohmann::json& until = fields.at(pointer);
  if (until.is_object()) {
    stage.until_mean = until.begin().key();
    stage.until_standard_error =
        fields.value<double>(json::child_pointer(pointer, stage.until_mean) + "/standard_error");
    return;
  }
  stage.until_at_rest = until == "at_rest";
  stage.until_equilibrium = until == "equilibrium";
  stage.until_parted = until == "parted";
}

Stage read_stage(const SceneFields& fields, const std::string& pointer, const Scene& scene) {
  Stage stage;
  stage.pointer = pointer;
  fields.attempt([&] {
    stage.name = fields.line(pointer + "/name");
    if (!stage.name.empty() && std::string_view("=+-@").find(stage.name.front()) != std::string_view::npos)
      fields.refuse(pointer + "/name", in_quotes(stage.name) +
                                           " would be a formula where a spreadsheet opens the tables; begin it with a "
                                           "letter or digit");
  });
  if (fields.has(pointer + "/duration")) stage.duration = fields.quantity(pointer + "/duration", "s", range::time);
  fields.attempt([&] {
    if (fields.has(pointer + "/strain")) stage.strain = fields.value<double>(pointer + "/strain");
  });
  if (fields.has(pointer + "/until")) fields.attempt([&] { read_until(fields, pointer + "/until", stage); });
  fields.attempt([&] {
    stage.shear_rate =
        read_drive(fields, pointer + "/shear_rate", "1/s", range::shear_rate, stage, stage.oscillation.shear_rate);
  });
  if (fields.has(pointer + "/walls")) read_walls(fields, pointer + "/walls", scene.domain.size.y(), stage);
  stage.start = fields.value_or(pointer + "/start", std::string("impulsive")) == "developed" ? WallStart::developed
                                                                                             : WallStart::impulsive;
  fields.attempt([&] {
    stage.pressure_gradient.x() = read_drive(fields, pointer + "/pressure_gradient", "Pa/m", range::force_density,
                                             stage, stage.oscillation.pressure_gradient);
  });
  if (fields.has(pointer + "/mean_velocity"))
    stage.mean_velocity = fields.quantity(pointer + "/mean_velocity", "m/s", range::velocity);
  fields.attempt([&] {
    if (fields.has(pointer + "/oscillation"))
      stage.oscillation = read_oscillation(fields, pointer, scene.domain.size.y());
  });
  stage.density_factor = fields.value_or(pointer + "/density_factor", scene.numerics.density_factor);
  if (fields.has(pointer + "/density_factor")) stage.density_factor_key = pointer + "/density_factor";
  fields.attempt([&] {
    if (fields.settled(pointer)) check_stage(fields, stage, scene);
  });
  return stage;
}

Cadence read_cadence(const SceneFields& fields, const std::string& pointer, const std::vector<Stage>& stages) {
  Cadence cadence;
  if (!fields.has(pointer)) return cadence;
  fields.attempt([&] {
    if (fields.has(pointer + "/strain")) cadence.strain = fields.value<double>(pointer + "/strain");
  });
  if (fields.has(pointer + "/seconds")) cadence.seconds = fields.quantity(pointer + "/seconds", "s", range::time);
  if (!fields.settled(pointer)) return cadence;
  if (cadence.never()) {
    fields.refuse(pointer,
                  json::subject(pointer) + " does not say when: give strain (such as 0.25) or seconds (such as 0.1)");
  }
  const bool shears =
      std::any_of(stages.begin(), stages.end(), [](const Stage& stage) { return stage.shears_steadily(); });
  if (cadence.strain && !cadence.seconds && !shears && fields.settled("/stages")) {
    fields.refuse_key(
        pointer + "/strain",
        "no stage has a shear_rate that is steady, so strain does not grow evenly and this output never comes due; use "
        "seconds");
  }
  return cadence;
}

std::string micrometres(double length) { return number(length * 1e6, 6) + " um"; }

/// The nodes of a region along one axis; node i lies at (i + 1/2) spacings.
std::array<int, 2> nodes_within(const SceneFields& fields, const Domain& domain, int axis, double from, double to) {
  const std::string pointer = "/output/fields/region", along = std::string(" along ") + axis_names[axis];
  const std::string end = json::child_pointer(pointer + "/to", static_cast<std::size_t>(axis));
  const double size = domain.size[axis], spacing = size / domain.nodes[axis];
  constexpr double rounding = 1e-9;  // a border that is meant to lie on a node shall include it
  if (from < -rounding * size)
    fields.refuse(json::child_pointer(pointer + "/from", static_cast<std::size_t>(axis)),
                  "the region begins at " + micrometres(from) + along + ", outside the domain, which begins at 0");
  if (to > size * (1 + rounding))
    fields.refuse(end, "the region ends at " + micrometres(to) + along + ", outside the domain, which ends at " +
                           micrometres(size));
  if (!(from < to))
    fields.refuse(end, "the region ends at " + micrometres(to) + along + " and begins at " + micrometres(from) +
                           "; \"from\" is the lower corner and \"to\" the upper one");
  const int first = static_cast<int>(std::ceil(units::place_on_lattice(from, spacing) - rounding));
  const int last = static_cast<int>(std::floor(units::place_on_lattice(to, spacing) + rounding));
  if (first > last)
    fields.refuse(pointer, "no lattice node lies between " + micrometres(from) + " and " + micrometres(to) + along +
                               ": they lie " + micrometres(spacing) + " apart, the nearest at " +
                               micrometres(units::coordinate(last, spacing)) + "; make the region larger");
  return {first, last};
}

}  // namespace

std::vector<Stage> read_stages(const SceneFields& fields, const Scene& scene) {
  std::vector<Stage> stages;
  const std::size_t count = fields.count("/stages");
  for (std::size_t i = 0; i < count; ++i) {
    const auto stage = read_stage(fields, json::child_pointer("/stages", i), scene);
    const bool again =
        std::any_of(stages.begin(), stages.end(), [&](const Stage& earlier) { return earlier.name == stage.name; });
    stages.push_back(stage);
    fields.attempt(
        [&] { read_forces(fields, stages.back(), scene.domain.dimension(), i > 0 ? &stages[i - 1] : nullptr); });
    fields.attempt([&] { read_strengths(fields, stages.back(), scene.interactions.size()); });
    fields.attempt([&] {
      if (!again || stage.name.empty()) return;
      fields.refuse(stage.pointer + "/name",
                    "two stages are called " + in_quotes(stage.name) + "; give each its own name");
    });
  }
  return stages;
}

Output read_output(const SceneFields& fields, const std::vector<Stage>& stages, const Domain& domain) {
  Output output;
  fields.attempt([&] { output.cells = read_cadence(fields, "/output/cells", stages); });
  fields.attempt([&] { output.fields = read_cadence(fields, "/output/fields", stages); });
  output.quantities = fields.value_or("/output/fields/quantities", std::vector<std::string>{});
  if (output.wants("wall_shear_stress") && !domain.has_shapes() && !domain.tube_radius)
    fields.attempt([&] {
      fields.refuse(
          "/output/fields/quantities",
          "\"wall_shear_stress\" is that on walls of a shape, and the domain has none\nleave it out: of plane "
          "walls series.csv has the stress; or give domain.walls or domain.obstacles");
    });
  if (fields.has("/output/checkpoint/seconds"))
    output.checkpoint_seconds = fields.quantity("/output/checkpoint/seconds", "s", range::time);
  else if (fields.has("/output/checkpoint"))
    output.checkpoint_seconds.reset();  // "never"
  output.aggregate_gap = fields.quantity_or("/output/aggregate_gap", "m", range::length, output.aggregate_gap);
  fields.attempt([&] {
    if (!fields.has("/output/profiles")) return;
    output.profiles = {fields.at("/output/profiles/axis") == "r", fields.value_or("/output/profiles/bins", 20)};
    if (const char axis = axis_names[domain.flow_axis()]; axis != 'x')
      fields.refuse("/output/profiles", std::string("profiles are of the velocity along x, and openings make the fluid "
                                                    "flow along ") +
                                            axis + "\nput the openings at the ends of x, or leave output.profiles out");
    if (output.profiles->radial != domain.tube_radius.has_value() || domain.has_shapes())
      fields.refuse("/output/profiles/axis",
                    domain.has_shapes() ? "walls of other shapes have no profile\nleave output.profiles out"
                    : output.profiles->radial
                        ? "\"r\" is the distance from the axis of a tube, and the domain has none\ntake \"y\", or give "
                          "\"walls\": {\"tube\": ..}"
                        : "across a tube take \"r\", the distance from its axis");
    if (!fields.has("/output/cells"))
      fields.refuse("/output/profiles", "profiles are taken when cells are written\ngive output.cells");
  });
  output.bond_share = fields.value_or("/output/bond_share", output.bond_share);
  for (const Stage& stage : stages) {
    if (!fields.has("/output/cells") && (stage.until_parted || !stage.until_mean.empty()))
      fields.attempt([&] {
        fields.refuse(stage.pointer + "/until",
                      "outputs end such a stage, and no cells are written\ngive output.cells");
      });
  }
  return output;
}

int FieldStorage::count(int axis, int nodes) const {
  const auto a = static_cast<std::size_t>(axis);
  return ((last ? (*last)[a] : nodes - 1) - first[a]) / stride + 1;
}

FieldStorage read_field_storage(const SceneFields& fields, const Domain& domain) {
  FieldStorage storage;
  fields.attempt([&] {
    const std::string region = "/output/fields/region";
    if (!fields.has(region)) return;
    const Vector from = fields.place(region + "/from", domain, "corner"),
                 to = fields.place(region + "/to", domain, "corner");
    if (!fields.settled(region) || !is_known(domain)) return;
    storage.last.emplace();
    for (int axis = 0; axis < domain.dimension(); ++axis) {
      const auto [first, last] = nodes_within(fields, domain, axis, from[axis], to[axis]);
      storage.first[axis] = first;
      (*storage.last)[axis] = last;
    }
  });
  storage.stride = fields.value_or("/output/fields/stride", storage.stride);
  storage.compression = fields.value_or("/output/fields/compression", storage.compression);
  if (fields.value_or("/output/fields/precision", std::string("f32")) == "f64") storage.precision = Precision::f64;
  return storage;
}

}  // namespace rouleau::scene
