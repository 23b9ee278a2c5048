// Two capsules in shear, with the simulator as a library: models compiled in, no file read. Prints how far each
// deforms.
//
//     cmake -S . -B build && cmake --build build && build/core      with this CMakeLists.txt:
//     find_package(Rouleau REQUIRED COMPONENTS core)
//     add_executable(core core.cpp)
//     target_link_libraries(core PRIVATE Rouleau::core)
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <rouleau/collision.hpp>
#include <rouleau/core.hpp>
#include <rouleau/membrane.hpp>

struct Bgk {  // one relaxation rate: f_q -= omega (f_q - f_q^eq), with Guo's forcing
  explicit Bgk(const rouleau::Parameters&) {}
  template <class Node, class S>
  void operator()(const Node& node, const S& omega, S (&after)[9]) const {
    rouleau::d2q9::for_each_velocity(
        [&](auto q) { after[q] = (1.0 - omega) * node.f[q] + node.even_gain(q, omega) + node.odd_gain(q, omega); });
  }
};

struct Hooke {  // tension Es (stretch - 1)
  double Es;
  explicit Hooke(const rouleau::Parameters& p) : Es{p["modulus"]} {}
  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S strain = segment.stretch - 1.0;
    return {0.5 * Es * strain * strain, Es * strain, S(Es)};
  }
};

int main() {
  namespace core = rouleau::core;
  rouleau::SolverSetup setup;
  setup.domain = {{128, 64}, {true, false}};
  setup.walls = {-0.01, 0.01};
  setup.developed = true;
  setup.collision = core::collision_operator(rouleau::collision<Bgk>("bgk", "1"), setup.tau);
  setup.cell_types = {{{core::membrane_law(rouleau::membrane<Hooke>("hooke", "1"),
                                           {.parameters = {{"modulus", 0.01}},
                                            .needs = {"stretch"},
                                            .gives = {"tension", "energy", "tension_by_stretch"}})}}};

  const int nodes = 80;
  std::vector<double> x, y;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 2 * std::numbers::pi * i / nodes;
    x.push_back(12 * std::cos(angle)), y.push_back(12 * std::sin(angle));
  }
  rouleau::Membranes capsules;
  capsules.types = {std::make_shared<const rouleau::core::RestShape>(rouleau::core::make_rest_shape(x, y))};
  for (const double at : {32.0, 96.0}) add_cell(capsules, 0, at, 31.5, 0);

  rouleau::Solver<double> solver(setup, capsules);
  solver.start();
  for (int k = 0; k < 5; ++k) {
    solver.step(1000);
    for (const auto& cell : capsules.cells)
      std::printf("%.4f ", rouleau::core::inertia_ellipse(capsules, cell).deformation);
    std::printf("\n");
  }
}
