#include "cell_measures.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/contact/wall_gap.hpp"
#include "core/surface/line_crossing.hpp"

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

/// As seen along z: places in the frame of the shape's two axes and in units of them; of a round one, of x and y.
struct PlaneFrame {
  core::Vec<3> center;
  double angle, ratio;  ///< of the longer axis against x; longer over shorter
  explicit PlaneFrame(const core::InertiaEllipsoid& ellipsoid) : center(ellipsoid.center) {
    const core::PlaneDeformation plane = core::deformation_in_xy(ellipsoid);
    const bool round = std::isnan(long_axis(plane.angle, plane.deformation));
    angle = round ? 0 : plane.angle;
    ratio = round ? 1 : (1 + plane.deformation) / (1 - plane.deformation);
  }
  [[nodiscard]] std::array<double, 2> operator()(const core::Vec<3>& place) const {
    const double x = place.x() - center.x(), y = place.y() - center.y(), c = std::cos(angle), s = std::sin(angle);
    return {c * x + s * y, ratio * (c * y - s * x)};
  }
};

/// How fast the membrane turns about z within its shape, rad per step: nodes are moved on a little, by their velocity,
/// and seen in the frame of the shape that they have then.
double treading_rate(const core::Mesh& mesh, const core::Nodes& nodes, const std::array<const double*, 3>& velocity) {
  double fastest = 0;
  for (int i = 0; i < mesh.node_count(); ++i)
    fastest = std::max(fastest, std::hypot(velocity[0][i], velocity[1][i], velocity[2][i]));
  if (fastest == 0) return 0;
  const double time = 1e-3 / fastest;  // a thousandth of a spacing
  std::array<std::vector<double>, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* const from = std::array{nodes.x, nodes.y, nodes.z}[k];
    for (int i = 0; i < mesh.node_count(); ++i) at[k].push_back(from[i] + time * velocity[k][i]);
  }
  const core::Nodes moved{at[0].data(), at[1].data(), at[2].data()};
  const PlaneFrame first(core::inertia_ellipsoid(mesh, nodes));
  PlaneFrame last(core::inertia_ellipsoid(mesh, moved));
  last.angle += std::numbers::pi * std::round((first.angle - last.angle) / std::numbers::pi);
  double across = 0, along = 0;
  for (int i = 0; i < mesh.node_count(); ++i) {
    const auto [x, y] = first(nodes[i]);
    const auto [next_x, next_y] = last(moved[i]);
    across += x * next_y - y * next_x;
    along += x * next_x + y * next_y;
  }
  return std::atan2(across, along) / time;
}

/// Way along x from the rim at the rear of a cell to its membrane in the middle, on the line through its center; the
/// rear is where it comes from, at rest the lower end. NaN where the line passes beside the cell.
double rear_hollow(const core::Mesh& mesh, const core::Nodes& nodes, const core::Vec<3>& center, double velocity) {
  const double ahead = velocity < 0 ? -1 : 1;
  double rim = std::numeric_limits<double>::infinity(), middle = rim;
  for (int i = 0; i < mesh.node_count(); ++i) rim = std::min(rim, ahead * nodes.x[i]);
  for (const auto& [a, b, c] : mesh.triangles())
    if (const auto hit = core::LinesThroughTriangle(nodes[a], nodes[b], nodes[c]).crossing({center.y(), center.z()}))
      middle = std::min(middle, ahead * hit->x);
  return std::isfinite(middle) ? middle - rim : std::nan("");
}

}  // namespace

// Over a volume whose velocity u has no divergence, u_x = div (x u), and so along any axis: the integral is that of
// x u n over its surface.
// Along segments and over triangles places and velocities are linear.
double carried(const core::Membranes& m, int c, int axis) {
  const core::CellRange& cell = m.cells[c];
  const auto& place = m.position[axis];
  const double middle = place[cell.first];
  double flux = 0;
  for (int i = cell.first; i < cell.end(); ++i) {
    const int n = cell.next(i);
    const double normal_x = m.position[1][n] - m.position[1][i], normal_y = m.position[0][i] - m.position[0][n];
    const auto out = [&](int k) { return m.velocity[0][k] * normal_x + m.velocity[1][k] * normal_y; };
    const double x = place[i] - middle, next_x = place[n] - middle;
    flux += ((2 * x + next_x) * out(i) + (x + 2 * next_x) * out(n)) / 6;
  }
  return flux;
}

double carried(const core::Surfaces& s, int c, int axis) {
  const core::Mesh& mesh = s.type_of(c).mesh;
  const core::Nodes at = s.nodes(c);
  const int first = s.cells[c].first;
  const double* const place = &s.position[axis][first];
  const std::vector<core::Vec<3>> twice_area = core::area_vectors(mesh, at);
  double flux = 0;
  std::size_t t = 0;
  for (const auto& corners : mesh.triangles()) {
    double sum_x = 0, sum_out = 0, products = 0;
    for (const int node : corners) {
      double out = 0;
      for (int k = 0; k < 3; ++k) out += s.velocity[k][first + node] * twice_area[t][k] / 2;
      const double x = place[node] - place[0];
      sum_x += x, sum_out += out, products += x * out;
    }
    flux += (sum_x * sum_out + products) / 12;
    ++t;
  }
  return flux;
}

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
  const core::CellRange& range = surfaces.cells[cell];
  CellMeasures measures{.cell = cell,
                        .x = ellipsoid.center.x(),
                        .y = ellipsoid.center.y(),
                        .deformation = plane.deformation,
                        .long_axis = long_axis(plane.angle, plane.deformation),
                        .marker = std::atan2(arm.y(), arm.x()),
                        .wall_gap = core::wall_gap(surfaces, range, domain, region),
                        .stretch = core::stretch_range(surfaces, cell),
                        .z = ellipsoid.center.z(),
                        .volume = core::enclosed_volume(mesh, nodes),
                        .surface_area = core::surface_area(mesh, nodes),
                        .short_axis = pointed(ellipsoid.axes[2])};
  measures.velocity = carried(surfaces, cell) / measures.volume;
  measures.rear_hollow = rear_hollow(mesh, nodes, ellipsoid.center, measures.velocity);
  std::array<const double*, 3> velocity{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    measures.semi_axes[axis] = ellipsoid.semi_axes[axis];
    const double* const from = std::array{nodes.x, nodes.y, nodes.z}[axis];
    const auto [least, most] = std::minmax_element(from, from + range.count);
    measures.extent[axis] = *most - *least;
    velocity[axis] = &surfaces.velocity[axis][range.first];
  }
  measures.treading = treading_rate(mesh, nodes, velocity);
  return measures;
}

void describe_surface(const CellMeasures& measures, const units::LatticeUnits& units, const scene::Domain& domain,
                      CellSnapshot& cell) {
  const double length = units.length;
  cell.z = units::coordinate(measures.z, length);
  cell.volume = measures.volume * length * length * length;
  cell.surface_area = measures.surface_area * length * length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell.semi_axes[axis] = measures.semi_axes[axis] * length;
    cell.extent[axis] = measures.extent[axis] * length;
  }
  cell.short_axis = measures.short_axis;
  cell.velocity = units.to_si(measures.velocity, units::dimension::velocity);
  cell.treading = units.to_si(measures.treading, units::dimension::rate) / (2 * std::numbers::pi);
  cell.rear_hollow = measures.rear_hollow * length;
  const auto off = [&](double place, int axis) { return domain.periodic[axis] ? 0 : place - domain.size[axis] / 2; };
  const bool has_axis = domain.walled(1) && !domain.has_shapes();
  cell.offset_from_axis = has_axis ? std::hypot(off(cell.y, 1), off(cell.z, 2)) : std::nan("");
}

void measure_pulled(const scene::Scene& scene, const core::CellNodes& nodes, CellMeasures& measures) {
  scene::Vector along = scene.fluid.gravity;
  bool pulled = false;
  for (const scene::Stage& stage : scene.stages) {
    for (const scene::CellForce& force : stage.forces)
      if (!pulled && force.pulls_at(measures.cell) && force.force != scene::Vector())
        along = force.force, pulled = true;
  }
  if (along == scene::Vector()) return;
  along *= 1 / along.norm();
  const double in_plane = std::hypot(along.x(), along.y());
  const scene::Vector across = in_plane > 0 ? 1 / in_plane * scene::Vector(-along.y(), along.x()) : scene::Vector(1, 0);
  const core::CellRange& range = nodes.cells[measures.cell];
  const auto extent = [&](const scene::Vector& axis) {
    double least = INFINITY, most = -INFINITY;
    for (int i = range.first; i < range.end(); ++i) {
      double place = 0;
      for (int k = 0; k < axis.dimension(); ++k) place += axis[k] * nodes.position[k][i];
      least = std::min(least, place), most = std::max(most, place);
    }
    return most - least;
  };
  measures.length_along_force = extent(along), measures.width_across_force = extent(across);
}

}  // namespace rouleau::observe
