#include "model.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/error.hpp"
#include "core/model/compiled_in.hpp"
#include "library.hpp"

namespace rouleau::plugin {

namespace {

Place place_of(const Manifest& manifest) { return {manifest.file.string(), {}, 0, 0}; }

std::string name_of(const Manifest& manifest) {
  return "the model \"" + manifest.id + "\" of " + manifest.library.string();
}

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

template <class Table>
core::Model<Table> make_model(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting,
                              const Table& (ModelInstance::*table)() const) {
  const auto instance = std::make_shared<const ModelInstance>(manifest, values, setting);
  core::Model<Table> made{.id = manifest.id,
                          .table = &(instance.get()->*table)(),
                          .self = std::shared_ptr<const void>(instance, instance->self()),
                          .needs = manifest.needs,
                          .gives = manifest.gives,
                          .state = {}};
  for (std::size_t k = 0; k < manifest.state.size(); ++k) {
    const StateVariable& variable = manifest.state[k];
    made.state.push_back({variable.name, instance->initial_state()[k], setting.units.unit(variable.dimension)});
  }
  return made;
}

}  // namespace

ModelRefused::ModelRefused(const Manifest& manifest, const std::string& reason)
    : Error(Cause::plugin_refused, place_of(manifest), name_of(manifest) + " could not be made: " + reason),
      reason_(reason) {}

ModelInstance::ModelInstance(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting)
    : manifest_(&manifest), model_(&open_model(manifest)), self_(nullptr, Destroy{manifest.id, model_->destroy}) {
  for (const StateVariable& variable : manifest.state)
    initial_state_.push_back(setting.units.to_lattice(variable.initial, variable.dimension));
  const ModelSetup setup(manifest, values, setting);
  std::array<char, 1024> message{};
  void* self = nullptr;
  const int refused = call_watched(manifest, "create",
                                   [&] { return model_->create(&setup.get(), &self, message.data(), message.size()); });
  if (refused != 0) {
    message.back() = '\0';  // whatever the plugin wrote
    throw ModelRefused(manifest, message.front() == '\0' ? "it gave no reason" : message.data());
  }
  self_.reset(self);
  if (manifest.kind == ModelKind::interaction) {
    const double cutoff = call_foreign(manifest.id, "cutoff", [&] { return interaction().cutoff(self); });
    if (!std::isfinite(cutoff) || cutoff < 0) {
      throw Error(
          Cause::plugin_refused, place_of(manifest),
          name_of(manifest) + " has the cutoff " + std::to_string(cutoff) + "; it must be finite and not negative");
    }
  }
}

ModelSetup::ModelSetup(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting) {
  if (values.size() != manifest.parameters.size())
    throw std::logic_error("a model needs one value for each parameter of its manifest");
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

core::CollisionOperator make_collision_operator(const Manifest& manifest, const std::vector<double>& values,
                                                const ModelSetting& setting) {
  return make_model(manifest, values, setting, &ModelInstance::collision);
}

core::MembraneLaw make_membrane_law(const Manifest& manifest, const std::vector<double>& values,
                                    const ModelSetting& setting) {
  core::MembraneLaw law = make_model(manifest, values, setting, &ModelInstance::membrane);
  const Manifest one = manifest.in(setting.dimension);
  law.needs = one.needs;
  law.gives = one.gives;
  return law;
}

core::Potential make_potential(const Manifest& manifest, const std::vector<double>& values,
                               const ModelSetting& setting) {
  return make_model(manifest, values, setting, &ModelInstance::interaction);
}

}  // namespace rouleau::plugin
