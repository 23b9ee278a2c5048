#include "membrane_wave.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace rouleau::monitor {

namespace {

constexpr std::size_t fewest_nodes = 12;
/// Of the nodes across the line that they are on, as a share of that along it: what is below is rounding.
constexpr double least_spread = 1e-12;

/// One column for x, one for y.
using Vectors = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Velocities without the uniform gradient that fits them best.
Vectors without_smooth_flow(const Vectors& nodes, const Vectors& velocity) {
  const Vectors place = nodes.rowwise() - nodes.colwise().mean();
  Vectors rest = velocity.rowwise() - velocity.colwise().mean();
  // Each direction in which the nodes spread has a gradient of its own; across nodes on one line there is none.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread;
  spread.computeDirect(place.transpose() * place);
  for (int k = 0; k < 2; ++k) {
    if (!(spread.eigenvalues()[k] > least_spread * spread.eigenvalues()[1])) continue;
    const Eigen::VectorXd along = place * spread.eigenvectors().col(k);
    rest -= along * (along.transpose() * rest) / spread.eigenvalues()[k];
  }
  return rest;
}

/// Unit tangents from the chord over two segments either way: waves of two and of four segments do not turn it.
Vectors tangents(const Vectors& nodes) {
  const Eigen::Index count = nodes.rows();
  Vectors tangent(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::RowVector2d chord = nodes.row((i + 2) % count) - nodes.row((i + count - 2) % count);
    const double length = chord.norm();
    tangent.row(i) = length > 0 ? Eigen::RowVector2d(chord / length) : Eigen::RowVector2d(1, 0);
  }
  return tangent;
}

/// The part of a periodic sequence with more than smooth_wave_numbers periods, and its energy by wave number.
struct ShortWaves {
  std::vector<double> value, energy;
};

ShortWaves short_waves(const Eigen::VectorXd& sequence) {
  const auto count = static_cast<std::size_t>(sequence.size());
  std::vector<std::complex<double>> turn(count);
  for (std::size_t j = 0; j < count; ++j) {
    turn[j] = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(count));
  }
  ShortWaves waves{std::vector<double>(count, 0.0), std::vector<double>(count / 2 + 1, 0.0)};
  for (std::size_t k = smooth_wave_numbers + 1; k <= count / 2; ++k) {
    std::complex<double> amplitude = 0;
    for (std::size_t i = 0; i < count; ++i) amplitude += sequence[static_cast<Eigen::Index>(i)] * turn[i * k % count];
    amplitude /= static_cast<double>(count);
    const double twice = 2 * k == count ? 1 : 2;  // wave numbers k and count - k are one, but for the shortest
    waves.energy[k] = twice * std::norm(amplitude);
    for (std::size_t i = 0; i < count; ++i)
      waves.value[i] += twice * (amplitude * std::conj(turn[i * k % count])).real();
  }
  return waves;
}

}  // namespace

MembraneWave find_wave(std::span<const double> x, std::span<const double> y, std::span<const double> velocity_x,
                       std::span<const double> velocity_y) {
  MembraneWave wave;
  if (x.size() < fewest_nodes) return wave;
  const auto count = static_cast<Eigen::Index>(x.size());
  const auto columns = [count](std::span<const double> a, std::span<const double> b) {
    Vectors v(count, 2);
    v.col(0) = Eigen::Map<const Eigen::VectorXd>(a.data(), count);
    v.col(1) = Eigen::Map<const Eigen::VectorXd>(b.data(), count);
    return v;
  };
  const Vectors nodes = columns(x, y), velocity = columns(velocity_x, velocity_y);
  if (!nodes.allFinite() || !velocity.allFinite()) return wave;

  const Vectors rest = without_smooth_flow(nodes, velocity), tangent = tangents(nodes);
  const ShortWaves along =
      short_waves(rest.col(0).cwiseProduct(tangent.col(0)) + rest.col(1).cwiseProduct(tangent.col(1)));
  const ShortWaves across =
      short_waves(rest.col(1).cwiseProduct(tangent.col(0)) - rest.col(0).cwiseProduct(tangent.col(1)));
  double tangential = 0, normal = 0, most = 0;
  for (std::size_t k = 0; k < along.energy.size(); ++k) {
    tangential += along.energy[k];
    normal += across.energy[k];
    const double energy = along.energy[k] + across.energy[k];
    if (energy <= most) continue;
    most = energy;
    wave.wavelength = static_cast<double>(count) / static_cast<double>(k);
  }
  for (std::size_t i = 0; i < along.value.size(); ++i) {
    wave.speed = std::max(wave.speed, std::hypot(along.value[i], across.value[i]));
  }
  const double fastest = velocity.rowwise().norm().maxCoeff();
  if (!(fastest > 0) || !(most > 0)) return {};
  wave.tangential_share = tangential / (tangential + normal);
  wave.prominence = wave.speed / fastest;
  return wave;
}

}  // namespace rouleau::monitor
