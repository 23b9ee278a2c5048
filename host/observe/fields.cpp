#include "fields.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/fluid/relaxation.hpp"
#include "core/solver/in_order.hpp"
#include "scene/lattice.hpp"
#include "walls/wall_border.hpp"
#include "walls/wall_shear.hpp"

namespace rouleau::observe {

namespace {

/// Which rows of the lattice the scene wants.
template <int D>
class StoredRows {
 public:
  using Row = std::array<int, D - 1>;
  StoredRows(const core::Domain<D>& domain, const scene::FieldStorage& storage) : domain_(domain), storage_(storage) {}

  [[nodiscard]] const core::Domain<D>& domain() const { return domain_; }
  [[nodiscard]] int along(int axis) const { return storage_.count(axis, domain_.size[axis]); }
  [[nodiscard]] int count() const {
    int all = 1;
    for (int axis = 1; axis < D; ++axis) all *= along(axis);
    return all;
  }
  /// The lattice's node along x of a stored one.
  [[nodiscard]] int node(int column) const { return storage_.first[0] + column * storage_.stride; }
  [[nodiscard]] Row row(int stored) const {
    Row row{};
    for (int axis = 1; axis < D; stored /= along(axis++))
      row[axis - 1] = storage_.first[axis] + stored % along(axis) * storage_.stride;
    return row;
  }
  /// The number of a row in the lattice.
  [[nodiscard]] int number(const Row& row) const {
    int number = 0;
    for (int axis = D - 1; axis > 0; --axis) number = number * domain_.size[axis] + row[axis - 1];
    return number;
  }
  /// The row a step further along an axis; -1: it lies beyond a wall.
  [[nodiscard]] int beside(Row row, int axis, int step) const {
    int& place = row[static_cast<std::size_t>(axis - 1)];
    place = domain_.wrapped(axis, place + step);
    return place < 0 ? -1 : number(row);
  }
  /// Rows of the lattice that stored rows [begin, end) need, in rising order; `around`: with those beside them.
  [[nodiscard]] std::vector<int> needed(int begin, int end, bool around) const {
    std::vector<int> rows;
    for (int stored = begin; stored < end; ++stored) {
      const Row row = this->row(stored);
      rows.push_back(number(row));
      for (int axis = 1; around && axis < D; ++axis) {
        for (const int step : {-1, 1}) {
          const int next = beside(row, axis, step);
          if (next >= 0) rows.push_back(next);
        }
      }
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
  }

 private:
  core::Domain<D> domain_;
  scene::FieldStorage storage_;
};

/// A band of the lattice's rows and the values of their nodes.
template <class V>
struct KnownRows {
  const std::vector<int>& rows;
  const std::vector<V>& values;
  /// The nodes of a row; null for -1.
  [[nodiscard]] const V* at(int row) const {
    if (row < 0) return nullptr;
    const auto place = std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
    return values.data() + place * static_cast<std::ptrdiff_t>(values.size() / rows.size());
  }
};

/// By central differences over two spacings. Beyond a wall half a spacing away the velocity is such that its mean with
/// that of the node before it is the wall's.
template <int D>
class Vorticity {
 public:
  using Row = std::array<int, D - 1>;
  Vorticity(const StoredRows<D>& rows, const core::FluidSetting<D>& fluid, const core::WallVelocity& walls)
      : rows_(rows), solid_(fluid.solid.get()), wall_time_(fluid.wall_time), walls_(walls) {}

  /// Of the nodes of a row, which is known as well as those beside it.
  void begin(const Row& row, const KnownRows<core::Moments<D>>& known) {
    row_ = row;
    own_ = known.at(rows_.number(row));
    for (int axis = 1; axis < D; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      below_[k] = known.at(rows_.beside(row, axis, -1));
      above_[k] = known.at(rows_.beside(row, axis, 1));
    }
  }
  static constexpr int components = D * (D - 1) / 2;
  /// Along z, in three dimensions along x, y and z, lattice units; 0 in the solid.
  [[nodiscard]] std::array<double, components> at(int x) const {
    std::array<double, components> curl{};
    if (solid(x, 0, 0)) return curl;
    for (int k = 0; k < components; ++k) {
      const int axis = 3 - components + k, next = (axis + 1) % 3, last = (axis + 2) % 3;
      curl[static_cast<std::size_t>(k)] = rise(x, last, next) - rise(x, next, last);
    }
    return curl;
  }

 private:
  /// d velocity[component] / d axis
  [[nodiscard]] double rise(int x, int of, int axis) const {
    const auto component = static_cast<std::size_t>(of);
    return (beside(x, component, axis, 1) - beside(x, component, axis, -1)) / 2;
  }
  [[nodiscard]] double beside(int x, std::size_t component, int axis, int step) const {
    const auto k = static_cast<std::size_t>(axis);
    const int column = axis == 0 ? rows_.domain().wrapped(0, x + step) : x;
    const core::Moments<D>* const row = axis == 0 ? own_ : step > 0 ? above_[k] : below_[k];
    const double own = own_[x].velocity[component];
    const double upper_or_lower = step > 0 ? walls_.upper : walls_.lower;
    if (column < 0 || (row == nullptr && axis == rows_.domain().open_axis))  // beyond an opening it goes on
      return 2 * own - (axis == 0 ? own_[x - step] : (step > 0 ? below_ : above_)[k][x]).velocity[component];
    if (row == nullptr) return 2 * (axis == 1 && component == 0 ? upper_or_lower : 0) - own;
    if (solid(x, axis, step)) return 2 * of_wall(x, component, axis, step) - own;
    return row[column].velocity[component];
  }
  /// Whether the node that is so many steps along an axis from one of the row is solid.
  [[nodiscard]] bool solid(int x, int axis, int step) const {
    if (solid_ == nullptr) return false;
    std::array<int, D> node{x};
    std::copy(row_.begin(), row_.end(), node.begin() + 1);
    node[static_cast<std::size_t>(axis)] += step;
    return solid_->at(rows_.domain(), node);
  }

  /// Of the wall on the way there.
  [[nodiscard]] double of_wall(int x, std::size_t component, int axis, int step) const {
    if (wall_time_ == 0) return 0;
    std::array<int, D> node{x}, to{};
    std::copy(row_.begin(), row_.end(), node.begin() + 1);
    to[static_cast<std::size_t>(axis)] = step;
    return wall_time_ * solid_->velocity(node, to)[static_cast<Eigen::Index>(component)];
  }

  StoredRows<D> rows_;
  const core::SolidNodes<D>* solid_;
  double wall_time_;
  core::WallVelocity walls_;
  Row row_{};
  const core::Moments<D>* own_ = nullptr;
  std::array<const core::Moments<D>*, D> below_{}, above_{};  ///< beside it along each axis but the first; null: a wall
};

/// Field::give of what `fill(row, known, to)` computes, so many numbers for each stored row, from the lattice's values
/// that `gather(bands, take)` brings to the first rank: V of a node. `around`: rows need those beside them.
template <class V, int D, class Gather, class Fill>
auto giver(const StoredRows<D>& rows, bool around, std::size_t bytes, std::size_t numbers, Gather gather, Fill fill) {
  return [=](const Field::Take& take) mutable {
    const std::array<int, D>& size = rows.domain().size;
    const int each = core::rows_of_band(static_cast<std::size_t>(size[0]) * sizeof(V), bytes), all = rows.count();
    const auto needed = [&](int b) { return rows.needed(b * each, std::min((b + 1) * each, all), around); };
    std::vector<double> values;
    gather(core::Bands<D>{(all - 1) / each + 1, [&](int b) { return core::band_of_rows<D>(size, needed(b)); }},
           [&](int b, const std::vector<V>& of_lattice) {
             const std::vector<int> known = needed(b);
             const int begin = b * each, end = std::min(begin + each, all);
             values.resize(static_cast<std::size_t>(end - begin) * numbers);
             double* to = values.data();
             for (int stored = begin; stored < end; ++stored, to += numbers)
               fill(rows.row(stored), KnownRows<V>{known, of_lattice}, to);
             take(values);
           });
  };
}

template <int D>
FieldSnapshot fields_of(const core::AnyFluid<D>& fluid, const scene::Scene& scene, const units::LatticeUnits& units,
                        std::size_t bytes) {
  using Moments = core::Moments<D>;
  using Row = std::array<int, D - 1>;
  const StoredRows<D> rows(fluid.setting().domain, scene.output.field_storage);
  FieldSnapshot snapshot;
  int* const counts[] = {&snapshot.nx, &snapshot.ny, &snapshot.nz};
  for (int axis = 0; axis < D; ++axis) *counts[axis] = rows.along(axis);
  const int columns = snapshot.nx;
  const auto add = [&]<class V>(V, const char* name, const char* unit, int components, bool around, auto gather,
                                auto fill) {
    const auto& wanted = scene.output.quantities;
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) return;
    const auto numbers = static_cast<std::size_t>(columns) * static_cast<std::size_t>(components);
    snapshot.fields.push_back({name, unit, components, giver<V>(rows, around, bytes, numbers, gather, fill)});
  };
  const auto moments = [&fluid](const auto& bands, const auto& take) { fluid.gather_moments(bands, take); };
  const auto rates = [&fluid](const auto& bands, const auto& take) { fluid.gather_relaxation_rates(bands, take); };

  const double speed = units.to_si(1, units::dimension::velocity), rate = units.to_si(1, units::dimension::rate);
  add(Moments{}, "velocity", "m/s", 3, false, moments,
      [=](const Row& row, const KnownRows<Moments>& known, double* to) {
        const Moments* const nodes = known.at(rows.number(row));
        for (int column = 0; column < columns; ++column) {
          const Moments& m = nodes[rows.node(column)];
          for (int k = 0; k < 3; ++k) *to++ = k < D ? m.velocity[k] * speed : 0;
        }
      });
  add(Moments{}, "density", "1", 1, false, moments, [=](const Row& row, const KnownRows<Moments>& known, double* to) {
    const Moments* const nodes = known.at(rows.number(row));
    for (int column = 0; column < columns; ++column) *to++ = nodes[rows.node(column)].density;
  });
  const double viscosity_unit = units.to_si(1, units::dimension::viscosity);
  add(double{}, "viscosity", "Pa s", 1, false, rates, [=](const Row& row, const KnownRows<double>& known, double* to) {
    const double* const nodes = known.at(rows.number(row));
    for (int column = 0; column < columns; ++column)
      *to++ = core::viscosity_of(1 / nodes[rows.node(column)]) * viscosity_unit;
  });
  Vorticity<D> curl(rows, fluid.setting(), fluid.walls_now());
  add(Moments{}, "vorticity", "1/s", Vorticity<D>::components, true, moments,
      [=](const Row& row, const KnownRows<Moments>& known, double* to) mutable {
        curl.begin(row, known);
        for (int column = 0; column < columns; ++column)
          for (const double component : curl.at(rows.node(column))) *to++ = component * rate;
      });
  return snapshot;
}

/// Tensions at the nodes of a cell: of an outline's segments that begin there; of a surface's triangles the means
/// around each node.
std::vector<double> tensions_of(const core::Membranes&, int, std::vector<double> of_segment) { return of_segment; }
std::vector<double> tensions_of(const core::Surfaces& surfaces, int cell, const std::vector<double>& of_triangle) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  std::vector<double> means;
  for (int i = 0; i < mesh.node_count(); ++i) {
    const auto begin = static_cast<std::size_t>(mesh.corners().first[i]),
               end = static_cast<std::size_t>(mesh.corners().first[i + 1]);
    double sum = 0;
    for (std::size_t c = begin; c < end; ++c) sum += of_triangle[mesh.corners().entry[c] / 3];
    means.push_back(sum / static_cast<double>(end - begin));
  }
  return means;
}

/// The sum of both principal curvatures at each node; 1/m.
void add_curvatures(const core::Surfaces& surfaces, int cell, double spacing, std::vector<double>& values) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  const std::vector<double> area = core::node_areas(mesh, surfaces.nodes(cell));
  std::size_t i = 0;
  for (const double integral : core::integrated_curvature(mesh, surfaces.nodes(cell)))
    values.push_back(integral / area[i++] / spacing);
}

}  // namespace

template <int D>
FieldSnapshot observe_fields(const core::AnyFluid<D>& fluid, const scene::Scene& scene,
                             const units::LatticeUnits& units, std::size_t bytes) {
  FieldSnapshot snapshot = fields_of(fluid, scene, units, bytes);
  if (!scene.output.wants(shear_stress)) return snapshot;
  std::vector<core::Vec<D>> middles;
  if (fluid.ranks().first()) middles = facet_middles<D>(wall_border(scene));
  for (core::Vec<D>& place : middles) place = place / units.length - core::Vec<D>::Constant(0.5);
  const double pascal = units.to_si(1, units::dimension::pressure);
  snapshot.on_walls.push_back({shear_stress, "Pa", 3, [&fluid, &scene, middles, pascal](const Field::Take& take) {
                                 const WallShear<D> shear(*scene::fluid_region<D>(scene), fluid.setting().domain,
                                                          *fluid.setting().solid, middles);
                                 std::vector<double> values;
                                 for (const core::Vec<D>& of_facet : shear.of(fluid))
                                   for (int k = 0; k < 3; ++k) values.push_back(k < D ? of_facet[k] * pascal : 0);
                                 if (!values.empty()) take(values);
                               }});
  return snapshot;
}

template FieldSnapshot observe_fields(const core::AnyFluid<2>&, const scene::Scene&, const units::LatticeUnits&,
                                      std::size_t);
template FieldSnapshot observe_fields(const core::AnyFluid<3>&, const scene::Scene&, const units::LatticeUnits&,
                                      std::size_t);

template <int D>
MembraneSnapshot observe_membranes(core::AnySolver<D>& solver, const units::LatticeUnits& units) {
  const auto& cells = solver.cells();
  auto* const tasks = solver.cell_tasks();
  MembraneSnapshot snapshot;
  for (const int cell : cells.own_cells()) snapshot.cell.push_back(cell);
  snapshot.cell = core::to_first(solver.ranks(), std::move(snapshot.cell));
  std::sort(snapshot.cell.begin(), snapshot.cell.end());
  snapshot.first.push_back(0);
  for (const int cell : snapshot.cell) snapshot.first.push_back(snapshot.first.back() + cells.cells[cell].count);
  // Adds a field of which add(cell, values) appends those of a cell's nodes.
  const auto field = [&](const char* name, const char* unit, int components, auto add) {
    snapshot.fields.push_back({name, unit, components, [&cells, tasks, add](const Field::Take& take) {
                                 const auto add_known = [&](int cell, std::vector<double>& values) {
                                   if (cells.knows(cell)) add(cell, values);
                                 };
                                 core::give_in_order<double>(
                                     tasks->ghosts(), cells, add_known,
                                     [&](Range, const std::vector<double>& values) { take(values); });
                               }});
  };
  const double spacing = units.length, tension = units.to_si(1, units::dimension::tension);
  field("points", "m", D, [&cells, spacing](int cell, std::vector<double>& values) {
    for (int i = cells.cells[cell].first; i < cells.cells[cell].end(); ++i)
      for (int k = 0; k < D; ++k) values.push_back(units::coordinate(cells.position[k][i], spacing));
  });
  field("tension", "N/m", 1, [&cells, tasks, tension](int cell, std::vector<double>& values) {
    for (const double of_place : tensions_of(cells, cell, tasks->tensions(cell))) values.push_back(of_place * tension);
  });
  if constexpr (D == 3) {
    field("curvature", "1/m", 1,
          [&cells, spacing](int cell, std::vector<double>& values) { add_curvatures(cells, cell, spacing, values); });
    snapshot.triangles = [&cells](int cell) -> const Triangles& { return cells.type_of(cell).mesh.triangles(); };
  }
  return snapshot;
}

template MembraneSnapshot observe_membranes(core::AnySolver<2>&, const units::LatticeUnits&);
template MembraneSnapshot observe_membranes(core::AnySolver<3>&, const units::LatticeUnits&);

}  // namespace rouleau::observe
