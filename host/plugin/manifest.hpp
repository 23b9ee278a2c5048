// A plugin's manifest: what a model is, takes and gives, known before its library is opened.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/input_file.hpp"
#include "json/json.hpp"
#include "units/units.hpp"

namespace rouleau::plugin {

enum class ModelKind { collision = 1, membrane = 2, interaction = 3 };
const char* to_string(ModelKind kind);

// What a model's parameter is in the field's terms, whatever its author called it: "role" in a manifest.

/// The host knows parameters by their roles only, never by their names.
enum class Role {
  shear_modulus,        ///< membrane: elastic resistance to shear in its plane
  stretching_modulus,   ///< membrane: d tension / d stretch at rest
  area_modulus,         ///< membrane: resistance to change of its own area
  bending_modulus,      ///< membrane: d moment / d curvature
  membrane_viscosity,   ///< membrane: d tension / d stretch rate at rest
  depth,                ///< interaction: of the well, energy per area
  zero_force_distance,  ///< interaction: where attraction turns into repulsion
  cutoff,               ///< interaction: no force from there on
};

/// What a parameter must be to have a role.
struct RoleFacts {
  Role role;
  const char* name;  ///< in manifests; the enum of the manifest's schema holds the same names
  ModelKind kind;
  units::Dimension dimension;
  const char* unit;  ///< one of that dimension, such as messages name it
};

const RoleFacts& facts_of(Role role);
/// Nothing for a word that is no role.
std::optional<Role> role_named(const std::string& name);

/// One parameter of a model. Numbers are in coherent SI units here; `unit` is what the manifest and messages use.
struct Parameter {
  std::string name;
  std::string unit;  ///< "1" for a number; empty for a choice
  units::Dimension dimension;
  std::vector<std::string> choices;     ///< not empty: a word of this list; its index is what the model gets
  std::optional<double> default_value;  ///< absent: the scene must give it
  std::optional<double> minimum, exclusive_minimum, maximum, exclusive_maximum;  ///< outside: refused
  std::optional<std::array<double, 2>> usual;                                    ///< outside: a warning
  std::optional<Role> role;  ///< what it is in the field's terms, if the manifest says so
  std::string doc;
};

/// A variable of each element that evolves with time; the host keeps it.
struct StateVariable {
  std::string name;
  std::string unit;
  units::Dimension dimension;
  double initial = 0;  ///< in coherent SI units
};

/// What a lock says of a plugin's library.
struct LibraryLock {
  std::string lock, renewal;  ///< file; how it is made anew
  std::string sha256;
};

struct Manifest {
  std::filesystem::path file;     ///< the manifest itself
  std::string sha256;             ///< of its text, as it was read
  std::filesystem::path library;  ///< absolute; checked to lie in the manifest's folder when the library is opened
  FileStamp library_stamp{};      ///< of the library when the manifest was read
  ModelKind kind;
  std::string id;
  std::string version;
  std::string title, reference, author, license;
  std::vector<int> dimensions = {2};  ///< of the scenes it works in; of a collision operator by its "lattices"
  std::vector<Parameter> parameters;
  std::vector<std::string> needs, gives;
  std::vector<StateVariable> state;
  nlohmann::json
      inactive_when;  ///< object: parameter -> value (in its unit) at which the model does nothing; null: never
  nlohmann::json
      stands_for;  ///< object: parameter -> value at which an interaction is the one it stands for; null: it is itself
  nlohmann::json claims, checks;
  /// What takes the place of needs, gives and checks in three dimensions, of a membrane law of both dimensions.
  struct Surface {
    std::vector<std::string> needs, gives;
    nlohmann::json checks;
  };
  std::optional<Surface> in_3d;
  std::optional<LibraryLock> locked;  ///< a library with another hash is not opened

  [[nodiscard]] bool needs_input(const std::string& name) const;
  [[nodiscard]] bool gives_output(const std::string& name) const;
  [[nodiscard]] bool works_in(int dimension) const;
  /// The dimension that needs, gives and checks are written for.
  [[nodiscard]] int dimension() const { return works_in(2) ? 2 : 3; }
  /// The same model as one dimension has it, which must be one of its own.
  [[nodiscard]] Manifest in(int dimension) const;
  /// Place of the parameter with this role in `parameters`; nothing when none has it.
  [[nodiscard]] std::optional<std::size_t> parameter_with(Role role) const;
};

}  // namespace rouleau::plugin
