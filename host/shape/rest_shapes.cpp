#include "rest_shapes.hpp"

#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "base/text.hpp"
#include "core/solver/cell_methods.hpp"
#include "outline.hpp"
#include "scene/dimension_words.hpp"
#include "surface.hpp"

namespace rouleau::shape {

namespace {

core::RestShape at_rest(const Outline& outline, double spacing, double prestretch = 1) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& node : outline.nodes) {
    x.push_back(node.x() / spacing);
    y.push_back(node.y() / spacing);
  }
  return core::make_rest_shape(std::move(x), std::move(y), prestretch);
}

core::RestSurface at_rest(core::TriangleSurface surface, double spacing, double prestretch = 1) {
  for (core::Vec<3>& node : surface.nodes) node /= spacing;
  return core::rest_surface(surface, prestretch);
}

/// Adds a cell; its principal stretches.
core::StretchRange begin(core::Membranes& cells) {
  core::add_cell(cells, 0, 0, 0, 0);
  return core::stretch_range(cells, cells.cells[0]);
}
core::StretchRange begin(core::Surfaces& cells) {
  core::add_cell(cells, 0, core::Vec<3>::Zero());
  return core::first_stretch(cells.type_of(0));
}

double sum_of_sizes(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, [](double sum, double x) { return sum + std::abs(x); });
}

}  // namespace

void add_type(core::Membranes& cells, const scene::CellType& type, double spacing) {
  const Outline outline = make_outline(type.shape, type.segments);
  const auto* circle = std::get_if<scene::Circle>(&type.shape);
  core::RestShape rest = at_rest(outline, spacing, circle != nullptr ? circle->prestretch : 1.0);
  if (type.stress_free) rest = core::created_as(rest, at_rest(stress_free_outline(type, outline), spacing));
  cells.types.push_back(std::make_shared<const core::RestShape>(std::move(rest)));
}

void add_type(core::Surfaces& cells, const scene::CellType& type, double spacing) {
  const core::TriangleSurface surface = make_surface(type);
  const auto* sphere = std::get_if<scene::Sphere>(&type.shape);
  core::RestSurface rest = at_rest(surface, spacing, sphere != nullptr ? sphere->prestretch : 1.0);
  if (type.stress_free) rest = core::created_as(rest, at_rest(stress_free_surface(type, surface), spacing));
  cells.types.push_back(std::make_shared<const core::RestSurface>(std::move(rest)));
}

FirstStretch first_stretch(const scene::CellType& type, const std::vector<core::MembraneLaw>& laws,
                           const units::LatticeUnits& units, int dimension) {
  return scene::in_dimension(dimension, [&]<int D>(std::integral_constant<int, D>) -> FirstStretch {
    core::Cells<D> cells;
    add_type(cells, type, units.length);
    const auto [least, most] = begin(cells);
    core::BasicSolverSetup<D> setup;
    setup.cell_types.push_back({.laws = laws});
    auto forces = core::make_forces(setup, cells, nullptr);
    const std::vector<double> tensions = forces.tensions(cells, 0);
    const core::MembraneEnergy energy = forces.energies(cells);
    const double unit = units.unit(units::dimension::tension), told = energy.unknown.empty() ? energy.tension : NAN;
    return {type.name, least, most, unit * told / sum_of_sizes(cells.types[0]->node_measure()),
            unit * sum_of_sizes(tensions) / static_cast<double>(tensions.size())};
  });
}

std::string doubt_of_rest(const scene::CellType& type) {
  // Measured without fluid: a spheroid of reduced volume 0.7 to 0.95 gives the disc the least energy, one of 0.98 and a
  // sphere a cup (docs/results/stress-free-2026-11.md).
  constexpr double least = 0.695, most = 0.955, deflated = 0.8;
  if (!type.stress_free || type.segments > 0 || std::holds_alternative<scene::Biconcave>(type.stress_free->shape))
    return {};
  const core::TriangleSurface first = make_surface(type);
  const double reduced = core::content_of(stress_free_surface(type, first)).reduced_volume();
  const bool spheroid = std::holds_alternative<scene::Ellipsoid>(type.stress_free->shape);
  if ((spheroid && reduced > least && reduced < most) || core::content_of(first).reduced_volume() > deflated) return {};
  return "cell type " + type.name + ": with a stress-free shape of reduced volume " + number(reduced, 3) +
         " it may come to rest as a cup and not as a biconcave disc, which spheroids of 0.7 to 0.95 give "
         "(docs/results/stress-free-2026-11.md); let one cell come to rest first";
}

}  // namespace rouleau::shape
