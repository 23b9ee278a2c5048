// Instances of models: a C table with its `self`, made for one stage and destroyed with it.
#pragma once

#include <rouleau/plugin.h>

#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "manifest.hpp"
#include "model_setup.hpp"

namespace rouleau::plugin {

/// A model's create function has reported an error: as a rule these parameters do not go together.
class ModelRefused : public Error {
 public:
  ModelRefused(const Manifest& manifest, const std::string& reason);
  /// What is wrong, as the model says.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// One instance, usable from many threads at once. Creating it opens the model's library.
class ModelInstance {
 public:
  /// `values`: parameters in SI in the manifest's order; they are converted to lattice units here.
  /// Throws Error(plugin_refused) when the library is refused, and its kind ModelRefused when create reports an error.
  ModelInstance(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting);

  [[nodiscard]] const Manifest& manifest() const { return *manifest_; }
  /// Initial value of each of the manifest's state variables, in lattice units.
  [[nodiscard]] const std::vector<double>& initial_state() const { return initial_state_; }
  [[nodiscard]] const void* self() const { return self_.get(); }
  [[nodiscard]] const rouleau_collision& collision() const { return *model_->collision; }
  [[nodiscard]] const rouleau_membrane& membrane() const { return *model_->membrane; }
  [[nodiscard]] const rouleau_interaction& interaction() const { return *model_->interaction; }

 private:
  const Manifest* manifest_;
  const rouleau_model* model_;
  std::vector<double> initial_state_;
  struct Destroy {
    std::string id;
    void (*function)(void*);
    void operator()(void* self) const {
      const ForeignCall mark(id.c_str(), "destroy");
      function(self);
    }
  };
  std::unique_ptr<void, Destroy> self_;
};

}  // namespace rouleau::plugin
