#include "model_setup.hpp"

#include <rouleau/d2q9.hpp>
#include <stdexcept>

namespace rouleau::plugin {

namespace {

/// Temperature, amount of substance and current have no lattice unit: what holds one of them stays in SI.
bool has_lattice_unit(const units::Dimension& dimension) {
  return dimension.exponent[3] == 0 && dimension.exponent[4] == 0 && dimension.exponent[5] == 0;
}

std::vector<double> lattice_values(const Manifest& manifest, const std::vector<double>& values,
                                   const units::LatticeUnits& units) {
  std::vector<double> lattice(values);
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const units::Dimension& dimension = manifest.parameters[i].dimension;
    if (has_lattice_unit(dimension)) lattice[i] = units.to_lattice(values[i], dimension);
  }
  return lattice;
}

}  // namespace

ModelSetup::ModelSetup(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting) {
  if (values.size() != manifest.parameters.size()) {
    throw std::logic_error("a model needs one value for each parameter of its manifest");
  }
  for (const Parameter& parameter : manifest.parameters) names_.push_back(parameter.name.c_str());
  values_ = lattice_values(manifest, values, setting.units);
  for (std::size_t q = 0; q < 9; ++q) {
    for (std::size_t k = 0; k < 2; ++k) velocities_[2 * q + k] = d2q9::velocity[q][k];
  }
  setup_.struct_size = sizeof setup_;
  setup_.host_minor = ROULEAU_ABI_MINOR;
  setup_.parameter_count = static_cast<std::uint32_t>(values_.size());
  setup_.parameter_names = names_.data();
  setup_.parameter_values = values_.data();
  setup_.length_unit = setting.units.length;
  setup_.time_unit = setting.units.time;
  setup_.mass_unit = setting.units.mass;
  setup_.dimension = 2;
  setup_.velocity_count = d2q9::velocity_count;
  setup_.velocities = velocities_.data();
  setup_.weights = d2q9::weight;
  setup_.sound_speed_squared = d2q9::sound_speed_squared;
  setup_.relaxation_rate = setting.relaxation_rate;
  setup_.inertia = setting.inertia ? 1 : 0;
}

}  // namespace rouleau::plugin
