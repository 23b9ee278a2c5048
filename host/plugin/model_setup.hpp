// The rouleau_setup of one instance with everything it points to.
#pragma once

#include <rouleau/plugin.h>

#include <vector>

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

}  // namespace rouleau::plugin
