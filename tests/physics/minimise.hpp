// The place where a smooth function is least, near a start, and surfaces as such a place.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "core/surface/surfaces.hpp"

namespace rouleau::test {

struct Minimising {
  double gradient_at_end;  ///< the search ends when no component is larger
  double longest_step;     ///< of any component, at once
  double rounding = 1e-9;  ///< of values, and how far they may jump without a gradient that says so
  int most_steps = 20000;
  double least_length = 1e-12;  ///< the search ends, too, where so small a share of a step does not lead down
};

/// Limited-memory BFGS with halved steps (Nocedal and Wright, Numerical Optimization, algorithms 7.4 and 7.5; where
/// values are too close to be compared, slopes are: Hager and Zhang, SIAM J. Optim. 16, 170, 2005). `value_of(place,
/// gradient)` sets the gradient and returns the value. Returns the largest component of the gradient that is left.
template <class ValueOf>
double minimise(Eigen::VectorXd& place, const Minimising& how, ValueOf value_of) {
  struct Pair {
    Eigen::VectorXd step, change;
    double product;
  };
  constexpr double decrease = 1e-4;
  std::deque<Pair> pairs;
  Eigen::VectorXd gradient, next, next_gradient;
  double value = value_of(place, gradient);
  for (int steps = 0; steps < how.most_steps && gradient.lpNorm<Eigen::Infinity>() > how.gradient_at_end; ++steps) {
    Eigen::VectorXd direction = -gradient;
    std::vector<double> share(pairs.size());
    for (std::size_t k = pairs.size(); k-- > 0;) {
      share[k] = pairs[k].step.dot(direction) / pairs[k].product;
      direction -= share[k] * pairs[k].change;
    }
    if (!pairs.empty()) direction *= pairs.back().product / pairs.back().change.squaredNorm();
    for (std::size_t k = 0; k < pairs.size(); ++k)
      direction += (share[k] - pairs[k].change.dot(direction) / pairs[k].product) * pairs[k].step;
    const double slope = direction.dot(gradient);
    double length = std::min(1.0, how.longest_step / direction.lpNorm<Eigen::Infinity>());
    const auto enough = [&](double there) {
      return there <= value + decrease * length * slope ||
             (there <= value + how.rounding && direction.dot(next_gradient) <= (2 * decrease - 1) * slope);
    };
    next = place + length * direction;
    double next_value = value_of(next, next_gradient);
    while (!enough(next_value) && length > how.least_length) {
      length /= 2;
      next = place + length * direction;
      next_value = value_of(next, next_gradient);
    }
    if (length <= how.least_length) break;
    const Eigen::VectorXd step = next - place, change = next_gradient - gradient;
    const double product = step.dot(change);
    if (product > 1e-10 * step.norm() * change.norm()) pairs.push_back({step, change, product});
    if (pairs.size() > 30) pairs.pop_front();
    place = next;
    gradient = next_gradient;
    value = next_value;
  }
  value_of(place, gradient);
  return gradient.lpNorm<Eigen::Infinity>();
}

/// All nodes: x of each, then y, then z.
inline Eigen::VectorXd place_of(const core::Surfaces& surfaces) {
  const Eigen::Index n = surfaces.node_count();
  Eigen::VectorXd place(3 * n);
  for (int k = 0; k < 3; ++k) place.segment(k * n, n) = Eigen::Map<const Eigen::VectorXd>(surfaces.positions()[k], n);
  return place;
}
inline void move_to(const Eigen::VectorXd& place, core::Surfaces& surfaces) {
  const Eigen::Index n = surfaces.node_count();
  auto& positions = surfaces.position;
  for (int k = 0; k < 3; ++k) Eigen::Map<Eigen::VectorXd>(positions[k].data(), n) = place.segment(k * n, n);
}
/// Adds the gradient of the energy that the nodes' forces belong to.
inline void add_gradient(const core::Surfaces& surfaces, Eigen::VectorXd& gradient) {
  const Eigen::Index n = surfaces.node_count();
  for (int k = 0; k < 3; ++k) gradient.segment(k * n, n) -= Eigen::Map<const Eigen::VectorXd>(surfaces.forces()[k], n);
}

}  // namespace rouleau::test
