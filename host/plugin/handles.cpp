#include "handles.hpp"

#include <memory>

namespace rouleau::plugin {

namespace {

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
