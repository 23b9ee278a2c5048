#include "conversions.hpp"

#include <array>
#include <cmath>

#include "base/text.hpp"
#include "flow.hpp"
#include "scene/lattice.hpp"
#include "shape/extent.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::plan {

namespace {

/// The rows of one stage.
class Rows {
 public:
  Rows(const scene::StageSetting& stage, std::vector<Conversion>& table) : stage_(stage), table_(table) {}
  void add(const std::string& quantity, double si, const std::string& unit, double lattice,
           const std::string& of = {}) {
    table_.push_back({stage_.stage->name, quantity, of, si, unit, lattice});
  }
  void convert(const std::string& quantity, double si, const std::string& unit, const units::Dimension& dimension,
               const std::string& of = {}) {
    add(quantity, si, unit, stage_.units.to_lattice(si, dimension), of);
  }

 private:
  const scene::StageSetting& stage_;
  std::vector<Conversion>& table_;
};

void add_fluid(const scene::Scene& scene, const scene::StageSetting& stage, Rows& rows) {
  const units::LatticeUnits& u = stage.units;
  rows.add("spacing", u.length, "m", 1);
  rows.add("time step", u.time, "s", 1);
  rows.add("density (times density_factor)", scene.fluid.density * stage.stage->density_factor, "kg/m3", 1);
  rows.convert("viscosity", scene.fluid.viscosity, "Pa s", units::dimension::viscosity);
  for (const scene::FluidLayer& layer : scene.fluid.layers) {
    rows.convert("viscosity", layer.viscosity, "Pa s", units::dimension::viscosity,
                 "the layer from " + number(layer.from * 1e6, 4) + " um to " + number(layer.to * 1e6, 4) + " um");
  }
  if (stage.stage->shear_rate != 0) rows.add("shear rate", stage.stage->shear_rate, "1/s", stage.shear_rate);
}

void add_drive(const scene::Scene& scene, const scene::StageSetting& stage, Rows& rows) {
  const units::LatticeUnits& u = stage.units;
  const auto wall = [&](const char* quantity, double speed) {
    rows.add(quantity, u.to_si(speed, units::dimension::velocity), "m/s", speed);
  };
  if (stage.stage->mean_wall_speed != 0) {
    wall("lower wall's speed", stage.walls.lower);
    wall("upper wall's speed", stage.walls.upper);
  } else if (stage.shear_rate != 0) {
    wall("wall speed", stage.walls.upper);
  }
  if (stage.stage->mean_velocity)
    rows.convert("mean velocity", *stage.stage->mean_velocity, "m/s", units::dimension::velocity);
  if (stage.openings) {
    const double inlet = stage.openings->front().value;
    if (stage.openings->front().kind == core::Opening::Kind::velocity) {
      rows.add("mean velocity at the inlet", u.to_si(inlet, units::dimension::velocity), "m/s", inlet);
    } else {
      rows.add("pressure at the inlet, above that at the outlet", u.to_si(inlet, units::dimension::pressure), "Pa",
               inlet);
    }
    const double speed = std::abs(fastest_driven_speed(stage, scene));
    rows.add("largest speed of the flow, about", u.to_si(speed, units::dimension::velocity), "m/s", speed);
  }
  const scene::Vector& force = stage.body_force;
  for (int axis = 0; axis < force.dimension(); ++axis) {
    if (force[axis] == 0) continue;
    const bool of_openings = stage.openings && axis == scene.domain.open_axis;
    const std::string along = axis == 0 || of_openings ? "" : std::string(" along ") + scene::axis_names[axis];
    rows.add((of_openings ? "force density that the openings amount to" : "driving force density") + along +
                 (axis == 0 && stage.stage->mean_velocity ? ", without cells" : ""),
             u.to_si(force[axis], units::dimension::force_density), "N/m3", force[axis]);
  }
  if (stage.oscillation.any()) {
    if (stage.stage->oscillates())
      rows.convert("frequency of the oscillation", stage.stage->oscillation.frequency, "Hz", units::dimension::rate);
    if (stage.oscillating_rate != 0)
      rows.convert("amplitude of the shear rate", stage.stage->oscillation.shear_rate, "1/s", units::dimension::rate);
    if (stage.stage->oscillation.mean_wall_speed != 0) {
      wall("amplitude of the lower wall's speed", stage.oscillation.walls.lower);
      wall("amplitude of the upper wall's speed", stage.oscillation.walls.upper);
    }
    if (stage.oscillation.body_force_x != 0) {
      rows.convert("amplitude of the driving force density", stage.stage->oscillation.pressure_gradient, "N/m3",
                   units::dimension::force_density);
    }
  }
}

/// Where openings are, or walls of any shape.
void add_open_ends(const scene::Scene& scene, Rows& rows) {
  const scene::Domain& domain = scene.domain;
  if (domain.has_shapes() ? domain.passages == nullptr : !domain.openings) return;
  const double unit = std::pow(scene::lattice_spacing(scene), domain.dimension() - 1);
  for (const int end : {0, 1}) {
    const double open =
        domain.has_shapes() ? domain.passages->open[end] : domain.content() / domain.size[domain.flow_axis()];
    const std::string name = !domain.openings ? "" : end == 0 ? ", the inlet" : ", the outlet";
    rows.add(std::string("open at the ") + (end == 0 ? "lower" : "upper") + " end along " +
                 scene::axis_names[domain.flow_axis()] + name,
             open, domain.in_plane() ? "m" : "m2", open / unit);
    const std::vector<scene::OpenPart> parts = scene::open_parts(scene, end);
    int number = 0;
    for (const scene::OpenPart& part : parts.size() > 1 ? parts : std::vector<scene::OpenPart>())
      rows.add((!domain.openings ? end == 0 ? "lower opening " : "upper opening "
                : end == 0       ? "inlet "
                                 : "outlet ") +
                   std::to_string(++number) + ", around (" + scene::by_axes(part.at, 1e6, 4, " um", ", ") + ")",
               part.area, domain.in_plane() ? "m" : "m2", part.area / unit);
  }
}

void add_lengths(const scene::Scene& scene, Rows& rows) {
  for (int axis = 0; axis < scene.domain.dimension(); ++axis)
    rows.convert(std::array{"width of the domain", "height of the domain", "depth of the domain"}[axis],
                 scene.domain.size[axis], "m", units::dimension::length);
  if (scene.domain.tube_radius)
    rows.convert("radius of the tube", *scene.domain.tube_radius, "m", units::dimension::length);
  add_open_ends(scene, rows);
  if (const scene::Domain& domain = scene.domain; domain.has_shapes()) {
    const auto share = domain.content() / domain.size.product();
    rows.add("share of the domain that is fluid", share, "1", share);
    rows.convert("widest place between the walls", domain.region_width, "m", units::dimension::length);
    if (domain.passages && std::isfinite(domain.passages->narrowest))
      rows.convert("narrowest passage", domain.passages->narrowest * scene::lattice_spacing(scene), "m",
                   units::dimension::length);
  }
  for (const scene::CellType& type : scene.cell_types) {
    rows.convert("radius", shape::shape_radius(type.shape), "m", units::dimension::length, type.name);
    rows.convert("interior viscosity", type.interior_viscosity, "Pa s", units::dimension::viscosity, type.name);
  }
}

void add_parameters(const Models& models, const units::LatticeUnits& u, Rows& rows) {
  const units::Units units;
  for (const PlannedModel* model : models.active_models()) {
    const std::string owner = models.owner_of(*model);
    for (std::size_t i = 0; i < model->manifest->parameters.size(); ++i) {
      const plugin::Parameter& parameter = model->manifest->parameters[i];
      if (!parameter.choices.empty()) continue;
      const auto& e = parameter.dimension.exponent;
      const bool stays_si = e[3] != 0 || e[4] != 0 || e[5] != 0;
      const double si = model->parameters.values[i];
      const bool in_si = units.scale(parameter.unit) == 1;
      rows.add(model->manifest->id + ": " + parameter.name, si, in_si ? parameter.unit : "SI for " + parameter.unit,
               stays_si ? si : u.to_lattice(si, parameter.dimension), owner);
    }
  }
}

}  // namespace

std::vector<Conversion> conversion_table(const Models& models) {
  std::vector<Conversion> table;
  for (const scene::StageSetting& stage : models.stages) {
    Rows rows(stage, table);
    add_fluid(*models.scene, stage, rows);
    add_drive(*models.scene, stage, rows);
    add_lengths(*models.scene, rows);
    add_parameters(models, stage.units, rows);
  }
  return table;
}

}  // namespace rouleau::plan
