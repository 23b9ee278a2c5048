#include "model.hpp"

#include <cmath>
#include <rouleau/d2q9.hpp>
#include <string>

#include "error.hpp"
#include "library.hpp"

namespace rouleau::host {

namespace {

/// Temperature, amount of substance and current have no lattice unit: what holds one of them stays in SI.
bool has_lattice_unit(const Dimension& dimension) {
  return dimension.exponent[3] == 0 && dimension.exponent[4] == 0 && dimension.exponent[5] == 0;
}

std::vector<double> lattice_values(const Manifest& manifest, const std::vector<double>& values,
                                   const LatticeUnits& units) {
  std::vector<double> lattice(values);
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const Dimension& dimension = manifest.parameters[i].dimension;
    if (has_lattice_unit(dimension)) lattice[i] = units.to_lattice(values[i], dimension);
  }
  return lattice;
}

Place place_of(const Manifest& manifest) { return {manifest.file.string(), {}, 0, 0}; }

std::string name_of(const Manifest& manifest) {
  return "the model \"" + manifest.id + "\" of " + manifest.library.string();
}

}  // namespace

ModelRefused::ModelRefused(const Manifest& manifest, const std::string& problem)
    : Error(ExitCode::plugin_refused, place_of(manifest), name_of(manifest) + " could not be made: " + problem),
      problem_(problem) {}

ModelInstance::ModelInstance(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting)
    : manifest_(&manifest), model_(&open_model(manifest)), self_(nullptr, model_->destroy) {
  if (values.size() != manifest.parameters.size()) {
    throw std::logic_error("a model needs one value for each parameter of its manifest");
  }
  for (const StateVariable& variable : manifest.state) {
    initial_state_.push_back(setting.units.to_lattice(variable.initial, variable.dimension));
  }
  std::vector<const char*> names;
  for (const Parameter& parameter : manifest.parameters) names.push_back(parameter.name.c_str());
  const std::vector<double> lattice = lattice_values(manifest, values, setting.units);
  std::array<double, 18> velocities{};
  for (std::size_t q = 0; q < 9; ++q) {
    for (std::size_t k = 0; k < 2; ++k) velocities[2 * q + k] = d2q9::velocity[q][k];
  }

  rouleau_setup setup{};
  setup.struct_size = sizeof setup;
  setup.host_minor = ROULEAU_ABI_MINOR;
  setup.parameter_count = static_cast<std::uint32_t>(lattice.size());
  setup.parameter_names = names.data();
  setup.parameter_values = lattice.data();
  setup.length_unit = setting.units.length;
  setup.time_unit = setting.units.time;
  setup.mass_unit = setting.units.mass;
  setup.dimension = 2;
  setup.velocity_count = d2q9::velocity_count;
  setup.velocities = velocities.data();
  setup.weights = d2q9::weight;
  setup.sound_speed_squared = d2q9::sound_speed_squared;
  setup.relaxation_rate = setting.relaxation_rate;
  setup.inertia = setting.inertia ? 1 : 0;

  std::array<char, 1024> message{};
  void* self = nullptr;
  if (model_->create(&setup, &self, message.data(), message.size()) != 0) {
    message.back() = '\0';  // whatever the plugin wrote
    throw ModelRefused(manifest, message.front() == '\0' ? "it gave no reason" : message.data());
  }
  self_.reset(self);
  if (manifest.kind == ModelKind::interaction) {
    const double cutoff = interaction().cutoff(self);
    if (!std::isfinite(cutoff) || cutoff < 0) {
      throw Error(
          ExitCode::plugin_refused, place_of(manifest),
          name_of(manifest) + " has the cutoff " + std::to_string(cutoff) + "; it must be finite and not negative");
    }
  }
}

}  // namespace rouleau::host
