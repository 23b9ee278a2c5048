// One lattice node's numbers and their moments, as the checks of collision operators compare them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <rouleau/d2q9.hpp>

#include "trials.hpp"

namespace rouleau::conform {

struct CollisionNode {
  std::array<double, 9> f{};  ///< deviations from rest, f_q - w_q
  std::array<double, 2> force{}, velocity{};
  double relaxation_rate = 0;
  bool inertia = false;

  [[nodiscard]] double density() const {
    double sum = 0;
    for (const double value : f) sum += value;
    return sum;
  }
  [[nodiscard]] double momentum(std::size_t k) const {
    double sum = 0;
    for (std::size_t q = 0; q < 9; ++q) sum += f[q] * d2q9::velocity[q][k];
    return sum;
  }
  /// Sum of the sizes of all its numbers: what rounding is relative to.
  [[nodiscard]] double size() const {
    double sum = std::abs(force[0]) + std::abs(force[1]);
    for (const double value : f) sum += std::abs(value);
    return sum;
  }
  /// Largest difference of populations or velocities.
  [[nodiscard]] double distance(const CollisionNode& other) const {
    double most = 0;
    const auto see = [&](double a, double b) {
      if (!(std::abs(a - b) <= most)) most = std::abs(a - b);
    };
    for (std::size_t q = 0; q < 9; ++q) see(f[q], other.f[q]);
    for (std::size_t k = 0; k < 2; ++k) see(velocity[k], other.velocity[k]);
    return most;
  }

  // Components xy and xx - yy of what relaxes with the shear stress.
  [[nodiscard]] std::array<double, 2> shear_stress() const {
    return {(f[5] + f[7]) - (f[6] + f[8]), (f[1] + f[3]) - (f[2] + f[4])};
  }
  /// With the velocity sum f c + F/2.
  [[nodiscard]] std::array<double, 2> equilibrium_stress() const {
    if (!inertia) return {};
    const double u = momentum(0) + force[0] / 2, v = momentum(1) + force[1] / 2;
    return {u * v, u * u - v * v};
  }
  [[nodiscard]] std::array<double, 2> source_stress() const {
    if (!inertia) return {};
    const double u = momentum(0) + force[0] / 2, v = momentum(1) + force[1] / 2;
    return {u * force[1] + v * force[0], 2 * (u * force[0] - v * force[1])};
  }

  /// He and Luo's equilibrium (J. Stat. Phys. 88, 1997) with reference density 1; without inertia its linear part.
  void set_equilibrium(double density, const std::array<double, 2>& u, bool with_inertia) {
    for (std::size_t q = 0; q < 9; ++q) {
      const double along = d2q9::velocity[q][0] * u[0] + d2q9::velocity[q][1] * u[1];
      f[q] = density + 3 * along;
      if (with_inertia) f[q] += 4.5 * along * along - 1.5 * (u[0] * u[0] + u[1] * u[1]);
      f[q] *= d2q9::weight[q];
    }
  }
  void remove_momentum() {
    const double x = momentum(0), y = momentum(1);
    for (std::size_t q = 0; q < 9; ++q) {
      f[q] -= 3 * d2q9::weight[q] * (d2q9::velocity[q][0] * x + d2q9::velocity[q][1] * y);
    }
  }

  /// Writes populations and, where there is one, the force.
  void store(Values& values, std::size_t i) const {
    for (std::size_t q = 0; q < 9; ++q) values.at("populations." + std::to_string(q))[i] = f[q];
    for (std::size_t k = 0; k < 2; ++k) {
      const auto found = values.find("force." + std::to_string(k));
      if (found != values.end()) found->second[i] = force[k];
    }
  }
};

/// Node i of inputs or outputs; what they do not hold is 0, the relaxation rate that of the setup.
inline CollisionNode node_of(const Values& values, std::size_t i, const Trial& trial) {
  CollisionNode node;
  const auto get = [&](const std::string& name, double otherwise) {
    const auto found = values.find(name);
    return found == values.end() ? otherwise : found->second[i];
  };
  for (std::size_t q = 0; q < 9; ++q) node.f[q] = get("populations." + std::to_string(q), 0);
  for (std::size_t k = 0; k < 2; ++k) {
    node.force[k] = get("force." + std::to_string(k), 0);
    node.velocity[k] = get("velocity." + std::to_string(k), 0);
  }
  node.relaxation_rate = get("relaxation_rate", trial.setting.relaxation_rate);
  node.inertia = trial.setting.inertia;
  return node;
}

}  // namespace rouleau::conform
