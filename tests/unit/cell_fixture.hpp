// Cells for the tests of core, in lattice units.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/periodic_box.hpp"
#include "unit/random.hpp"
#include "unit/shipped_models.hpp"

namespace rouleau::test {

using namespace core;

struct Placed {
  double x, y, angle = 0;
};

/// A biconcave outline of radius 20, its segments equally long.
inline RestShape biconcave_shape(int segments) {
  std::vector<double> angle(segments + 1), x(segments), y(segments);
  for (int i = 0; i <= segments; ++i) angle[i] = 2 * std::numbers::pi * i / segments;
  // Shares out the length of the polygon as it is, again and again.
  double worst = 1;
  for (int pass = 0; pass < 40 && worst > 1e-15; ++pass) {
    std::vector<double> length{0};
    for (int i = 0; i < segments; ++i) {
      const auto from = biconcave_curve(20, angle[i]).place, to = biconcave_curve(20, angle[i + 1]).place;
      x[i] = from.x(), y[i] = from.y();
      length.push_back(length.back() + (to - from).norm());
    }
    worst = 0;
    std::vector<double> next = angle;
    for (int i = 1, k = 1; i < segments; ++i) {
      const double wanted = length.back() * i / segments;
      while (length[k] < wanted) ++k;
      next[i] = angle[k] - (angle[k] - angle[k - 1]) * (length[k] - wanted) / (length[k] - length[k - 1]);
      worst = std::max(worst, std::abs(next[i] - angle[i]));
    }
    angle = next;
  }
  return make_rest_shape(std::move(x), std::move(y));
}

/// Biconcave cells, wherever they are and whatever they cross.
inline Membranes biconcave_cells(const std::vector<Placed>& places, int segments = 100) {
  Membranes all;
  all.types.resize(4, std::make_shared<const RestShape>(biconcave_shape(segments)));  // cells may be given another type
  for (const Placed& place : places) add_cell(all, 0, place.x, place.y, place.angle);
  return all;
}

/// Adds a cell of a type of its own, as it is given.
inline void add_shape(Membranes& membranes, RestShape shape) {
  membranes.types.push_back(std::make_shared<const RestShape>(std::move(shape)));
  add_cell(membranes, static_cast<int>(membranes.types.size()) - 1, 0, 0, 0);
}

/// Two circles of `radius` and radius + gap about one centre, the inner one turned, of one type each; both with as many
/// segments. `prestretch`: their lengths over those at rest.
inline Membranes mating_circles(double radius, double gap, int segments, double angle, double prestretch = 1) {
  Membranes m;
  for (const double r : {radius, radius + gap}) {
    std::vector<double> x, y;
    for (int i = 0; i < segments; ++i) {
      const double at = i * 2 * std::numbers::pi / segments + (r == radius ? angle : 0);
      x.push_back(r * std::cos(at));
      y.push_back(r * std::sin(at));
    }
    add_shape(m, make_rest_shape(std::move(x), std::move(y), prestretch));
  }
  return m;
}

/// Moves every node by smooth waves along the outline of up to `amplitude`, and by up to `noise` on its own.
inline void deform(Membranes& membranes, std::mt19937& random, double amplitude, double noise = 0) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const CellRange& cell : membranes.cells) {
    for (int wave = 1; wave <= 4; ++wave) {
      const double ax = amplitude / 4 * uniform(random), ay = amplitude / 4 * uniform(random),
                   phase = 4 * uniform(random);
      for (int i = cell.first; i < cell.end(); ++i) {
        const double angle = 2 * std::numbers::pi * wave * (i - cell.first) / cell.count + phase;
        membranes.position[0][static_cast<std::size_t>(i)] += ax * std::cos(angle);
        membranes.position[1][static_cast<std::size_t>(i)] += ay * std::sin(angle);
      }
    }
    for (int i = cell.first; i < cell.end(); ++i) {
      membranes.position[0][static_cast<std::size_t>(i)] += noise * uniform(random);
      membranes.position[1][static_cast<std::size_t>(i)] += noise * uniform(random);
    }
  }
}

/// Sums of the nodal forces: both components, torque, and what they are to be compared with.
struct ForceSums {
  double x = 0, y = 0, torque = 0, size = 0, lever = 0;
};
inline ForceSums force_sums(const Membranes& m) {
  ForceSums sums;
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    sums.x += m.force[0][i];
    sums.y += m.force[1][i];
    sums.torque += m.position[0][i] * m.force[1][i] - m.position[1][i] * m.force[0][i];
    sums.size += std::hypot(m.force[0][i], m.force[1][i]);
    sums.lever += std::hypot(m.position[0][i], m.position[1][i]) * std::hypot(m.force[0][i], m.force[1][i]);
  }
  return sums;
}

/// Largest difference between the forces and minus the central differences of `energy`, over the largest force.
template <class Energy>
double gradient_error(Membranes& membranes, Energy energy, double step) {
  double worst = 0, largest = 0;
  const auto compare = [&](std::vector<double>& position, const std::vector<double>& force) {
    for (std::size_t i = 0; i < position.size(); ++i) {
      const double before = position[i];
      position[i] = before + step;
      const double above = energy();
      position[i] = before - step;
      const double below = energy();
      position[i] = before;
      worst = std::max(worst, std::abs(force[i] + (above - below) / (2 * step)));
      largest = std::max(largest, std::abs(force[i]));
    }
  };
  const std::vector<double> force_x = membranes.force[0], force_y = membranes.force[1];
  compare(membranes.position[0], force_x);
  compare(membranes.position[1], force_y);
  return worst / largest;
}

/// One pass by several workers, one after the other: what threads would do between two barriers.
template <class Pass>
void run_pass(int workers, Pass pass) {
  for (int index = 0; index < workers; ++index) pass(Worker{index, workers});
}

}  // namespace rouleau::test
