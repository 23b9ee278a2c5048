#include "read_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/text.hpp"
#include "driving_flow.hpp"
#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "json/schema.hpp"
#include "named_files.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

constexpr std::int64_t most_membrane_nodes = 2'000'000'000;
/// How far the spacings along x and y may differ: far above rounding of the text's digits, far below any effect.
constexpr double spacing_tolerance = 1e-9;
/// In the radius of a tube: below this there is hardly a node between its walls.
constexpr double fewest_spacings = 2;

std::string in_micrometres(double metres) { return '"' + number(metres * 1e6, 12) + " um\""; }

/// Says how to make the spacing the same along both directions, by size always and by nodes where a whole number does.
std::string spacing_remedy(const Domain& domain) {
  const double spacing = domain.size.x() / domain.nodes[0], nodes = domain.size.y() / spacing;
  std::string remedy =
      "write size [" + in_micrometres(domain.size.x()) + ", " + in_micrometres(spacing * domain.nodes[1]) + ']';
  if (std::abs(nodes - std::round(nodes)) < spacing_tolerance * nodes && nodes > 3.5 &&
      nodes < most_nodes_of_side + 0.5)
    remedy += " or nodes [" + std::to_string(domain.nodes[0]) + ", " + number(std::round(nodes), 12) + ']';
  return remedy;
}

/// What is at both ends along an axis.
void read_ends(const SceneFields& fields, Domain& domain, int axis) {
  const std::string key = std::string("/domain/") + axis_names[axis];
  if (!fields.has(key)) return;
  if (axis >= domain.dimension())
    fields.refuse_key(key, "there is no z in two dimensions\ngive size and nodes three numbers, or leave z out");
  const auto ends = fields.value<nlohmann::json>(key);
  const bool inlet = fields.has(key + "/lower/inlet"), outlet = fields.has(key + "/upper/outlet");
  domain.periodic[axis] = axis == 0 ? !ends.is_object() : ends.is_string();
  if (inlet != outlet && axis > 0)
    fields.refuse(key, "an inlet below goes with an outlet above\ngive both ends walls, or an inlet and an outlet");
  if (domain.periodic[axis] || !(axis == 0 || inlet)) return;
  if (domain.is_open())
    fields.refuse(key, std::string("the domain is open along ") + axis_names[domain.open_axis] +
                           " already, and one axis may be\nlet this be \"periodic\"" + (axis > 0 ? ", or walls" : ""));
  domain.open_axis = axis;
}

/// As many as there are sides.
std::vector<int> read_nodes(const SceneFields& fields, const Domain& domain) {
  fields.require("/domain", "nodes", "or \"numerics\": \"auto\" chooses them");
  auto nodes = fields.value<std::vector<int>>("/domain/nodes");
  const int count = static_cast<int>(nodes.size());
  if (count == domain.dimension()) return nodes;
  fields.refuse("/domain/nodes", std::string(count > domain.dimension() ? "nodes has three numbers and size two"
                                                                        : "size has three numbers and nodes two") +
                                     "\ngive both three, for three dimensions, or both two");
}

/// The radius of a tube, which closes y and z; none: planes do, or nothing.
std::optional<double> read_tube(const SceneFields& fields, const Domain& domain) {
  if (!fields.has("/domain/walls")) fields.require("/domain", "y", "\"periodic\" or walls, or \"walls\"");
  if (!fields.has("/domain/walls/tube")) return std::nullopt;
  if (domain.in_plane()) {
    fields.refuse_key("/domain/walls/tube",
                      "a tube has three dimensions, and this domain two\ngive size and nodes three numbers, or leave "
                      "walls out and close y");
  }
  for (const char* key : {"/domain/y", "/domain/z"})
    if (fields.has(key)) fields.refuse_key(key, "the tube closes y and z; leave this out, or the tube");
  const std::string key = "/domain/walls/tube/radius";
  if (domain.node_count() > static_cast<double>(most_nodes_of_block))  // every rank has a mark for each node
    fields.refuse("/domain/nodes", number(domain.node_count(), 12) + " nodes are too many around a tube; at most " +
                                       std::to_string(most_nodes_of_block) + " can be computed");
  const double radius = fields.quantity(key, "m", range::length);
  if (!is_known(domain) || !std::isfinite(radius)) return radius;
  const double most = std::min(domain.size.y(), domain.size.z()) / 2, spacing = domain.size.y() / domain.nodes[1];
  if (radius > most * (1 + spacing_tolerance)) {
    fields.refuse(key, "a tube with a radius of " + in_micrometres(radius) +
                           " does not fit into the domain\ngive at most " + in_micrometres(most) +
                           ", or make the domain larger along y and z");
  }
  if (radius < fewest_spacings * spacing) {
    fields.refuse(key, "the tube's radius of " + in_micrometres(radius) + " is " + number(radius / spacing, 3) +
                           " lattice spacings, which is no tube\ngive more nodes: at least " + number(fewest_spacings) +
                           " spacings, and better 10");
  }
  return radius;
}

/// What is there between plane walls only, so far.
void check_duct(const SceneFields& fields, const Scene& scene) {
  const bool shapes = scene.domain.has_shapes();
  const std::string walls = shapes                     ? "between walls of any shape"
                            : scene.domain.tube_radius ? "in a tube"
                                                       : "in a duct";
  if ((shapes || scene.domain.tube_radius) && !scene.fluid.layers.empty()) {
    fields.attempt([&] {
      fields.refuse("/fluid/layers",
                    "layers lie along plane walls; there are none " + walls + "\nleave the layers out");
    });
  }
  for (const Stage& stage : scene.stages) {
    if (stage.start != WallStart::developed || scene.domain.is_open() || knows_developed_flow(stage, scene)) continue;
    const char* const unknown = stage.oscillates()            ? "an oscillation settles to"
                                : !scene.fluid.layers.empty() ? "layers settle to"
                                                              : "develops";
    fields.attempt([&] {
      fields.refuse(stage.pointer + "/start", std::string("the flow that ") + unknown + ' ' + walls +
                                                  " is not known\nleave start out, and let the flow come to be");
    });
  }
}

/// It has as many dimensions as its size has numbers, whatever is wrong with them.
void read_domain(const SceneFields& fields, Domain& domain) {
  const int dimension = fields.has("/domain/size/2") ? 3 : 2;
  domain.nodes.assign(dimension, 0);
  domain.size = Vector::filled(dimension, std::numeric_limits<double>::quiet_NaN());
  domain.size = fields.quantities("/domain/size", "m", range::length, dimension);
  for (const int axis : {0, 1, 2}) fields.attempt([&] { read_ends(fields, domain, axis); });
  fields.attempt([&] {
    domain.nodes = read_nodes(fields, domain);
    if (domain.node_count() > static_cast<double>(most_nodes))
      fields.refuse("/domain/nodes", by_axes(domain.nodes) + " nodes are too many; at most " +
                                         std::to_string(most_nodes) + " can be computed");
    const double rows = domain.node_count() / domain.nodes[0];
    if (rows > static_cast<double>(most_rows))
      fields.refuse("/domain/nodes", number(rows, 12) + " rows of nodes along x are too many; at most " +
                                         std::to_string(most_rows) + " can be computed");
  });
  fields.attempt([&] {
    if (!is_known(domain)) return;
    const double along_x = domain.size.x() / domain.nodes[0], along_y = domain.size.y() / domain.nodes[1];
    if (std::abs(along_x - along_y) > spacing_tolerance * along_x) {
      fields.refuse("/domain/size", "the lattice spacing would be " + number(along_x * 1e6) + " um along x but " +
                                        number(along_y * 1e6) + " um along y; it must be the same along both\n" +
                                        spacing_remedy(domain));
    }
    for (int axis = 2; axis < domain.dimension(); ++axis) {
      const double along_z = domain.size[axis] / domain.nodes[axis];
      if (std::abs(along_x - along_z) <= spacing_tolerance * along_x) continue;
      fields.refuse("/domain/size/2", "the lattice spacing would be " + number(along_x * 1e6) + " um along x but " +
                                          number(along_z * 1e6) +
                                          " um along z; it must be the same along all axes\nwrite " +
                                          in_micrometres(along_x * domain.nodes[axis]) + " here");
    }
  });
  fields.attempt([&] {
    domain.tube_radius = read_tube(fields, domain);
    if (domain.tube_radius) domain.periodic[2] = false;
  });
  read_wall_shapes(fields, domain);
  if (domain.tube_radius && domain.has_shapes()) {  // one among others
    domain.within = WallShape{WallShape::Cylinder{.axis = 0,
                                                  .center = {0.5 * domain.size[1], 0.5 * domain.size[2]},
                                                  .radius = *std::exchange(domain.tube_radius, {}),
                                                  .from = -std::numeric_limits<double>::infinity(),
                                                  .to = std::numeric_limits<double>::infinity()},
                              "/domain/walls/tube"};
  }
}

/// In order of height; refuses layers that lie beyond the domain or on top of each other.
std::vector<FluidLayer> read_layers(const SceneFields& fields, double height) {
  std::vector<FluidLayer> layers;
  const auto um = [](double metres) { return number(metres * 1e6) + " um"; };
  const double rounding = 1e-9 * height;
  const std::size_t count = fields.has("/fluid/layers") ? fields.count("/fluid/layers") : 0;
  for (std::size_t i = 0; i < count; ++i) {
    fields.attempt([&] {
      const auto pointer = json::child_pointer("/fluid/layers", i);
      FluidLayer layer{fields.quantity(pointer + "/from", "m", range::place),
                       fields.quantity(pointer + "/to", "m", range::place),
                       fields.quantity(pointer + "/viscosity", "Pa s", range::viscosity)};
      if (!std::isfinite(layer.from + layer.to + layer.viscosity + height)) throw Misread{};
      if (layer.from < -rounding || layer.to > height + rounding || !(layer.from < layer.to))
        fields.refuse(pointer,
                      "a layer from " + um(layer.from) + " to " + um(layer.to) +
                          (layer.from < layer.to ? " is not within the domain, which is " + um(height) + " high"
                                                 : " has no thickness; heights count from the lower wall upwards") +
                          "\ngive heights between 0 um and " + um(height) + ", \"from\" below \"to\"");
      layer.from = std::max(layer.from, 0.0);
      layer.to = std::min(layer.to, height);
      for (const FluidLayer& other : layers) {
        if (layer.from > other.to - rounding || layer.to < other.from + rounding) continue;
        fields.refuse(pointer, "this layer, from " + um(layer.from) + " to " + um(layer.to) +
                                   ", lies over the one from " + um(other.from) + " to " + um(other.to) +
                                   "\nlet one begin where the other ends");
      }
      layers.push_back(layer);
    });
  }
  std::sort(layers.begin(), layers.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  return layers;
}

FluidProperties read_fluid(const SceneFields& fields, const Domain& domain) {
  FluidProperties fluid;
  fluid.density = fields.quantity("/fluid/density", "kg/m3", range::density);
  fluid.viscosity = fields.quantity("/fluid/viscosity", "Pa s", range::viscosity);
  fluid.layers = read_layers(fields, domain.size.y());
  fluid.inertia = fields.value_or("/fluid/inertia", false);
  fields.attempt([&] {
    if (fields.has("/fluid/body_force"))
      fluid.body_force = fields.vector("/fluid/body_force", "N/m3", range::force_density, domain.dimension());
  });
  fields.attempt([&] {
    if (fields.has("/fluid/gravity"))
      fluid.gravity = fields.vector("/fluid/gravity", "m/s2", range::acceleration, domain.dimension());
  });
  fluid.collision = {"trt", nlohmann::json::object(), "/fluid/collision"};
  fields.attempt([&] {
    if (fields.has("/fluid/collision")) fluid.collision = fields.model("/fluid/collision");
  });
  return fluid;
}

Numerics read_numerics(const SceneFields& fields) {
  Numerics numerics;
  numerics.tau = fields.value_or("/numerics/tau", numerics.tau);
  numerics.density_factor = fields.value_or("/numerics/density_factor", numerics.density_factor);
  numerics.kernel = fields.value_or("/numerics/kernel", numerics.kernel);
  numerics.precision =
      fields.value_or("/numerics/precision", std::string("f64")) == "f32" ? Precision::f32 : Precision::f64;
  numerics.coupling = fields.value_or("/numerics/coupling", numerics.coupling);
  numerics.slip_correction = fields.value_or("/numerics/slip_correction", numerics.slip_correction);
  numerics.area_correction = fields.value_or("/numerics/area_correction", numerics.area_correction);
  return numerics;
}

/// What cells in layers cannot have; both know of one viscosity around a cell.
void check_layers(const SceneFields& fields, const Scene& scene) {
  if (scene.fluid.layers.empty() || (scene.cells.empty() && scene.packings.empty())) return;
  if (scene.numerics.slip_correction) {
    fields.refuse("/numerics/slip_correction",
                  "the slip correction knows of one viscosity around the cells, and fluid.layers has others\n"
                  "set it to false, or leave out layers or cells");
  }
  if (scene.numerics.coupling == "semi-implicit") {
    fields.refuse("/numerics/coupling",
                  "the semi-implicit step knows of one viscosity around the cells, and fluid.layers has others\n"
                  "take \"explicit\", or leave out layers or cells");
  }
}

std::array<int, 2> read_between(const SceneFields& fields, const std::string& pointer,
                                const std::vector<CellType>& types, const Domain& domain) {
  const auto side = [&](const std::string& which) {
    if (fields.at(pointer + which) == self_name) return Interaction::self;
    if (fields.at(pointer + which) != wall_name)
      return fields.cell_type(pointer + which, types, {wall_name, self_name});
    if (domain.walled(1) || domain.has_shapes()) return Interaction::wall;
    fields.refuse(pointer + which, std::string("there is no wall, for domain.y is ") +
                                       (domain.periodic[1] ? "\"periodic\"" : "open") +
                                       "\nwrite \"y\": {\"lower\": {\"wall\": {}}, "
                                       "\"upper\": {\"wall\": {}}}, or leave this interaction out");
  };
  int a = 0, b = 0;
  fields.attempt([&] { a = side("/0"); });
  fields.attempt([&] { b = side("/1"); });
  // That no cell type may be called so has been said.
  const bool is_type = std::any_of(types.begin(), types.end(), [](const CellType& type) {
    return type.name == wall_name || type.name == self_name;
  });
  if (a < 0 && b < 0 && !is_type) {
    fields.refuse(pointer, a == Interaction::wall && b == Interaction::wall
                               ? "walls do not act on each other\nname a cell type beside \"wall\""
                               : "\"self\" is a cell's own membrane\nname its cell type beside \"self\"");
  }
  return a < 0 ? std::array{b, a} : std::array{a, b};
}

std::vector<Interaction> read_interactions(const SceneFields& fields, const std::vector<CellType>& types,
                                           const Domain& domain) {
  std::vector<Interaction> interactions;
  const auto count = fields.has("/interactions") ? fields.count("/interactions") : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pointer = json::child_pointer("/interactions", i);
    auto& interaction = interactions.emplace_back();
    fields.attempt([&] { interaction.between = read_between(fields, pointer + "/between", types, domain); });
    fields.attempt([&] { interaction.potential = fields.model(pointer); });
  }
  return interactions;
}

Equilibrium read_equilibrium(const SceneFields& fields) {
  Equilibrium equilibrium;
  equilibrium.rate = fields.quantity_or("/equilibrium/rate", "1/s", range::rate, equilibrium.rate);
  equilibrium.window = fields.quantity_or("/equilibrium/window", "s", range::time, equilibrium.window);
  return equilibrium;
}

AtRest read_at_rest(const SceneFields& fields) {
  AtRest at_rest;
  at_rest.displacement = fields.quantity_or("/at_rest/displacement", "m", range::length, at_rest.displacement);
  at_rest.window = fields.quantity_or("/at_rest/window", "s", range::time, at_rest.window);
  return at_rest;
}

Checks read_checks(const SceneFields& fields) {
  Checks checks;
  checks.mach = fields.value_or("/checks/mach", checks.mach);
  checks.node_step = fields.value_or("/checks/node_step", checks.node_step);
  checks.area_drift = fields.value_or("/checks/area_drift", checks.area_drift);
  checks.stretch = fields.value_or("/checks/stretch", checks.stretch);
  checks.energy_growth = fields.value_or("/checks/energy_growth", checks.energy_growth);
  checks.every_steps = fields.value_or("/checks/every_steps", checks.every_steps);
  return checks;
}

std::vector<std::filesystem::path> read_plugin_dirs(const SceneFields& fields, const std::filesystem::path& beside) {
  std::vector<std::filesystem::path> folders;
  for (const auto& folder : fields.value_or("/plugin_dirs", std::vector<std::string>{})) {
    if (folder.find('\0') != std::string::npos)
      fields.refuse(json::child_pointer("/plugin_dirs", folders.size()), "a folder's name cannot hold a NUL character");
    folders.push_back(beside / folder);
  }
  return folders;
}

}  // namespace

void check_membrane_nodes(const Scene& scene) {
  std::int64_t nodes = 0;
  for (const auto& cell : scene.cells) {
    const CellType& type = scene.cell_types[cell.type];
    nodes += type.nodes();
  }
  if (nodes <= most_membrane_nodes) return;
  SceneFields(*scene.document)
      .refuse("/cells", "the cells have " + std::to_string(nodes) + " membrane nodes together; at most " +
                            std::to_string(most_membrane_nodes) + " can be computed: use fewer cells or segments");
}

json::Document read_document(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             Faults& faults) {
  auto document = json::Document::read(file);
  Faults of_overrides, passed;
  for (const bool of_from : {true, false}) {
    for (const auto& assignment : overrides)
      if (assignment.substr(0, assignment.find('=')).ends_with("/from") == of_from)
        of_overrides.attempt([&] { document.set(assignment); });
    if (of_from) take_shipped_cells(document, passed);  // others may change parts of what it gives
  }
  of_overrides.raise();  // what one of them was to mend is no fault of the scene
  take_shipped_cells(document, faults);
  json::judge(document, scene_schema(), faults);
  return document;
}

json::Document read_document(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Faults faults;
  auto document = read_document(file, overrides, faults);
  faults.raise();
  return document;
}

Scene read_scene(std::shared_ptr<const json::Document> document, Faults& faults) {
  Scene scene;
  SceneFields fields(*document, faults);
  const auto part = [&](const auto& read) { fields.attempt(read); };
  part([&] {
    if (fields.has("/title")) scene.title = fields.line("/title");
  });
  part([&] { read_domain(fields, scene.domain); });
  if (scene.domain.size.is_finite()) fields.bound_lengths(scene.domain.size);
  part([&] { scene.fluid = read_fluid(fields, scene.domain); });
  part([&] { scene.numerics = read_numerics(fields); });
  part([&] { scene.cell_types = read_cell_types(fields, scene.fluid, scene.domain); });
  part([&] { read_openings(fields, scene.cell_types, scene.domain); });
  part([&] { scene.cells = read_cells(fields, scene.cell_types, scene.domain, scene.packings); });
  part([&] { check_layers(fields, scene); });
  part([&] { scene.interactions = read_interactions(fields, scene.cell_types, scene.domain); });
  part([&] { scene.stages = read_stages(fields, scene); });
  part([&] { scene.output = read_output(fields, scene.stages, scene.domain); });
  part([&] { scene.output.field_storage = read_field_storage(fields, scene.domain); });
  part([&] { check_duct(fields, scene); });
  part([&] { check_openings(fields, scene); });
  part([&] { scene.at_rest = read_at_rest(fields); });
  part([&] { scene.equilibrium = read_equilibrium(fields); });
  part([&] { scene.checks = read_checks(fields); });
  part([&] { scene.plugin_dirs = read_plugin_dirs(fields, std::filesystem::path(document->file()).parent_path()); });
  scene.document = std::move(document);
  part([&] {
    if (faults.empty()) check_membrane_nodes(scene);
  });
  return scene;
}

Scene read_scene(std::shared_ptr<const json::Document> document) {
  Faults faults;
  Scene scene = read_scene(std::move(document), faults);
  faults.raise();
  return scene;
}

}  // namespace rouleau::scene
