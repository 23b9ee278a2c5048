#include "model_setup.hpp"

#include <stdexcept>

#include "core/model/lattice_setup.hpp"

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
  setup_ = core::lattice_setup(setting.dimension, setting.relaxation_rate, setting.inertia);
  setup_.parameter_count = static_cast<std::uint32_t>(values_.size());
  setup_.parameter_names = names_.data();
  setup_.parameter_values = values_.data();
  setup_.length_unit = setting.units.length;
  setup_.time_unit = setting.units.time;
  setup_.mass_unit = setting.units.mass;
}

}  // namespace rouleau::plugin
