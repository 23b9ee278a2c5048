#include "manifest.hpp"

#include <algorithm>

namespace rouleau::plugin {

namespace {

constexpr units::Dimension per_length{{1, 0, -2}}, energy{{1, 2, -2}}, distance{{0, 1, 0}},
    surface_viscosity{{1, 0, -1}};

/// In the order of the enumeration.
constexpr std::array roles{
    RoleFacts{Role::shear_modulus, "shear_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::stretching_modulus, "stretching_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::area_modulus, "area_modulus", ModelKind::membrane, per_length, "N/m"},
    RoleFacts{Role::bending_modulus, "bending_modulus", ModelKind::membrane, energy, "J"},
    RoleFacts{Role::membrane_viscosity, "membrane_viscosity", ModelKind::membrane, surface_viscosity, "N s/m"},
    RoleFacts{Role::depth, "depth", ModelKind::interaction, per_length, "J/m2"},
    RoleFacts{Role::zero_force_distance, "zero_force_distance", ModelKind::interaction, distance, "m"},
    RoleFacts{Role::cutoff, "cutoff", ModelKind::interaction, distance, "m"},
};

}  // namespace

const char* to_string(ModelKind kind) {
  constexpr std::array words{"collision", "membrane", "interaction"};
  return words.at(static_cast<std::size_t>(kind) - 1);
}

const RoleFacts& facts_of(Role role) { return roles.at(static_cast<std::size_t>(role)); }

std::optional<Role> role_named(const std::string& name) {
  const auto found =
      std::find_if(roles.begin(), roles.end(), [&](const RoleFacts& facts) { return facts.name == name; });
  return found == roles.end() ? std::nullopt : std::optional(found->role);
}

bool Manifest::needs_input(const std::string& name) const {
  return std::find(needs.begin(), needs.end(), name) != needs.end();
}

bool Manifest::gives_output(const std::string& name) const {
  return std::find(gives.begin(), gives.end(), name) != gives.end();
}

bool Manifest::works_in(int dimension) const {
  return std::find(dimensions.begin(), dimensions.end(), dimension) != dimensions.end();
}

Manifest Manifest::in(int dimension) const {
  Manifest one = *this;
  one.dimensions = {dimension};
  one.in_3d.reset();
  if (dimension == 3 && in_3d) {
    one.needs = in_3d->needs;
    one.gives = in_3d->gives;
    one.checks = in_3d->checks;
  }
  return one;
}

std::optional<std::size_t> Manifest::parameter_with(Role role) const {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].role == role) return i;
  return std::nullopt;
}

}  // namespace rouleau::plugin
