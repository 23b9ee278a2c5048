// Cell types and where cells are placed.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/text.hpp"
#include "cell_rows.hpp"
#include "core/surface/triangle_surface.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

constexpr std::size_t most_types = 1000;

/// Names stand in columns of CSV files and in paths of HDF5 files.
bool is_plain_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || name.size() > 100 || !letter(name.front())) return false;
  for (const char c : name)
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '_' && c != '-' && c != '.') return false;
  return true;
}

/// Shapes of one dimension are refused in the other, with what stands for them there.
void check_shape(const SceneFields& fields, const std::string& pointer, int dimension) {
  const std::size_t own = dimension - 2, other = 3 - dimension;
  using Names = std::array<const char*, 2>;  // of what is alike in the plane and in space
  for (const Names& names : {Names{"circle", "sphere"}, Names{"ellipse", "ellipsoid"}, Names{"ellipse", "spheroid"},
                             Names{"biconcave", "mesh"}}) {
    const std::string wrong = names[other];
    if (wrong == "biconcave" || !fields.has(pointer + "/" + wrong)) continue;
    fields.refuse_key(pointer + "/" + wrong, in_quotes(wrong) + " is a shape of " + words_of(5 - dimension).number +
                                                 " dimensions, and the domain has " + words_of(dimension).number +
                                                 "\ntake " + in_quotes(names[own]));
  }
}

core::SurfaceContent content_in_space(const Shape& shape) {
  constexpr int n = 64;  // area and volume are right to 0.05 %
  if (const auto* disc = std::get_if<Biconcave>(&shape)) return content_of(core::biconcave_disc(n, disc->radius));
  if (const auto* solid = std::get_if<Ellipsoid>(&shape))
    return content_of(core::ellipsoid(n, solid->semi_axes.in<3>()));
  return content_of(core::ellipsoid(n, core::Vec<3>::Constant(std::get<Sphere>(shape).radius)));
}

/// Where the sizes come from that a shape does not say.
struct Missing {
  const Shape* other;    ///< has the area and volume; null: nothing has
  bool* size = nullptr;  ///< set where the size is not written, and is that of a sphere of radius 1; null: refused then
};

Ellipsoid read_spheroid(const SceneFields& fields, const std::string& pointer, const Missing& missing) {
  const std::string by_volume = pointer + "/volume", by_share = pointer + "/reduced_volume";
  const bool has_area = fields.has(pointer + "/area"), has_volume = fields.has(by_volume),
             has_share = fields.has(by_share);
  if (has_volume && has_share) fields.refuse_key(by_share, "leave out volume, or reduced_volume: one says the other");
  if (missing.other == nullptr &&
      ((!has_area && (missing.size == nullptr || has_volume)) || (!has_volume && !has_share)))
    fields.refuse(pointer, "this spheroid has no " + std::string(has_area ? "volume" : "area") +
                               "\ngive \"area\", such as \"135 um^2\", and \"volume\" or \"reduced_volume\"");
  if (missing.size != nullptr) *missing.size = !has_area;
  core::SurfaceContent content{4 * std::numbers::pi, 0};
  if (missing.other != nullptr) content = content_in_space(*missing.other);
  content.area = fields.quantity_or(pointer + "/area", "m2", range::area, content.area);
  content.volume = fields.quantity_or(by_volume, "m3", range::volume, content.volume);
  const double of_sphere = std::pow(content.area, 1.5) / (6 * std::sqrt(std::numbers::pi));
  if (has_share) content.volume = of_sphere * fields.value<double>(by_share);
  constexpr double flattest = 0.05, rounding = 1e-9;
  if (content.reduced_volume() > 1 + rounding || content.reduced_volume() < flattest)
    fields.refuse(has_volume ? by_volume : pointer,
                  "a spheroid of this area has between " + number(1e18 * flattest * of_sphere, 4) + " and " +
                      number(1e18 * of_sphere, 4) + " um3, and its volume is " + number(1e18 * content.volume, 4) +
                      " um3\ntake another volume, or another area");
  const core::Vec<3> axes =
      core::spheroid_axes(content, fields.value_or(pointer + "/kind", std::string()) == "prolate");
  return {Vector{axes.x(), axes.y(), axes.z()}, true};
}

/// Of a sphere or a circle.
double read_radius(const SceneFields& fields, const std::string& pointer, const Missing& missing) {
  if (missing.size == nullptr) fields.require(pointer, "radius", "such as \"3 um\"");
  if (missing.size != nullptr) *missing.size = !fields.has(pointer + "/radius");
  return fields.quantity_or(pointer + "/radius", "m", range::length, 1.0);
}

Shape read_shape(const SceneFields& fields, const std::string& pointer, int dimension, const Missing& missing) {
  check_shape(fields, pointer, dimension);
  if (fields.has(pointer + "/sphere")) {
    return Sphere{read_radius(fields, pointer + "/sphere", missing),
                  fields.value_or(pointer + "/sphere/prestretch", 1.0)};
  }
  if (fields.has(pointer + "/spheroid")) return read_spheroid(fields, pointer + "/spheroid", missing);
  if (fields.has(pointer + "/ellipsoid"))
    return Ellipsoid{fields.quantities(pointer + "/ellipsoid/semi_axes", "m", range::length, 3)};
  if (fields.has(pointer + "/mesh"))
    return MeshFile{fields.file(pointer + "/mesh/file"),
                    fields.quantity(pointer + "/mesh/unit", "m", range::unit_of_length)};
  if (fields.has(pointer + "/biconcave"))
    return Biconcave{fields.quantity(pointer + "/biconcave/radius", "m", range::length)};
  if (fields.has(pointer + "/circle")) {
    return Circle{read_radius(fields, pointer + "/circle", missing),
                  fields.value_or(pointer + "/circle/prestretch", 1.0)};
  }
  return Ellipse{fields.quantities(pointer + "/ellipse/semi_axes", "m", range::length, 2)};
}

/// Both shapes of a type.
void read_shapes(const SceneFields& fields, const std::string& pointer, int dimension, CellType& type) {
  const std::string free = pointer + "/stress_free";
  const Shape* other = nullptr;
  if (fields.has(free)) {
    for (const std::string& round :
         {pointer + "/shape/sphere", pointer + "/shape/circle", free + "/sphere", free + "/circle"}) {
      if (fields.has(round + "/prestretch"))
        fields.refuse_key(round + "/prestretch",
                          "\"stress_free\" says how far the membrane is stretched\nleave this out");
    }
    bool open = false;
    const Shape shape = read_shape(fields, free, dimension, {nullptr, &open});
    type.stress_free = {shape, !open, free};
    if (dimension == 3 && !open && !std::holds_alternative<MeshFile>(shape)) other = &type.stress_free->shape;
  }
  type.shape = read_shape(fields, pointer + "/shape", dimension, {other});
}

/// Of the shape's surface, m2; of a mesh 0.
double surface_area(const Shape& shape) {
  if (const auto* disc = std::get_if<Biconcave>(&shape)) return 8.83 * disc->radius * disc->radius;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return 4 * std::numbers::pi * sphere->radius * sphere->radius;
  const auto* ellipsoid = std::get_if<Ellipsoid>(&shape);
  if (ellipsoid == nullptr) return 0;
  constexpr double p = 1.6075;  // Thomsen's formula, good to 1 %
  const auto [a, b, c] = std::array{ellipsoid->semi_axes[0], ellipsoid->semi_axes[1], ellipsoid->semi_axes[2]};
  return 4 * std::numbers::pi * std::pow((std::pow(a * b, p) + std::pow(a * c, p) + std::pow(b * c, p)) / 3, 1 / p);
}

/// What the scene says, or so many that nodes lie a lattice spacing apart, about.
int read_triangles(const SceneFields& fields, const std::string& pointer, const CellType& type, const Domain& domain) {
  if (fields.has(pointer + "/segments")) {
    fields.refuse_key(pointer + "/segments",
                      "a surface has triangles\ngive \"triangles\", or leave it out: then nodes lie about a lattice "
                      "spacing apart");
  }
  const std::string key = pointer + "/triangles";
  if (std::holds_alternative<MeshFile>(type.shape)) {
    if (fields.has(key)) fields.refuse_key(key, "the triangles are those of the mesh; leave this out");
    return 0;
  }
  if (!fields.has(key)) {
    if (!is_known(domain)) return 20;  // any number that is one
    return triangles_about(type.shape, domain.size.x() / domain.nodes[0]);
  }
  const int triangles = fields.value<int>(key);
  const int n = static_cast<int>(std::floor(std::sqrt(triangles / 20.0)));
  if (20 * n * n != triangles) {
    fields.refuse(key, std::to_string(triangles) +
                           " is no number of triangles of a divided icosahedron, 20 n^2\ntake " +
                           std::to_string(20 * n * n) + " or " + std::to_string(20 * (n + 1) * (n + 1)));
  }
  return triangles;
}

class Placements {
 public:
  Placements(const SceneFields& fields, const std::vector<CellType>& types, const Domain& domain,
             std::vector<RandomPacking>& packings)
      : fields_(fields), types_(types), domain_(domain), packings_(packings) {}

  std::vector<CellPlacement> read() {
    if (!fields_.has("/cells")) return {};
    if (fields_.at("/cells").is_object()) {
      fields_.attempt([&] { read_file("/cells"); });
      return std::move(cells_);
    }
    const auto count = fields_.count("/cells");
    for (std::size_t i = 0; i < count; ++i) fields_.attempt([&] { read_entry(json::child_pointer("/cells", i)); });
    return std::move(cells_);
  }

 private:
  void read_entry(const std::string& pointer) {
    if (fields_.has(pointer + "/file")) return read_file(pointer);
    int type = 0;
    fields_.attempt([&] { type = fields_.cell_type(pointer + "/type", types_); });
    if (fields_.has(pointer + "/row")) {
      read_row(type, pointer);
    } else if (fields_.has(pointer + "/random")) {
      read_random(type, pointer);
    } else if (fields_.has(pointer + "/list")) {
      const auto count = fields_.count(pointer + "/list");
      fields_.require_room(cells_.size(), count, pointer + "/list");
      for (std::size_t i = 0; i < count; ++i) place_one(type, json::child_pointer(pointer + "/list", i));
    } else {
      fields_.require_room(cells_.size(), 1, pointer);
      place_one(type, pointer);
    }
  }

  void place_one(int type, const std::string& pointer) {
    const Vector center = fields_.place(pointer + "/at", domain_);
    cells_.push_back({type, center, angle(pointer), pointer, 0, axis(pointer)});
  }

  void read_file(const std::string& pointer) {
    const auto file = fields_.file(pointer + "/file");
    if (types_.empty()) {
      if (!fields_.settled("/cell_types")) throw Misread{};
      fields_.refuse(pointer, "there are no cell types that the cells of this file could have; add cell_types");
    }
    std::optional<int> type;
    if (fields_.has(pointer + "/type")) type = fields_.cell_type(pointer + "/type", types_);
    auto placed = read_cell_table(file, types_, fields_.units(), pointer, type);
    fields_.require_room(cells_.size(), placed.size(), pointer + "/file");
    if (!placed.empty() && placed.front().center.dimension() < domain_.dimension()) {
      fields_.refuse(pointer + "/file",
                     "in three dimensions cells have a place along z\nadd a column z_um to the file");
    }
    for (CellPlacement& cell : placed) cell.center = cell.center.first(domain_.dimension());
    cells_.insert(cells_.end(), placed.begin(), placed.end());
  }

  void read_row(int type, const std::string& entry) {
    const auto pointer = entry + "/row";
    const auto count = fields_.value<std::size_t>(pointer + "/count");
    fields_.require_room(cells_.size(), count, pointer + "/count");
    const double spacing = fields_.quantity(pointer + "/spacing", "m", range::length);
    const Vector middle = fields_.place(pointer + "/center", domain_);
    const double turn = angle(pointer);
    const std::string name = fields_.value_or(pointer + "/axis", std::string("x"));
    const int along = name[0] - axis_names[0];
    if (along >= domain_.dimension())
      fields_.refuse(pointer + "/axis", "there is no z in two dimensions\ntake \"x\" or \"y\"");
    for (std::size_t i = 0; i < count; ++i) {
      Vector center = middle;
      center[along] += (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * spacing;
      cells_.push_back({type, center, turn, entry});
    }
  }

  void read_random(int type, const std::string& entry) {
    RandomPacking packing = read_packing(fields_, entry, type, domain_);
    packing.first = static_cast<int>(cells_.size());
    packings_.push_back(std::move(packing));
  }

  /// What a cell's own axis is turned to, if the scene says it.
  [[nodiscard]] std::optional<Eigen::Vector3d> axis(const std::string& pointer) const {
    if (!fields_.has(pointer + "/axis")) return std::nullopt;
    if (domain_.dimension() == 2 && is_known(domain_))
      fields_.refuse_key(pointer + "/axis", "in two dimensions cells turn in the plane\ngive \"angle\"");
    return fields_.direction(pointer + "/axis");
  }

  [[nodiscard]] double angle(const std::string& pointer) const {
    return fields_.quantity_or(pointer + "/angle", "rad", range::angle, 0.0);
  }

  const SceneFields& fields_;
  const std::vector<CellType>& types_;
  const Domain& domain_;
  std::vector<RandomPacking>& packings_;
  std::vector<CellPlacement> cells_;
};

}  // namespace

std::vector<CellType> read_cell_types(const SceneFields& fields, const FluidProperties& fluid, const Domain& domain) {
  std::vector<CellType> types;
  if (fields.has("/cell_types") && !fields.at("/cell_types").is_object()) return types;
  const auto written_types = fields.has("/cell_types") ? fields.at("/cell_types") : nlohmann::json::object();
  for (const auto& [name, written] : written_types.items()) {
    const auto pointer = json::child_pointer("/cell_types", name);
    fields.attempt([&, &name = name] {
      if (!is_plain_name(name))
        fields.refuse_key(
            pointer,
            in_quotes(name) + " is no name for a cell type; use letters, digits, '_', '-' and '.', a letter first");
      if (name == wall_name)
        fields.refuse_key(pointer,
                          "\"wall\" is no name for a cell type: in \"between\" it stands for the walls; take another");
      if (name == self_name)
        fields.refuse_key(
            pointer, "\"self\" is no name for a cell type: in \"between\" it stands for the same cell; take another");
    });
    if (types.size() == most_types)
      fields.refuse_key(pointer, "there are more than " + std::to_string(most_types) + " cell types");
    // The name stands, whatever is wrong with the rest.
    CellType& type = types.emplace_back();
    type.name = name;
    const auto require = [&](const char* key) { fields.require(pointer, key, "or \"from\", which has it"); };
    fields.attempt([&] {
      require("shape");
      read_shapes(fields, pointer, domain.dimension(), type);
    });
    type.segments = 0;
    fields.attempt([&] {
      if (domain.dimension() == 3) {
        type.triangles = read_triangles(fields, pointer, type, domain);
        return;
      }
      if (fields.has(pointer + "/triangles"))
        fields.refuse_key(pointer + "/triangles",
                          "an outline has segments\ngive \"segments\", about one for each spacing");
      fields.require(pointer, "segments", "about one per lattice spacing; or \"numerics\": \"auto\" chooses them");
      type.segments = fields.value<int>(pointer + "/segments");
    });
    type.interior_viscosity =
        fields.quantity_or(pointer + "/interior_viscosity", "Pa s", range::viscosity, fluid.viscosity);
    type.interior_density = fields.quantity_or(pointer + "/interior_density", "kg/m3", range::density, fluid.density);
    fields.attempt([&] {
      require("membrane");
      const std::size_t laws = fields.count(pointer + "/membrane");
      for (std::size_t i = 0; i < laws; ++i)
        fields.attempt([&] { type.membrane.push_back(fields.model(json::child_pointer(pointer + "/membrane", i))); });
    });
  }
  fields.attempt([&] {
    const bool sink = std::any_of(types.begin(), types.end(),
                                  [&](const CellType& type) { return type.interior_density != fluid.density; });
    if (fluid.gravity == Vector() || sink || !fields.settled("/cell_types")) return;
    fields.refuse_key("/fluid/gravity",
                      "gravity acts on cells of another density than the fluid's, and there are none\n"
                      "give a cell type \"interior_density\"; a force on the fluid itself is body_force");
  });
  return types;
}

int triangles_about(const Shape& shape, double spacing) {
  const double n = std::round(std::sqrt(surface_area(shape) / (4 * std::numbers::pi)) / spacing);
  if (!std::isfinite(n)) return 20;  // what is wrong with the size has been said
  return 20 * static_cast<int>(std::pow(std::clamp(n, 2.0, 200.0), 2));
}

std::vector<CellPlacement> read_cells(const SceneFields& fields, const std::vector<CellType>& types,
                                      const Domain& domain, std::vector<RandomPacking>& packings) {
  return Placements(fields, types, domain, packings).read();
}

}  // namespace rouleau::scene
