#include "tension_rate.hpp"

#include <algorithm>

namespace rouleau::core {

double rate_mobility(double mean_rest_length) { return 4 * std::max(1.0, 1 / mean_rest_length); }

/// Thomas' elimination for the matrix without its two corners, which Sherman and Morrison's formula brings back.
void solve(const TensionRateStep& step) {
  const auto n = static_cast<std::size_t>(step.count);
  const auto [cosine, upper, x, z] = step.workspace;  // cosine of the angle between segments i and i + 1
  double* tension = step.tension;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = i + 1 < n ? i + 1 : 0;
    cosine[i] = step.tangent_x[i] * step.tangent_x[next] + step.tangent_y[i] * step.tangent_y[next];
  }
  const auto weight = [&](std::size_t i) { return step.by_rate[i] * step.inverse_rest_length[i] * step.mobility; };
  const double lower_corner = -weight(n - 1) * cosine[n - 1], upper_corner = -weight(0) * cosine[n - 1];
  const double gamma = -(1 + 2 * weight(0));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i > 0 ? i - 1 : n - 1, after = i + 1 < n ? i + 1 : 0;
    const double w = weight(i);
    const double difference = cosine[i] * tension[after] - 2 * tension[i] + cosine[before] * tension[before];
    double right = step.by_rate[i] * step.rate[i] - w * difference, corner = 0, diagonal = 1 + 2 * w;
    if (i == 0) {
      diagonal -= gamma;
      corner = gamma;
    } else if (i + 1 == n) {
      diagonal -= lower_corner * upper_corner / gamma;
      corner = lower_corner;
    }
    if (i > 0) {
      const double below = -w * cosine[before];
      diagonal -= below * upper[i - 1];
      right -= below * x[i - 1];
      corner -= below * z[i - 1];
    }
    const double pivot = 1 / diagonal;
    upper[i] = -w * cosine[i] * pivot;
    x[i] = right * pivot;
    z[i] = corner * pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) {
    x[i] -= upper[i] * x[i + 1];
    z[i] -= upper[i] * z[i + 1];
  }
  const double ratio = upper_corner / gamma;
  const double factor = (x[0] + ratio * x[n - 1]) / (1 + z[0] + ratio * z[n - 1]);
  for (std::size_t i = 0; i < n; ++i) tension[i] = x[i] - factor * z[i];
}

}  // namespace rouleau::core
