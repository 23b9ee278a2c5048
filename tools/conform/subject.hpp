// The plugin under test, as checks see it in their own process: its manifest, instances of it, random inputs for it.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "plugin/manifest.hpp"
#include "plugin/model.hpp"

namespace rouleau::conform {

/// Values of the elements of a call by name, all of one length: the names of "needs" and "gives". Quantities with
/// components have one entry for each, "populations.0" to ".8", "force.0", "velocity.1"; state variables are
/// "state.0"...
using Values = std::map<std::string, std::vector<double>>;

/// Elements of an ordinary call: no multiple of a vector's width.
inline constexpr std::size_t ordinary_count = 67;

using Random = std::mt19937_64;
/// Evenly distributed between two values.
double uniform(Random& random, double low, double high);
/// Whether an input vanishes where nothing moves.
inline bool is_motion(const std::string& input) {
  return input.ends_with("_rate") || input.ends_with("_velocity") || input.ends_with("_speed");
}
/// A number of elements such as hosts have, 64 to 2100.
inline std::size_t some_count(Random& random) {
  return static_cast<std::size_t>(64 * std::pow(2100.0 / 64, uniform(random, 0, 1)));
}

class Subject {
 public:
  /// The model as scenes of that dimension have it, one of those that its manifest names.
  Subject(plugin::Manifest manifest, std::uint64_t seed, int dimension)
      : whole_(std::move(manifest)), manifest_(whole_.in(dimension)), seed_(seed) {}
  /// The same in the other dimension; nothing if the model works in one only.
  [[nodiscard]] std::optional<Subject> in_other_dimension() const {
    const int other = 5 - dimension();
    return whole_.works_in(other) ? std::optional<Subject>({whole_, seed_, other}) : std::nullopt;
  }

  /// What it needs, gives and is checked by in this dimension.
  [[nodiscard]] const plugin::Manifest& manifest() const { return manifest_; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  [[nodiscard]] int dimension() const { return manifest_.dimension(); }
  /// A generator that starts anew at each call: a check's inputs depend on the seed alone.
  [[nodiscard]] Random random() const { return Random(seed_); }

  /// Parameters in SI in the manifest's order: the default, or a value inside the usual range, or inside the limits.
  /// Defaults at which the model does nothing ("inactive_when") are not typical.
  [[nodiscard]] std::vector<double> typical_parameters() const;
  /// The typical ones, and these with each other word of each choice.
  [[nodiscard]] std::vector<std::vector<double>> parameters_of_each_choice() const;
  /// About half of the parameters anywhere in their usual range or, without one, near their typical value; choices at
  /// random. The others are typical, for many a model takes one of two parameters only, or the lowest usual value where
  /// that is allowed: 0 often switches a part of a model.
  [[nodiscard]] std::vector<double> random_parameters(Random& random) const;

  /// A lattice as the shipped scenes have it: 20 spacings to a cell's radius, tau 1, no inertia.
  [[nodiscard]] plugin::ModelSetting typical_setting() const;
  /// That one and, of a collision operator, one with inertia and another relaxation rate.
  [[nodiscard]] std::vector<plugin::ModelSetting> settings() const;

  [[nodiscard]] plugin::ModelInstance make() const { return make(typical_parameters()); }
  [[nodiscard]] plugin::ModelInstance make(const std::vector<double>& parameters) const {
    return make(parameters, typical_setting());
  }
  [[nodiscard]] plugin::ModelInstance make(const std::vector<double>& parameters,
                                           const plugin::ModelSetting& setting) const {
    return {manifest_, parameters, setting};
  }
  /// Instances of each setting with typical parameters and, in turn, with each other word of each choice; those that
  /// the model refuses are left out.
  [[nodiscard]] std::vector<plugin::ModelInstance> make_each_choice() const;

  /// Whether calls are in single precision: those that the model computes in.
  [[nodiscard]] std::vector<bool> precisions() const;

  /// Names of the arrays that the model is given (its needs, and its state) and gives (with its new state).
  [[nodiscard]] std::vector<std::string> input_arrays() const;
  [[nodiscard]] std::vector<std::string> output_arrays() const;

  /// The manifest's needs; of a model without any its kind's first input, which it is not given: values count elements.
  [[nodiscard]] std::vector<std::string> drawn() const;
  /// Inputs as flowing cells and fluids have them, in lattice units. State is what `steps` with other random inputs
  /// make of its initial value.
  [[nodiscard]] Values random_inputs(const plugin::ModelInstance& instance, std::size_t count, Random& random,
                                     int steps = 5) const;
  /// Inputs of any kind at all: ordinary, tiny, huge, special values, any bits.
  [[nodiscard]] Values any_inputs(std::size_t count, Random& random) const;

 private:
  plugin::Manifest whole_, manifest_;
  std::uint64_t seed_;
};

/// Arrays that stand for a quantity of the manifest: "force" of a collision operator is "force.0" and "force.1", and on
/// D3Q19 "force.2".
std::vector<std::string> arrays_of(const Subject& subject, const std::string& quantity);

}  // namespace rouleau::conform
