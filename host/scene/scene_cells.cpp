// Cell types and where cells are placed.
#include "base/text.hpp"
#include "cell_table.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

constexpr std::size_t most_types = 1000;

/// Names stand in columns of CSV files and in paths of HDF5 files.
bool is_plain_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || name.size() > 100 || !letter(name.front())) return false;
  for (const char c : name) {
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '_' && c != '-' && c != '.') return false;
  }
  return true;
}

Shape read_shape(const SceneFields& fields, const std::string& pointer) {
  if (fields.has(pointer + "/biconcave"))
    return Biconcave{fields.quantity(pointer + "/biconcave/radius", "m", range::length)};
  if (fields.has(pointer + "/circle")) {
    return Circle{fields.quantity(pointer + "/circle/radius", "m", range::length),
                  fields.value_or(pointer + "/circle/prestretch", 1.0)};
  }
  return Ellipse{fields.quantities(pointer + "/ellipse/semi_axes", "m", range::length)};
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
    for (std::size_t i = 0; i < count; ++i) {
      fields_.attempt([&] { read_entry(json::child_pointer("/cells", i)); });
    }
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
    cells_.push_back({type, fields_.quantities(pointer + "/at", "m", range::place), angle(pointer), pointer});
  }

  void read_file(const std::string& pointer) {
    const auto file = fields_.file(pointer + "/file");
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      fields_.refuse(pointer + "/file", in_quotes(fields_.value<std::string>(pointer + "/file")) +
                                            " is no file; a relative name begins with the scene's folder\n"
                                            "looked for: " +
                                            printable(file.lexically_normal().string()));
    }
    if (types_.empty()) {
      if (!fields_.settled("/cell_types")) throw Misread{};
      fields_.refuse(pointer, "there are no cell types that the cells of this file could have; add cell_types");
    }
    std::optional<int> type;
    if (fields_.has(pointer + "/type")) type = fields_.cell_type(pointer + "/type", types_);
    const auto placed = read_cell_table(file, types_, fields_.units(), pointer, type);
    fields_.require_room(cells_.size(), placed.size(), pointer + "/file");
    cells_.insert(cells_.end(), placed.begin(), placed.end());
  }

  void read_row(int type, const std::string& entry) {
    const auto pointer = entry + "/row";
    const auto count = fields_.value<std::size_t>(pointer + "/count");
    fields_.require_room(cells_.size(), count, pointer + "/count");
    const double spacing = fields_.quantity(pointer + "/spacing", "m", range::length);
    const auto center = fields_.quantities(pointer + "/center", "m", range::place);
    const double turn = angle(pointer);
    const Eigen::Vector2d direction = fields_.value_or(pointer + "/axis", std::string("x")) == "y"
                                          ? Eigen::Vector2d::UnitY()
                                          : Eigen::Vector2d::UnitX();
    const double middle = 0.5 * static_cast<double>(count - 1);
    for (std::size_t i = 0; i < count; ++i) {
      cells_.push_back({type, center + (static_cast<double>(i) - middle) * spacing * direction, turn, entry});
    }
  }

  void read_random(int type, const std::string& entry) {
    RandomPacking packing = read_packing(fields_, entry, type, domain_);
    packing.first = static_cast<int>(cells_.size());
    packings_.push_back(std::move(packing));
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

std::vector<CellType> read_cell_types(const SceneFields& fields, double fluid_viscosity) {
  std::vector<CellType> types;
  if (!fields.has("/cell_types") || !fields.at("/cell_types").is_object()) return types;
  for (const auto& [name, written] : fields.at("/cell_types").items()) {
    const auto pointer = json::child_pointer("/cell_types", name);
    fields.attempt([&, &name = name] {
      if (!is_plain_name(name)) {
        fields.refuse_key(
            pointer,
            in_quotes(name) + " is no name for a cell type; use letters, digits, '_', '-' and '.', a letter first");
      }
      if (name == wall_name) {
        fields.refuse_key(pointer,
                          "\"wall\" is no name for a cell type: in \"between\" it stands for the walls; take another");
      }
      if (name == self_name) {
        fields.refuse_key(
            pointer, "\"self\" is no name for a cell type: in \"between\" it stands for the same cell; take another");
      }
    });
    if (types.size() == most_types) {
      fields.refuse_key(pointer, "there are more than " + std::to_string(most_types) + " cell types");
    }
    // The name stands, whatever is wrong with the rest.
    CellType& type = types.emplace_back();
    type.name = name;
    fields.attempt([&] { type.shape = read_shape(fields, pointer + "/shape"); });
    fields.attempt([&] {
      fields.require(pointer, "segments", "about one per lattice spacing; or \"numerics\": \"auto\" chooses them");
      type.segments = fields.value<int>(pointer + "/segments");
    });
    type.interior_viscosity =
        fields.quantity_or(pointer + "/interior_viscosity", "Pa s", range::viscosity, fluid_viscosity);
    fields.attempt([&] {
      const std::size_t laws = fields.count(pointer + "/membrane");
      for (std::size_t i = 0; i < laws; ++i) {
        fields.attempt([&] { type.membrane.push_back(fields.model(json::child_pointer(pointer + "/membrane", i))); });
      }
    });
  }
  return types;
}

std::vector<CellPlacement> read_cells(const SceneFields& fields, const std::vector<CellType>& types,
                                      const Domain& domain, std::vector<RandomPacking>& packings) {
  return Placements(fields, types, domain, packings).read();
}

}  // namespace rouleau::scene
