#include "cell_measures.hpp"

#include <algorithm>
#include <limits>

#include "aggregates.hpp"

namespace rouleau::observe {

namespace {

/// A circle has no long axis: below this deformation its direction would be that of rounding errors.
constexpr double roundest = 1e-6;

/// The angle of the long axis of a cell, if it has one.
double long_axis(double angle, double deformation) { return deformation > roundest ? angle : std::nan(""); }

/// Distance of a surface to the nearest wall, spacings, negative beyond it; NaN without walls. `tube_radius`: 0 without
/// one.
double wall_gap(const core::Surfaces& surfaces, int cell, const core::Domain<3>& domain, double tube_radius) {
  if (tube_radius > 0) return tube_radius - core::farthest_from_axis(surfaces, cell, domain);
  const core::CellRange& range = surfaces.cells[cell];
  const auto& along = surfaces.position;
  double gap = std::numeric_limits<double>::infinity();
  for (int axis = 1; axis < 3; ++axis) {
    if (!domain.walled(axis)) continue;
    const auto [least, most] =
        std::minmax_element(along[axis].begin() + range.first, along[axis].begin() + range.end());
    gap = std::min({gap, *least + 0.5, domain.size[axis] - 0.5 - *most});
  }
  return std::isinf(gap) ? std::nan("") : gap;
}

/// An axis has no direction: the one whose first component that is not 0 is positive.
std::array<double, 3> pointed(const core::Vec<3>& axis) {
  const double sign = axis.x() < 0 || (axis.x() == 0 && (axis.y() < 0 || (axis.y() == 0 && axis.z() < 0))) ? -1 : 1;
  return {sign * axis.x(), sign * axis.y(), sign * axis.z()};
}

}  // namespace

double enclosed(const core::Membranes& membranes, int cell) {
  return core::enclosed_area(membranes, membranes.cells[cell]);
}
double enclosed(const core::Surfaces& surfaces, int cell) {
  return core::enclosed_volume(surfaces.type_of(cell).mesh, surfaces.nodes(cell));
}

int outermost(const core::Surfaces& surfaces, int cell) {
  const core::Nodes nodes = surfaces.nodes(cell);
  const core::Vec<3> center = core::inertia_ellipsoid(surfaces.type_of(cell).mesh, nodes).center;
  int farthest = 0;
  double distance = -1;
  for (int i = 0; i < surfaces.cells[cell].count; ++i) {
    const double here = std::hypot(nodes.x[i] - center.x(), nodes.y[i] - center.y());
    if (here > distance) distance = here, farthest = i;
  }
  return farthest;
}

CellMeasures measure(const core::Membranes& membranes, int cell, const core::Domain<2>& domain) {
  const core::CellRange& range = membranes.cells[cell];
  const core::Vec<2> center = core::centroid(membranes, range);
  const core::InertiaEllipse ellipse = core::inertia_ellipse(membranes, range);
  return {.cell = cell,
          .x = center.x(),
          .y = center.y(),
          .deformation = ellipse.deformation,
          .long_axis = long_axis(ellipse.angle, ellipse.deformation),
          .marker = core::marker_angle(membranes, range),
          .area = core::enclosed_area(membranes, range),
          .perimeter = core::perimeter(membranes, range),
          .wall_gap = wall_gap(membranes, range, domain),
          .stretch = core::stretch_range(membranes, range)};
}

CellMeasures measure(const core::Surfaces& surfaces, int cell, const core::Domain<3>& domain, int marker,
                     double tube_radius) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  const core::Nodes nodes = surfaces.nodes(cell);
  const core::InertiaEllipsoid ellipsoid = core::inertia_ellipsoid(mesh, nodes);
  const core::PlaneDeformation plane = core::deformation_in_xy(ellipsoid);
  const core::Vec<3> arm = nodes[marker] - ellipsoid.center;
  CellMeasures measures{.cell = cell,
                        .x = ellipsoid.center.x(),
                        .y = ellipsoid.center.y(),
                        .deformation = plane.deformation,
                        .long_axis = long_axis(plane.angle, plane.deformation),
                        .marker = std::atan2(arm.y(), arm.x()),
                        .wall_gap = wall_gap(surfaces, cell, domain, tube_radius),
                        .stretch = core::stretch_range(surfaces, cell),
                        .z = ellipsoid.center.z(),
                        .volume = core::enclosed_volume(mesh, nodes),
                        .surface_area = core::surface_area(mesh, nodes),
                        .short_axis = pointed(ellipsoid.axes[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) measures.semi_axes[axis] = ellipsoid.semi_axes[axis];
  return measures;
}

}  // namespace rouleau::observe
