#include "slip_constants.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel.hpp"

namespace rouleau::core {

namespace {

constexpr double farthest = 6;  // spacings; all distributions lie well within
constexpr int steps_per_unit = 512;
constexpr int points = static_cast<int>(2 * farthest) * steps_per_unit + 1;

/// Distribution function of a random distance at -farthest ... farthest.
class Distribution {
 public:
  /// From a density, which is normalised here.
  template <class Density>
  explicit Distribution(Density density) : values_(points) {
    double sum = 0;
    for (int i = 0; i < points; ++i) {
      const double before = sum;
      sum += density(place(i));
      values_[i] = (before + sum) / 2;
    }
    for (double& value : values_) value /= sum;
  }
  static double place(int i) { return -farthest + static_cast<double>(i) / steps_per_unit; }
  /// Probability of a distance up to x.
  [[nodiscard]] double operator()(double x) const {
    const double at = (x + farthest) * steps_per_unit;
    if (at <= 0) return 0;
    if (at >= points - 1) return 1;
    const auto i = static_cast<std::size_t>(at);
    return values_[i] + (at - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

 private:
  std::vector<double> values_;
};

/// Expectation of the largest of independent distances with the product of distribution functions `product`.
template <class Product>
double expected_largest(Product product) {
  double integral = 0;
  for (int i = 0; i < points; ++i) {
    const double weight = i == 0 || i == points - 1 ? 0.5 : 1;
    integral += weight * product(Distribution::place(i));
  }
  return farthest - integral / steps_per_unit;
}

/// Density of the distance of a lattice node from a point, weighted as the kernel does, averaged over the point's
/// place.
template <class Kernel>
double kernel_density(double distance) {
  // The node k + first after the base of X lies at k + first - (fraction - shift).
  for (int k = 0; k < Kernel::points; ++k) {
    const double fraction = k + Kernel::first + Kernel::shift - distance;
    if (fraction < 0 || fraction >= 1) continue;
    Pack<double, 1> p, q;
    Kernel::keep(Pack<double, 1>(fraction), p, q);
    return Kernel::constant[k] + Kernel::by_p[k] * p.vector[0] + Kernel::by_q[k] * q.vector[0];
  }
  return 0;
}

Distribution kernel_distribution(KernelKind kernel) {
  return with_kernel(kernel, []<class Kernel>(Kernel) { return Distribution(kernel_density<Kernel>); });
}

/// The area fraction of unit squares; smoothed: once by (1/4, 1/2, 1/4).
double indicator_density(double distance, bool smoothed) {
  const double r = std::abs(distance);
  if (!smoothed) return r < 0.5 ? 1 : 0;
  return r < 0.5 ? 0.5 : (r < 1.5 ? 0.25 : 0);
}

}  // namespace

SlipConstants slip_constants(KernelKind kernel, double viscosity_ratio, int dimension) {
  const Distribution y = kernel_distribution(kernel),
                     z([&](double distance) { return indicator_density(distance, smooths_edges(kernel, dimension)); });
  const double inside = 1 / viscosity_ratio, difference = 1 - inside;
  const double m = expected_largest([&](double x) { return y(x) * y(x); });
  if (difference == 0) return {0, m};
  // Falls with d: the slope lies between -1 and 0 times the larger of both fluidities.
  const auto mismatch = [&](double d) {
    return difference * expected_largest([&](double x) { return y(x + d) * z(x); }) - inside * d;
  };
  double low = -4, high = 4;
  while (high - low > 1e-10) {
    const double middle = (low + high) / 2;
    (mismatch(middle) > 0 ? low : high) = middle;
  }
  const double d = (low + high) / 2;
  const double all = expected_largest([&](double x) { return y(x) * y(x) * z(x - d); });
  const double two = expected_largest([&](double x) { return y(x) * z(x - d); });
  return {d, inside * m + difference * (all - two)};
}

double shift_gain(KernelKind kernel, double shift) {
  return with_kernel(kernel, [shift]<class Kernel>(Kernel) {
    constexpr int waves = 200, places = 32;
    double plain = 0, shifted = 0;
    for (int i = 1; i <= waves; ++i) {
      const double k = M_PI * i / waves;
      double transform = 0;
      for (int j = -3 * places; j <= 3 * places; ++j) {
        const double distance = static_cast<double>(j) / places;
        transform += kernel_density<Kernel>(distance) * std::cos(k * distance) / places;
      }
      const double square = std::pow(k, 4) * transform * transform;
      plain = std::max(plain, square);
      shifted = std::max(shifted, square * (1 + k * k * shift * shift));
    }
    return shifted / plain;
  });
}

KernelResponse kernel_response(KernelKind kernel, double shift) {
  const KernelResponse alone = kernel_response(kernel);
  return shift == 0 ? alone : alone.times(shift_gain(kernel, shift));
}

int surface_slip_smoothing(double square_of_length, double mobility, double stiffness) {
  // 1 - (n^2 - 1) s/18 for long waves: over about a lattice spacing, as of outlines.
  const double least = std::sqrt(1 + 4.5 / square_of_length);
  // At most 6/n^2 of C, of which 0.3 is kept.
  const double stable = std::sqrt(6 / 0.3 * mobility * stiffness / square_of_length);
  constexpr double most = 64;  // enough for 170 times the stiffness that explicit coupling bears
  return static_cast<int>(std::min(std::max(std::round(least), std::ceil(stable)), most));
}

int outline_slip_smoothings(double length, double mobility, double stiffness) {
  const double square = length * length, number = mobility * stiffness / square;
  int passes = std::max(1, static_cast<int>(std::lround(1 / square)));
  constexpr double widest = 4;
  constexpr int most = 256;  // enough for thirty times the stiffness that explicit coupling bears
  // The largest s (1 - s/widest)^p over s is widest/(p + 1) (p/(p + 1))^p.
  while (passes < most && number * widest / (passes + 1) * std::pow(passes / (passes + 1.0), passes) > 0.3) ++passes;
  return std::min(passes, most);
}

}  // namespace rouleau::core
