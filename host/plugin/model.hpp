// A plugin's model, with its parameters set for one stage, and as the core takes it.
#pragma once

#include <rouleau/plugin.h>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "core/model/model.hpp"
#include "manifest.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::plugin {

/// What all models of a stage are told about the lattice.
struct ModelSetting {
  units::LatticeUnits units;
  double relaxation_rate;  ///< 1/tau of the suspending fluid
  bool inertia;
  int dimension = 2;  ///< 2: D2Q9, 3: D3Q19
};

class ModelSetup {
 public:
  /// `values`: parameters in SI in the manifest's order; they are converted to lattice units here, but for those whose
  /// unit holds K, mol or A. Names point into the manifest.
  ModelSetup(const Manifest& manifest, const std::vector<double>& values, const ModelSetting& setting);
  ModelSetup(const ModelSetup&) = delete;
  ModelSetup& operator=(const ModelSetup&) = delete;

  [[nodiscard]] const rouleau_setup& get() const { return setup_; }
  /// For the conformance tests, which give models what no host would.
  [[nodiscard]] rouleau_setup& get() { return setup_; }

 private:
  std::vector<const char*> names_;
  std::vector<double> values_;
  rouleau_setup setup_{};
};

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

/// Instances of models, made for one stage. `values`: parameters in SI in the manifest's order. Throws what
/// ModelInstance throws, and Error(plugin_refused) for a law that needs what this program does not give.
core::CollisionOperator make_collision_operator(const Manifest& manifest, const std::vector<double>& values,
                                                const ModelSetting& setting);
core::MembraneLaw make_membrane_law(const Manifest& manifest, const std::vector<double>& values,
                                    const ModelSetting& setting);
core::Potential make_potential(const Manifest& manifest, const std::vector<double>& values,
                               const ModelSetting& setting);

}  // namespace rouleau::plugin
