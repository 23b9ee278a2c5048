// Cells and laws for the tests of this folder: lattice units are SI units here.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/membranes.hpp"
#include "plan/placed_cells.hpp"
#include "plugin/catalog.hpp"
#include "plugin/handles.hpp"
#include "unit/periodic_box.hpp"
#include "unit/random.hpp"

namespace rouleau::test {

using namespace core;
using namespace plugin;
using namespace scene;

inline const Manifest& shipped(ModelKind kind, const char* id) {
  static const Catalog catalog({ROULEAU_PLUGINS});
  return catalog.find(kind, id, {});
}
inline core::MembraneLaw law(const char* id, const std::vector<double>& values,
                             const units::LatticeUnits& units = {1, 1, 1}) {
  return make_membrane_law(shipped(ModelKind::membrane, id), values, ModelSetting{units, 1.0, false});
}
inline core::Potential potential(const char* id, const std::vector<double>& values) {
  return make_potential(shipped(ModelKind::interaction, id), values, ModelSetting{{1, 1, 1}, 1.0, false});
}
inline core::MembraneLaw neo_hookean(double modulus) { return law("neo-hookean", {modulus, 0}); }
inline core::MembraneLaw bending(double modulus) { return law("bending", {modulus, 0, 0}); }
inline core::Potential morse(double depth, double decay, double distance, double cutoff) {
  return potential("morse", {depth, decay, distance, cutoff});
}

struct Placed {
  double x, y, angle = 0;
};

/// Scene of biconcave cells of one type (radius 20, spacing 1) in lattice coordinates.
inline Scene biconcave_scene(const std::vector<Placed>& places, core::Domain<2> domain, int height,
                             int segments = 100) {
  Scene scene{};
  scene.domain.nodes = {static_cast<int>(domain.period(0)),
                        domain.periodic[1] ? static_cast<int>(domain.period(1)) : height};
  scene.domain.size = {domain.period(0), static_cast<double>(scene.domain.nodes[1])};
  scene.domain.periodic[1] = domain.periodic[1];
  scene.cell_types.push_back({"red", Biconcave{20.0}, segments, 1.0, {}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    scene.cells.push_back({0, {places[i].x + 0.5, places[i].y + 0.5}, places[i].angle, "/cells/" + std::to_string(i)});
  }
  return scene;
}

/// The same cells, wherever they are and whatever they cross.
inline Membranes biconcave_cells(const std::vector<Placed>& places, int segments = 100) {
  Membranes all;
  all.types = plan::make_cells<2>(biconcave_scene({{0, 1000, 0}}, periodic_box(1000000), 2000, segments), 1.0).types;
  all.types.resize(4, all.types.front());  // for cells that are given another type
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
      const double at = i * 2 * 3.141592653589793 / segments + (r == radius ? angle : 0);
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
        const double angle = 6.283185307179586 * wave * (i - cell.first) / cell.count + phase;
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
