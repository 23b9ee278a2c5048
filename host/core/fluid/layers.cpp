#include "layers.hpp"

#include <algorithm>

#include "relaxation.hpp"

namespace rouleau::core {

std::vector<double> viscosity_of_rows(const std::vector<Layer>& layers, int rows) {
  if (layers.empty()) return {};
  std::vector<double> viscosity;
  for (int row = 0; row < rows; ++row) {
    double fluidity = 0, rest = 1;  // 1/viscosity, and the share of the row that no layer has
    for (const Layer& layer : layers) {
      const double share = std::min(layer.to, row + 1.0) - std::max(layer.from, static_cast<double>(row));
      if (!(share > 1e-9)) continue;  // borders on a row's edge may be off by rounding
      fluidity += share / layer.viscosity_ratio;
      rest -= share;
    }
    viscosity.push_back(rest == 1 ? 1 : 1 / (fluidity + (rest > 1e-9 ? rest : 0)));
  }
  return viscosity;
}

double rate_of_layer(double relaxation_rate, double viscosity_ratio) {
  if (viscosity_ratio == 1) return relaxation_rate;
  return 1 / relaxation_time_of(viscosity_ratio * viscosity_of(1 / relaxation_rate));
}

std::vector<ProfilePoint> layered_profile(const std::vector<double>& viscosity_of_rows, double viscosity,
                                          const WallVelocity& walls, double body_force_x) {
  // The stress is that at the lower wall less force times y; what the walls' speeds leave of it follows from
  // u(top) - u(bottom) = sum of the rows' mean stress over viscosity.
  double fluidity = 0, bent = 0, y = 0;
  for (const double ratio : viscosity_of_rows) {
    fluidity += 1 / (ratio * viscosity);
    bent += body_force_x * (y + 0.5) / (ratio * viscosity);
    y += 1;
  }
  double stress = (walls.upper - walls.lower + bent) / fluidity, u = walls.lower;
  std::vector<ProfilePoint> profile;
  for (const double ratio : viscosity_of_rows) {
    const double mu = ratio * viscosity, middle = stress - body_force_x / 2;
    profile.push_back({u + (stress + middle) / 4 / mu, middle / mu});
    u += middle / mu;
    stress -= body_force_x;
  }
  return profile;
}

}  // namespace rouleau::core
