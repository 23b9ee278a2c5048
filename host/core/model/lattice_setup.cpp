#include "lattice_setup.hpp"

#include <array>
#include <rouleau/d2q9.hpp>

namespace rouleau::core {

rouleau_setup lattice_setup(double relaxation_rate, bool inertia) {
  static const std::array<double, 18> velocities = [] {
    std::array<double, 18> flat{};
    for (int q = 0; q < 9; ++q) {
      for (int k = 0; k < 2; ++k) flat[2 * q + k] = d2q9::velocity[q][k];
    }
    return flat;
  }();
  rouleau_setup setup{};
  setup.struct_size = sizeof setup;
  setup.host_minor = ROULEAU_ABI_MINOR;
  setup.length_unit = setup.time_unit = setup.mass_unit = 1;
  setup.dimension = 2;
  setup.velocity_count = d2q9::velocity_count;
  setup.velocities = velocities.data();
  setup.weights = d2q9::weight;
  setup.sound_speed_squared = d2q9::sound_speed_squared;
  setup.relaxation_rate = relaxation_rate;
  setup.inertia = inertia ? 1 : 0;
  return setup;
}

}  // namespace rouleau::core
