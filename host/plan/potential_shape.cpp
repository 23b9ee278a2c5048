#include "potential_shape.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rouleau::plan {

namespace {

/// A potential at many distances.
struct Curve {
  std::vector<double> distance, energy, force, stiffness;
};

/// Central differences where the model gives no derivative itself.
std::vector<double> differences(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> slope(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) slope[i] = (y[i + 1] - y[i - 1]) / (x[i + 1] - x[i - 1]);
  return slope;
}

Curve evaluate(const core::Potential& potential, std::vector<double> distance) {
  const std::size_t count = distance.size();
  Curve curve{std::move(distance), {}, std::vector<double>(count), {}};
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(count);
  block.time_step = 1;
  block.distance = curve.distance.data();
  const std::vector<double> at_rest(count, 0.0);
  if (potential.reads("normal_velocity")) block.normal_velocity = at_rest.data();
  if (potential.reads("tangential_velocity")) block.tangential_velocity = at_rest.data();
  if (potential.reads("sliding_speed")) block.sliding_speed = at_rest.data();
  block.force = curve.force.data();
  if (potential.writes("energy")) {
    curve.energy.resize(count);
    block.energy = curve.energy.data();
  }
  const bool derivative = potential.writes("force_by_distance");
  if (derivative) {
    curve.stiffness.resize(count);
    block.force_by_distance = curve.stiffness.data();
  }
  potential.compute(&block);
  if (!derivative) curve.stiffness = differences(curve.distance, curve.force);
  return curve;
}

/// `from` + `first`, ..., `to`, with equal ratios of the distances from `from`.
std::vector<double> spread(double from, double first, double to, int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  const double ratio = (to - from) / first;
  for (int i = 0; i < count; ++i) values[i] = from + first * std::pow(ratio, i / (count - 1.0));
  values.back() = to;
  return values;
}

/// Where the force turns from repulsion, at `low`, to attraction, at `high`.
double turning_point(const core::Potential& potential, double low, double high) {
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (force_at(potential, middle) > 0 ? low : high) = middle;
  }
  return high;
}

/// Work that takes surfaces from the first distance out of the potential; by the trapezium rule where the model gives
/// no energy.
double work(const Curve& curve) {
  if (!curve.energy.empty()) return -curve.energy.front();
  double sum = 0;
  for (std::size_t i = 1; i < curve.distance.size(); ++i)
    sum -= (curve.force[i] + curve.force[i - 1]) / 2 * (curve.distance[i] - curve.distance[i - 1]);
  return sum;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

double force_at(const core::Potential& potential, double distance) {
  return evaluate(potential, {distance}).force.front();
}

PotentialShape find_shape(const core::Potential& potential) {
  constexpr int samples = 2000;
  constexpr double finest = 1e-7;
  const double cutoff = potential.table->cutoff(potential.self.get());
  PotentialShape shape{std::nullopt, cutoff, 0};
  if (!(cutoff > 0)) return shape;
  const Curve curve = evaluate(potential, spread(0, finest * cutoff, cutoff, samples));
  double bottom_stiffness = 0;
  const auto consider = [&](double bottom) {
    std::vector<double> distances = spread(bottom, finest * (bottom > 0 ? bottom : cutoff), cutoff, samples);
    if (bottom > 0) distances.insert(distances.begin(), bottom);
    const Curve outside = evaluate(potential, std::move(distances));
    const Well well{bottom, work(outside), -*std::min_element(outside.force.begin(), outside.force.end())};
    // A hollow on the slope of a barrier, out of which membranes gain energy by leaving, holds nothing.
    if (!(well.attraction > 0) || !(well.depth > 0) || (shape.well && shape.well->depth >= well.depth)) return;
    shape.well = well;
    bottom_stiffness = largest(outside.stiffness);
  };
  if (curve.force.front() < 0) consider(0);
  for (std::size_t i = 1; i < curve.force.size(); ++i) {
    // A narrow well may have died away to nothing already where the next sample lies.
    if (curve.force[i - 1] > 0 && !(curve.force[i] > 0))
      consider(turning_point(potential, curve.distance[i - 1], curve.distance[i]));
  }
  if (shape.well) {
    shape.stiffness = bottom_stiffness;
  } else {
    const auto middle = std::lower_bound(curve.distance.begin(), curve.distance.end(), cutoff / 2);
    shape.stiffness = largest({curve.stiffness.begin() + (middle - curve.distance.begin()), curve.stiffness.end()});
  }
  return shape;
}

}  // namespace rouleau::plan
