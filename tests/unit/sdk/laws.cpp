// Every shipped potential and law of segments or nodes: forces are derivatives of energies, whatever the block and the
// instruction set.
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "instruction_sets.hpp"
#include "shipped_models.hpp"

#define rouleau_open_v1 open_area
#include "membrane/area/area.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_bending
#include "membrane/bending/bending.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_depletion
#include "interaction/depletion/depletion.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_hooke
#include "membrane/hooke/hooke.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_inextensible
#include "membrane/inextensible/inextensible.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_lennard_jones
#include "interaction/lennard-jones/lennard-jones.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_morse
#include "interaction/morse/morse.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_neo_hookean
#include "membrane/neo-hookean/neo-hookean.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_perimeter
#include "membrane/perimeter/perimeter.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_repulsion
#include "interaction/repulsion/repulsion.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_skalak
#include "membrane/skalak/skalak.cpp"
#undef rouleau_open_v1

namespace {

using namespace rouleau::test;

/// Evaluates a law at all arguments, in blocks of at most `block` elements.
using Evaluate = std::function<Values(const std::vector<double>& arguments, std::size_t block)>;

struct Law {
  std::string name;
  double sign;       ///< slope = sign x d energy / d argument
  double low, high;  ///< arguments; the law is smooth between them
  Self self;
  std::function<Evaluate(const void* self, const std::string& set)> with;
};

template <class Loop, class Block>
auto evaluator(void (*fill_block)(Block&, const double*, double*, double*)) {
  return [fill_block](const void* self, const std::string& set) -> Evaluate {
    const auto function = pick_for<Loop, const void*, const Block*>(set);
    return [=](const std::vector<double>& arguments, std::size_t block) {
      return evaluate<Block>(arguments, block, fill_block, function, self);
    };
  };
}

std::vector<Law> laws() {
  std::vector<Law> all;
  const auto potential = [&](const char* name, double low, double high, const rouleau_model& model, const Setup& setup,
                             auto with) {
    all.push_back({name, -1, low, high, make(model, setup), with});
  };
  const auto law = [&](const char* name, double low, double high, const rouleau_model& model, const Setup& setup,
                       auto with) {
    all.push_back({name, 1, low, high, make(model, setup), with});
  };
  using namespace rouleau::detail;

  const Setup well{{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 36}}};
  potential("morse", 0.5, 35, *open_morse(0)->models[0], well, evaluator<InteractionLoop<Morse>>(fill));
  potential("lennard-jones", 1.9, 12, *open_lennard_jones(0)->models[0], well,
            evaluator<InteractionLoop<LennardJones>>(fill));
  potential("lennard-jones-shifted", 1.9, 12, *open_lennard_jones(0)->models[1], well,
            evaluator<InteractionLoop<ShiftedLennardJones>>(fill));
  potential("repulsion", 0.1, 4.9, *open_repulsion(0)->models[0], {{{"strength", 1.3}, {"cutoff", 5}}},
            evaluator<InteractionLoop<Repulsion>>(fill));
  // At 5 nm, where the force's own continuation begins, and at 17.9 nm, where the polymer gets in, the force has a kink
  // and a jump.
  const auto depletion = evaluator<InteractionLoop<Depletion>>(fill);
  potential("depletion, pressed", 0.1, 4.9, *open_depletion(0)->models[0], dextran(70, 3, 5e-4, 0), depletion);
  potential("depletion, near", 5.1, 9.9, *open_depletion(0)->models[0], dextran(70, 3, 5e-4, 0), depletion);
  potential("depletion, in the well", 10.1, 17.5, *open_depletion(0)->models[0], dextran(70, 3, 5e-4, 0), depletion);
  potential("depletion, apart", 18, 30, *open_depletion(0)->models[0], dextran(70, 3, 5e-4, 0), depletion);
  // Half a unit is 245 nm.
  potential("depletion, regularised", 0.2, 6, *open_depletion(0)->models[0], dextran(70, 3, 5e-4, 1, 490e-9, 1, 1e-6),
            depletion);

  for (const double transverse : {0.0, 1.0}) {
    law(transverse == 0 ? "neo-hookean, free" : "neo-hookean, clamped", 0.3, 3, *open_neo_hookean(0)->models[0],
        {{{"shear_modulus", 1.7}, {"transverse", transverse}}}, evaluator<MembraneLoop<NeoHookean>>(fill_tension));
    for (const double area : {0.0, 1.0, 50.0}) {
      law(transverse == 0 ? "skalak, free" : "skalak, clamped", 0.3, 3, *open_skalak(0)->models[0],
          {{{"shear_modulus", 1.7}, {"area_dilation", area}, {"transverse", transverse}}},
          evaluator<MembraneLoop<Skalak>>(fill_tension));
    }
  }
  law("hooke", 0.3, 3, *open_hooke(0)->models[0], {{{"stretching_modulus", 1.7}, {"poisson_ratio", 0.3}}},
      evaluator<MembraneLoop<Hooke>>(fill_tension));
  law("inextensible", 0.3, 3, *open_inextensible(0)->models[0], {{{"stretching_modulus", 1.7}}},
      evaluator<MembraneLoop<Inextensible>>(fill_tension));
  law("bending", -2, 2, *open_bending(0)->models[0],
      {{{"modulus", 0.8}, {"rest_curvature", 2}, {"rest_curvature_value", 0.7}}},
      evaluator<MembraneLoop<Bending>>(fill_moment));
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

/// Mean difference between slopes and central differences of step h, for the energy and for the slope itself.
struct DifferenceError {
  double slope = 0, derivative = 0;
};
DifferenceError difference_error(const Evaluate& f, const Law& law, const std::vector<double>& at, double h) {
  std::vector<double> left(at), right(at);
  for (double& x : left) x -= h;
  for (double& x : right) x += h;
  const Values middle = f(at, at.size()), below = f(left, at.size()), above = f(right, at.size());
  DifferenceError error;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double n = static_cast<double>(at.size());
    error.slope += std::abs(middle.slope[i] - law.sign * (above.energy[i] - below.energy[i]) / (2 * h)) / n;
    error.derivative += std::abs(middle.slope_by_argument[i] - (above.slope[i] - below.slope[i]) / (2 * h)) / n;
  }
  return error;
}

}  // namespace

TEST_CASE("forces and their derivatives are those of the energy: central differences come to them in second order") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  for (const Law& law : laws()) {
    for (const auto& set : instruction_sets()) {
      CAPTURE(law.name, set);
      const Evaluate f = law.with(law.self.get(), set);
      const auto at = random_arguments(law, 211, seed);
      const Values values = f(at, at.size());
      const double h = 2e-3 * (law.high < 1 ? law.high : 1);
      const DifferenceError coarse = difference_error(f, law, at, h), fine = difference_error(f, law, at, h / 2);
      // Differences of quadratic energies and of linear forces are exact but for rounding, epsilon/h of the values.
      const auto check = [&](double wide, double narrow, double size) {
        const double rounding = 1e-15 / h * size;
        if (wide < 100 * rounding) {
          CHECK(narrow < 100 * rounding);
        } else {
          CHECK(std::log2(wide / narrow) == Approx(2).margin(0.05));
        }
      };
      check(coarse.slope, fine.slope, largest(values.energy) + largest(values.slope));
      check(coarse.derivative, fine.derivative, largest(values.slope) + largest(values.slope_by_argument));
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
