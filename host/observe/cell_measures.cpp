#include "cell_measures.hpp"

#include <algorithm>
#include <limits>

#include "core/contact/wall_gap.hpp"

namespace rouleau::observe {

namespace {

/// A circle has no long axis: below this deformation its direction would be that of rounding errors.
constexpr double roundest = 1e-6;

/// The angle of the long axis of a cell, if it has one.
double long_axis(double angle, double deformation) { return deformation > roundest ? angle : std::nan(""); }

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

CellMeasures measure(const core::Membranes& membranes, int cell, const core::Domain<2>& domain,
                     const core::Region<2>* region, int /*marker*/) {
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
          .wall_gap = core::wall_gap(membranes, range, domain, region),
          .stretch = core::stretch_range(membranes, range)};
}

CellMeasures measure(const core::Surfaces& surfaces, int cell, const core::Domain<3>& domain,
                     const core::Region<3>* region, int marker) {
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
                        .wall_gap = core::wall_gap(surfaces, surfaces.cells[cell], domain, region),
                        .stretch = core::stretch_range(surfaces, cell),
                        .z = ellipsoid.center.z(),
                        .volume = core::enclosed_volume(mesh, nodes),
                        .surface_area = core::surface_area(mesh, nodes),
                        .short_axis = pointed(ellipsoid.axes[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) measures.semi_axes[axis] = ellipsoid.semi_axes[axis];
  return measures;
}

}  // namespace rouleau::observe
