// What a model's parameter is in the field's terms, whatever its author called it: "role" in a manifest.
#pragma once

#include <optional>
#include <string>

#include "units/units.hpp"

namespace rouleau::plugin {

enum class ModelKind;

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

}  // namespace rouleau::plugin
