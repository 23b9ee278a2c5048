// The shipped membrane laws and potentials, linked into the tests, and what they give for lists of arguments.
#pragma once

#include <rouleau/plugin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "model_setup.hpp"

extern "C" {
const rouleau_plugin* open_area(std::uint32_t);
const rouleau_plugin* open_bending(std::uint32_t);
const rouleau_plugin* open_depletion(std::uint32_t);
const rouleau_plugin* open_hooke(std::uint32_t);
const rouleau_plugin* open_inextensible(std::uint32_t);
const rouleau_plugin* open_lennard_jones(std::uint32_t);
const rouleau_plugin* open_morse(std::uint32_t);
const rouleau_plugin* open_neo_hookean(std::uint32_t);
const rouleau_plugin* open_perimeter(std::uint32_t);
const rouleau_plugin* open_repulsion(std::uint32_t);
const rouleau_plugin* open_skalak(std::uint32_t);
}

namespace rouleau::test {

using Parameter = std::vector<std::pair<std::string, double>>;

/// What a law gives for a list of arguments: energy, force (or tension, moment) and its derivative.
struct Values {
  std::vector<double> energy, slope, slope_by_argument;
};

inline void fill(rouleau_interaction_block& block, const double* in, double* slope, double* derivative) {
  block.distance = in;
  block.force = slope;
  block.force_by_distance = derivative;
}
inline void fill_tension(rouleau_membrane_block& block, const double* in, double* slope, double* derivative) {
  block.stretch = in;
  block.tension = slope;
  block.tension_by_stretch = derivative;
}
inline void fill_moment(rouleau_membrane_block& block, const double* in, double* slope, double* derivative) {
  block.curvature = in;  // the rest curvature is not given: zero
  block.moment = slope;
  block.moment_by_curvature = derivative;
}

/// Evaluates at all arguments, in blocks of at most `size` elements at addresses that no vector load likes.
template <class Block, class Fill, class Function>
Values evaluate(const std::vector<double>& arguments, std::size_t size, const Fill& fill, Function function,
                const void* self) {
  const std::size_t count = arguments.size();
  std::vector<double> input(count + 1), energy(count + 1), slope(count + 1), derivative(count + 1);
  std::copy(arguments.begin(), arguments.end(), input.begin() + 1);
  for (std::size_t first = 1; first <= count; first += size) {
    Block block{};
    block.struct_size = sizeof block;
    block.count = static_cast<std::uint32_t>(std::min(size, count + 1 - first));
    block.time_step = 1;
    fill(block, input.data() + first, slope.data() + first, derivative.data() + first);
    block.energy = energy.data() + first;
    function(self, &block);
  }
  for (auto* values : {&energy, &slope, &derivative}) values->erase(values->begin());
  return {energy, slope, derivative};
}

/// One potential or law of segments or nodes with its parameters, as the host calls it on this processor.
class Shipped {
 public:
  Shipped(const rouleau_plugin& plugin, const Setup& setup, int index = 0)
      : model_(plugin.models[index]), self_(make(*model_, setup)) {}

  [[nodiscard]] Values operator()(const std::vector<double>& at) const {
    if (model_->kind == ROULEAU_INTERACTION_KIND) {
      return evaluate<rouleau_interaction_block>(at, at.size(), fill, model_->interaction->compute, self_.get());
    }
    const bool bends = std::strcmp(model_->id, "bending") == 0;
    return evaluate<rouleau_membrane_block>(at, at.size(), bends ? fill_moment : fill_tension,
                                            model_->membrane->compute, self_.get());
  }
  [[nodiscard]] double energy(double at) const { return (*this)({at}).energy[0]; }
  [[nodiscard]] double slope(double at) const { return (*this)({at}).slope[0]; }
  [[nodiscard]] double derivative(double at) const { return (*this)({at}).slope_by_argument[0]; }
  [[nodiscard]] double cutoff() const { return model_->interaction->cutoff(self_.get()); }
  [[nodiscard]] const void* self() const { return self_.get(); }

 private:
  const rouleau_model* model_;
  Self self_;
};

/// Depletion by dextran in nanometres and microjoules per square metre: units of length, time and mass chosen so.
inline Setup dextran(double kilodalton, double gram_per_decilitre, double second_virial, double form,
                     double length_unit = 1e-9, double time_unit = 1, double mass_unit = 1e-6) {
  const double density = mass_unit / (length_unit * length_unit * length_unit);
  Setup setup{{{"form", form},
               {"molar_mass", kilodalton * 1.66053906660e-24 / mass_unit},
               {"concentration", gram_per_decilitre * 10 / density},
               {"second_virial_coefficient", second_virial},
               {"temperature", 298},
               {"penetration_concentration", 20 / density},
               {"gyration_factor", 0.066e-9 / length_unit},
               {"gyration_exponent", 0.43},
               {"glycocalyx_thickness", 5e-9 / length_unit},
               {"surface_charge", 0.036},
               {"relative_permittivity", 80},
               {"debye_length", 0.8e-9 / length_unit},
               {"zero_force_distance", 490e-9 / length_unit},
               {"decay", 3.84e6 * length_unit},
               {"cutoff", 3.52e-6 / length_unit}}};
  setup.length_unit = length_unit;
  setup.time_unit = time_unit;
  setup.mass_unit = mass_unit;
  return setup;
}

}  // namespace rouleau::test
