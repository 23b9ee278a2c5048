// The instances that a check of physics tries: typical parameters, each word of each choice, random parameters.
#pragma once

#include <string>
#include <vector>

#include "conform/check.hpp"
#include "conform/subject.hpp"

namespace rouleau::conform {

struct Trial {
  plugin::ModelInstance instance;
  std::vector<double> parameters;  ///< in SI
  plugin::ModelSetting setting;
  std::string words;  ///< " with transverse clamped, shear_modulus 3e-06 N/m": what is not typical; empty: nothing
};

/// Typical parameters, each other word of each choice, and some draws at random. Sets that the model refuses are left
/// out.
std::vector<Trial> trials(const Subject& subject, Random& random, const plugin::ModelSetting& setting, int draws = 4);

/// A collision operator's trials without and with inertia, each at a random relaxation rate of the setup: one, one near
/// its limits, or 1, where much cancels.
std::vector<Trial> collision_trials(const Subject& subject, Random& random, int draws = 4);

/// What a check finds of a model on each lattice that its manifest names: the worst of it.
template <Finding (*run)(const Subject&)>
Finding on_each_lattice(const Subject& subject) {
  Finding found = run(subject);
  if (subject.manifest().kind != plugin::ModelKind::collision) return found;
  if (subject.dimension() == 3 || !subject.manifest().works_in(3)) return found;
  Finding in_space = run(subject.on_lattice(3));
  in_space.what += " (D3Q19)";
  return worse(in_space, found) ? in_space : found;
}

/// A number of a trial's lattice in SI with its unit, "1.2e-05 N/m"; `name` is of "needs" or "gives".
std::string in_si(const Subject& subject, const plugin::ModelSetting& setting, const std::string& name, double lattice,
                  int digits = 4);

/// All inputs of one element, "stretch 1.2, stretch_rate 3 1/s". State is named as in the manifest.
std::string place(const Subject& subject, const plugin::ModelSetting& setting, const Values& inputs,
                  std::size_t element);

/// Dimension of an array: of a quantity of "needs" or "gives", or of the state variable "state.0".
units::Dimension dimension_of_array(const Subject& subject, const std::string& array);

}  // namespace rouleau::conform
