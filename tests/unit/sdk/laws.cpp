// The shipped potentials and membrane laws: forces are derivatives of energies, whatever the block and instruction set.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#define rouleau_open_v1 open_morse
#include "interaction/morse/morse.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_neo_hookean
#include "membrane/neo-hookean/neo-hookean.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_bending
#include "membrane/bending/bending.cpp"
#undef rouleau_open_v1

#include "instruction_sets.hpp"
#include "model_setup.hpp"

namespace {

using namespace rouleau::test;

/// What a law gives for a list of arguments.
struct Values {
  std::vector<double> energy, slope, slope_by_argument;
};

/// Evaluates a law at all arguments, in blocks of at most `block` elements at addresses that no vector load likes.
using Evaluate = std::function<Values(const std::vector<double>& arguments, std::size_t block)>;

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

struct Law {
  const char* name;
  double sign;       ///< slope = sign x d energy / d argument
  double low, high;  ///< arguments
  Self self;
  std::function<Evaluate(const void* self, const std::string& set)> with;
};

void fill_morse(rouleau_interaction_block& block, const double* in, double* slope, double* derivative) {
  block.distance = in;
  block.force = slope;
  block.force_by_distance = derivative;
}
void fill_tension(rouleau_membrane_block& block, const double* in, double* slope, double* derivative) {
  block.stretch = in;
  block.tension = slope;
  block.tension_by_stretch = derivative;
}
void fill_moment(rouleau_membrane_block& block, const double* in, double* slope, double* derivative) {
  block.curvature = in;  // the rest curvature is not given: zero
  block.moment = slope;
  block.moment_by_curvature = derivative;
}

template <class Loop, class Block>
auto evaluator(void (*fill)(Block&, const double*, double*, double*)) {
  return [fill](const void* self, const std::string& set) -> Evaluate {
    const auto function = pick_for<Loop, const void*, const Block*>(set);
    return [=](const std::vector<double>& arguments, std::size_t block) {
      return evaluate<Block>(arguments, block, fill, function, self);
    };
  };
}

std::vector<Law> laws() {
  std::vector<Law> all;
  all.push_back({"morse", -1, 0.5, 35,
                 make(*open_morse(0)->models[0],
                      {{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 36}}}),
                 evaluator<rouleau::detail::InteractionLoop<Morse>>(fill_morse)});
  all.push_back({"neo-hookean", 1, 0.3, 3, make(*open_neo_hookean(0)->models[0], {{{"shear_modulus", 1.7}}}),
                 evaluator<rouleau::detail::MembraneLoop<NeoHookean>>(fill_tension)});
  all.push_back({"bending", 1, -2, 2, make(*open_bending(0)->models[0], {{{"modulus", 0.8}}}),
                 evaluator<rouleau::detail::MembraneLoop<Bending>>(fill_moment)});
  return all;
}

std::vector<double> random_arguments(const Law& law, std::size_t count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(law.low, law.high);
  std::vector<double> arguments(count);
  for (double& argument : arguments) argument = uniform(engine);
  return arguments;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

double largest(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

}  // namespace

TEST_CASE("forces are derivatives of the energy and their derivatives are theirs, by central differences") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  constexpr std::size_t whole = 1000, count = 211;
  for (const Law& law : laws()) {
    for (const auto& set : instruction_sets()) {
      CAPTURE(law.name, set);
      const Evaluate f = law.with(law.self.get(), set);
      const auto at = random_arguments(law, count, seed);
      // The error of central differences is h^2/6 times a third derivative, and epsilon/h from rounding: about 1e-10
      // of the law's own size for this step, a little more where it is steepest.
      constexpr double h = 1e-5, tolerance = 1e-8;
      std::vector<double> left(at), right(at);
      for (double& x : left) x -= h;
      for (double& x : right) x += h;
      const Values middle = f(at, whole), below = f(left, whole), above = f(right, whole);
      const double scale = largest(middle.energy) + largest(middle.slope) + largest(middle.slope_by_argument);
      for (std::size_t i = 0; i < count; ++i) {
        CAPTURE(at[i]);
        REQUIRE(std::abs(middle.slope[i] - law.sign * (above.energy[i] - below.energy[i]) / (2 * h)) <
                tolerance * scale);
        REQUIRE(std::abs(middle.slope_by_argument[i] - (above.slope[i] - below.slope[i]) / (2 * h)) <
                tolerance * scale);
      }
    }
  }
}

TEST_CASE("a law gives the same bits for any size of block") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  for (const Law& law : laws()) {
    for (const auto& set : instruction_sets()) {
      const Evaluate f = law.with(law.self.get(), set);
      const auto at = random_arguments(law, 211, seed);
      const Values whole = f(at, 1000);
      for (std::size_t size = 1; size <= 37; ++size) {
        CAPTURE(law.name, set, size);
        const Values blocks = f(at, size);
        REQUIRE(same_bits(blocks.energy, whole.energy));
        REQUIRE(same_bits(blocks.slope, whole.slope));
        REQUIRE(same_bits(blocks.slope_by_argument, whole.slope_by_argument));
      }
    }
  }
}

TEST_CASE("all instruction sets give the same law but for rounding") {
  for (const Law& law : laws()) {
    const auto at = random_arguments(law, 211, 1);
    const Values baseline = law.with(law.self.get(), "baseline")(at, 64);
    for (const auto& set : instruction_sets()) {
      CAPTURE(law.name, set);
      const Values values = law.with(law.self.get(), set)(at, 64);
      for (std::size_t i = 0; i < at.size(); ++i) {
        // Sums of a few terms of the law's largest size at most, each rounded once.
        REQUIRE(std::abs(values.energy[i] - baseline.energy[i]) < 2e-15 * largest(baseline.energy));
        REQUIRE(std::abs(values.slope[i] - baseline.slope[i]) < 2e-15 * largest(baseline.slope));
      }
    }
  }
}

TEST_CASE("the Morse potential is deepest at the distance without force and agrees with its formula") {
  const Self self =
      make(*open_morse(0)->models[0], {{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 36}}});
  CHECK(open_morse(0)->models[0]->interaction->cutoff(self.get()) == 36);
  const auto f = evaluator<rouleau::detail::InteractionLoop<Morse>>(fill_morse)(self.get(), "baseline");
  const Values values = f({2.5, 1.0, 5.0}, 8);
  CHECK(values.energy[0] == -1.3);
  CHECK(values.slope[0] == 0);
  CHECK(values.slope[1] > 0);
  CHECK(values.slope[2] < 0);
  const double s = std::exp(0.4 * 1.5);
  CHECK(values.energy[1] == Approx(1.3 * s * (s - 2)).epsilon(1e-14));
}

TEST_CASE("membranes at rest carry neither tension nor moment nor energy") {
  const Self neo = make(*open_neo_hookean(0)->models[0], {{{"shear_modulus", 1.7}}});
  const Values tension =
      evaluator<rouleau::detail::MembraneLoop<NeoHookean>>(fill_tension)(neo.get(), "baseline")({1.0}, 1);
  CHECK(std::abs(tension.energy[0]) < 1e-15);
  CHECK(tension.slope[0] == 0);
  CHECK(tension.slope_by_argument[0] == Approx(3 * 1.7).epsilon(1e-15));  // the small-strain modulus is 3 Es
}

TEST_CASE("outputs that the host does not want are not written") {
  const Self self =
      make(*open_morse(0)->models[0], {{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 36}}});
  const double distance[3] = {1, 2, 3};
  double force[3] = {};
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = 3;
  block.distance = distance;
  block.force = force;
  open_morse(0)->models[0]->interaction->compute(self.get(), &block);
  CHECK(force[0] > 0);
  CHECK(force[2] < 0);
}
