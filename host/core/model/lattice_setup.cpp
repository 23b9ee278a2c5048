#include "lattice_setup.hpp"

#include <array>
#include <rouleau/d2q9.hpp>
#include <rouleau/d3q19.hpp>

namespace rouleau::core {

namespace {

template <class Set>
void describe(rouleau_setup& setup) {
  static const auto velocities = [] {
    std::array<double, std::size_t{Set::velocity_count} * Set::dimension> flat{};
    for (int q = 0; q < Set::velocity_count; ++q) {
      for (int k = 0; k < Set::dimension; ++k) flat[Set::dimension * q + k] = Set::velocity[q][k];
    }
    return flat;
  }();
  setup.dimension = Set::dimension;
  setup.velocity_count = Set::velocity_count;
  setup.velocities = velocities.data();
  setup.weights = Set::weight;
}

}  // namespace

rouleau_setup lattice_setup(int dimension, double relaxation_rate, bool inertia) {
  rouleau_setup setup{};
  setup.struct_size = sizeof setup;
  setup.host_minor = ROULEAU_ABI_MINOR;
  setup.length_unit = setup.time_unit = setup.mass_unit = 1;
  if (dimension == 2) {
    describe<D2Q9>(setup);
  } else {
    describe<D3Q19>(setup);
  }
  setup.sound_speed_squared = d2q9::sound_speed_squared;
  setup.relaxation_rate = relaxation_rate;
  setup.inertia = inertia ? 1 : 0;
  return setup;
}

}  // namespace rouleau::core
