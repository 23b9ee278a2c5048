#include "role.hpp"

#include <algorithm>
#include <array>

#include "manifest.hpp"

namespace rouleau::plugin {

namespace {

constexpr units::Dimension per_length{{1, 0, -2}}, energy{{1, 2, -2}}, length{{0, 1, 0}}, surface_viscosity{{1, 0, -1}};

/// In the order of the enumeration.
constexpr std::array roles{
    RoleFacts{Role::shear_modulus, "shear_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::stretching_modulus, "stretching_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::area_modulus, "area_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::bending_modulus, "bending_modulus", ModelKind::membrane, energy, "J"},
    RoleFacts{Role::membrane_viscosity, "membrane_viscosity", ModelKind::membrane, surface_viscosity, "N s/m"},
    RoleFacts{Role::depth, "depth", ModelKind::interaction, per_length, "J/m2"},
    RoleFacts{Role::zero_force_distance, "zero_force_distance", ModelKind::interaction, length, "m"},
    RoleFacts{Role::cutoff, "cutoff", ModelKind::interaction, length, "m"},
};

}  // namespace

const RoleFacts& facts_of(Role role) { return roles.at(static_cast<std::size_t>(role)); }

std::optional<Role> role_named(const std::string& name) {
  const auto found =
      std::find_if(roles.begin(), roles.end(), [&](const RoleFacts& facts) { return facts.name == name; });
  return found == roles.end() ? std::nullopt : std::optional(found->role);
}

}  // namespace rouleau::plugin
