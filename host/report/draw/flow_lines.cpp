#include "flow_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rouleau::report {

namespace {

constexpr double tracers = 240;

/// Numbers in [0, 1) that are always the same.
double scattered(double n) {
  const double v = std::sin(n * 127.1 + 311.7) * 43758.5453;
  return v - std::floor(v);
}

}  // namespace

std::array<double, 2> BlockVelocity::at(double x, double y) const {
  const auto nx = double(u.nx), ny = double(u.ny);
  double i = (x - first[0]) / size[0] * nx - 0.5, j = (y - first[1]) / size[1] * ny - 0.5;
  i = periodic_x ? i - std::floor(i / nx) * nx : std::clamp(i, 0.0, nx - 1);
  j = std::clamp(j, 0.0, ny - 1);
  const auto left = std::min(static_cast<std::size_t>(i), u.nx - 1), low = static_cast<std::size_t>(j);
  const std::size_t right = periodic_x ? (left + 1) % u.nx : std::min(left + 1, u.nx - 1);
  const std::size_t high = std::min(low + 1, u.ny - 1);
  const double fx = i - std::floor(i), fy = j - std::floor(j);
  const auto mixed = [&](const ScalarField& f) {
    const auto value = [&](std::size_t a, std::size_t b) { return f.values[b * f.nx + a]; };
    return (value(left, low) * (1 - fx) + value(right, low) * fx) * (1 - fy) +
           (value(left, high) * (1 - fx) + value(right, high) * fx) * fy;
  };
  return {mixed(u), mixed(v)};
}

std::vector<FlowLine> flow_lines(const BlockVelocity& velocity, double turn, double seconds) {
  constexpr int steps = 10, shown = 4;
  const auto& [width, height] = velocity.size;
  const double columns = std::max(1.0, std::round(std::sqrt(tracers * width / height)));
  const double rows = std::max(1.0, std::round(tracers / columns));
  std::vector<FlowLine> lines;
  for (double row = 0; row < rows; ++row) {
    for (double column = 0; column < columns; ++column) {
      const double k = row * columns + column, own = turn + scattered(k), phase = own - std::floor(own);
      const double again = 7919 * std::floor(own), step = phase * seconds / steps;
      double x = velocity.first[0] + (column + scattered(2 * k + again)) / columns * width;
      double y = velocity.first[1] + (row + scattered(2 * k + 1 + again)) / rows * height;
      FlowLine line{{}, std::sin(std::numbers::pi * phase)};
      for (int i = 0; i <= steps; ++i) {
        if (i >= steps - shown) line.points.push_back({x, y});
        const auto here = velocity.at(x, y);
        const auto middle = velocity.at(x + here[0] * step / 2, y + here[1] * step / 2);
        x += middle[0] * step;
        y += middle[1] * step;
      }
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace rouleau::report
