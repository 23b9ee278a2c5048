// The instances that a check of physics tries: typical parameters, each word of each choice, random parameters.
#pragma once

#include <functional>
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

/// Trials of each of the subject's settings.
std::vector<Trial> setting_trials(const Subject& subject, Random& random, int draws);

/// Outputs of an instance for inputs, by name.
using Results = std::function<Values(const plugin::ModelInstance&, const Values&)>;
/// How far results move when parameters and inputs are rounded differently, by up to `roundings` epsilon: the largest
/// of eight tries. `only_units`: what has no unit stays.
Values sensitivity(const Subject& subject, const Trial& trial, const Values& inputs, Random& random, double roundings,
                   bool only_units, const Results& results);

/// A number of a trial's lattice in SI with its unit, "1.2e-05 N/m"; `name` is of "needs" or "gives".
std::string in_si(const Subject& subject, const plugin::ModelSetting& setting, const std::string& name, double lattice,
                  int digits = 4);

/// All inputs of one element, "stretch 1.2, stretch_rate 3 1/s". State is named as in the manifest.
std::string place(const Subject& subject, const plugin::ModelSetting& setting, const Values& inputs,
                  std::size_t element);

/// Dimension of an array: of a quantity of "needs" or "gives", or of the state variable "state.0".
units::Dimension dimension_of_array(const Subject& subject, const std::string& array);

}  // namespace rouleau::conform
