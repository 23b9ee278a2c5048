#include "model.hpp"

#include <cmath>
#include <string>

#include "base/error.hpp"
#include "library.hpp"
#include "watched_call.hpp"

namespace rouleau::plugin {

namespace {

Place place_of(const Manifest& manifest) { return {manifest.file.string(), {}, 0, 0}; }

std::string name_of(const Manifest& manifest) {
  return "the model \"" + manifest.id + "\" of " + manifest.library.string();
}

}  // namespace

ModelRefused::ModelRefused(const Manifest& manifest, const std::string& reason)
    : Error(Cause::plugin_refused, place_of(manifest), name_of(manifest) + " could not be made: " + reason),
      reason_(reason) {}

ModelInstance::ModelInstance(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting)
    : manifest_(&manifest), model_(&open_model(manifest)), self_(nullptr, Destroy{manifest.id, model_->destroy}) {
  for (const StateVariable& variable : manifest.state) {
    initial_state_.push_back(setting.units.to_lattice(variable.initial, variable.dimension));
  }
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

}  // namespace rouleau::plugin
