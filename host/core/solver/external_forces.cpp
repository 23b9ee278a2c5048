#include "external_forces.hpp"

namespace rouleau::core {

namespace {

/// Calls visit(corners, outer normal times area or length) for each segment or triangle; nodes counted from the first.
template <class Visit>
void for_facets(const Membranes& membranes, int cell, Visit visit) {
  const CellRange& range = membranes.cells[cell];
  const auto [x, y] = pointers<2>(membranes.position, range.first);
  for (int a = 0; a < range.count; ++a) {
    const int b = (a + 1) % range.count;
    visit(std::array{a, b}, Vec<2>(y[b] - y[a], x[a] - x[b]));
  }
}
template <class Visit>
void for_facets(const Surfaces& surfaces, int cell, Visit visit) {
  const Mesh& mesh = surfaces.type_of(cell).mesh;
  const std::vector<Vec<3>> twice = area_vectors(mesh, surfaces.nodes(cell));
  for (std::size_t t = 0; t < twice.size(); ++t) visit(mesh.triangles()[t], Vec<3>(0.5 * twice[t]));
}

double rest_content(const Membranes& membranes, int cell) { return membranes.cells[cell].rest_area; }
double rest_content(const Surfaces& surfaces, int cell) { return surfaces.type_of(cell).rest_volume; }

/// A pressure on the membrane that grows along the weight: minus the exact gradient of the polyhedron's energy, so that
/// its sum is the weight (docs: physics, forces on cells). The content weighs what it did at rest. The pressure is 0 at
/// the mean of the nodes; a constant one would do nothing.
template <int D>
void add_weight(const Cells<D>& cells, int cell, const Vec<D>& weight, std::array<double*, D> force) {
  const CellRange& range = cells.cells[cell];
  Vec<D> middle = Vec<D>::Zero();
  for (int i = range.first; i < range.end(); ++i) middle += vector_at<D>(cells.position, i) / range.count;
  double content = 0;
  std::vector<double> pressure(static_cast<std::size_t>(range.count));
  for (int i = 0; i < range.count; ++i)
    pressure[i] = weight.dot(vector_at<D>(cells.position, range.first + i) - middle);
  for_facets(cells, cell, [&](const auto& corners, const Vec<D>& normal) {
    content += normal.dot(vector_at<D>(cells.position, range.first + corners[0]) - middle) / D;
  });
  const double scale = rest_content(cells, cell) / (content * D * (D + 1));
  for_facets(cells, cell, [&](const auto& corners, const Vec<D>& normal) {
    double sum = 0;
    for (const int node : corners) sum += pressure[node];
    for (const int node : corners)
      for (int k = 0; k < D; ++k) force[k][node] += scale * (sum + pressure[node]) * normal[k];
  });
}

}  // namespace

template <int D>
void ExternalForces<D>::add(const Cells<D>& cells, int cell, std::array<double*, D> force) const {
  const auto time = static_cast<double>(steps);
  for (const PatchForce<D>& pull : pulls) {
    const ForcePatch* const patch = pull.patch[cell].get();
    const double left = time < pull.ramp_steps ? 1 - time / pull.ramp_steps : 0;
    const Vec<D> now = pull.after + left * (pull.before - pull.after);
    for (std::size_t i = 0; patch != nullptr && i < patch->node.size(); ++i)
      for (int k = 0; k < D; ++k) force[k][patch->node[i]] += patch->share[i] * now[k];
  }
  const int type = cells.cells[cell].type;
  if (!weight.empty() && !weight[type].isZero(0)) add_weight<D>(cells, cell, weight[type], force);
}

template <int D>
void ExternalForces<D>::run(Worker worker, Cells<D>& cells) const {
  if (!any()) return;
  for (const int cell : cells.own_cells(worker)) add(cells, cell, pointers<D>(cells.force, cells.cells[cell].first));
}

template <int D>
std::array<double, 4> ExternalForces<D>::sums(const Cells<D>& cells, const Ranks<D>& ranks) const {
  std::vector<ExactSum> sums(4);
  NodeArrays force;
  for (const int cell : cells.own_cells()) {
    const CellRange& range = cells.cells[cell];
    for (auto& along : along_axes<D>(force)) along.assign(static_cast<std::size_t>(range.count), 0);
    add(cells, cell, pointers<D>(force));
    for (std::size_t k = 0; k < D; ++k) {
      for (int i = 0; i < range.count; ++i) {
        sums[k].add(force[k][i]);
        sums[3].add(force[k][i] * cells.velocity[k][range.first + i]);
      }
    }
  }
  add_up(ranks, sums);
  return {sums[0].value(), sums[1].value(), sums[2].value(), sums[3].value()};
}

template struct ExternalForces<2>;
template struct ExternalForces<3>;

}  // namespace rouleau::core
