#include "coupling.hpp"

#include <type_traits>

#include "stencils.hpp"

namespace rouleau::core {

namespace {

constexpr std::size_t large_field = 1 << 20;  // bytes; a field that does not stay in the cache
constexpr int many_nodes = 4000;              // whose forces and weights do not stay there, either

}  // namespace

template <class T, int D>
Coupling<T, D>::Coupling(KernelKind kernel, const Domain<D>& domain)
    : loops_(StencilLoops<T, D>::of(kernel)), domain_(domain) {}

template <class T, int D>
void Coupling<T, D>::reserve(const Cells<D>& cells) {
  const auto nodes = static_cast<std::size_t>(cells.node_count());
  for (int k = 0; k < D; ++k) {
    base_[k] = PagedArray<int>(nodes);
    for (auto* values : {&p_[k], &q_[k]}) *values = PagedArray<T>(nodes);
  }
  bases_.assign(cells.cells.size(), {0, 0});
}

template <class T, int D>
void Coupling<T, D>::locate(Worker worker, const Cells<D>& cells, const Vectors& positions, Whose whose) {
  LocateTask<T, D> task{};
  for (int k = 0; k < D; ++k) {
    task.to.base[k] = base_[k].data(), task.to.p[k] = p_[k].data(), task.to.q[k] = q_[k].data();
    task.place[k] = positions[k];
    task.size[k] = domain_.size[k], task.periodic[k] = domain_.periodic[k];
  }
  for (const int c : cells.known_cells(worker)) {
    if (!cells.is(c, whose)) continue;
    task.begin = cells.cells[c].first, task.end = cells.cells[c].end();
    loops_->locate(&task);
    bases_[c] = {static_cast<int>(task.lowest), static_cast<int>(task.highest)};
  }
}

template <class T, int D>
template <class Task>
void Coupling<T, D>::describe(Task& task, const VectorField<T, D>& fields) const {
  for (int k = 0; k < D; ++k) {
    task.at.base[k] = base_[k].data(), task.at.p[k] = p_[k].data(), task.at.q[k] = q_[k].data();
    task.stride[k] = fields[k].stride(k);
  }
}

template <class T, int D>
void Coupling<T, D>::spread(Range rows, const Cells<D>& cells, const Vectors& forces, VectorField<T, D>& force) const {
  const Box<D>& block = domain_.block;
  SpreadTask<T, D> task{};
  describe(task, force);
  for (int k = 0; k < D; ++k) {
    task.force[k] = forces[k];
    task.origin[k] = force[k].row(std::array<int, D - 1>{}) - first_of_block(force[k]);
  }
  task.domain = &domain_;
  task.row_begin = rows.begin, task.row_end = rows.end;
  // Where these rows lie along the last axis.
  const int rows_of_layer = row_count(block) / block.size(D - 1);
  const int begin = block.begin[D - 1] + rows.begin / rows_of_layer,
            end = block.begin[D - 1] + (rows.end + rows_of_layer - 1) / rows_of_layer;
  const auto for_cells = [&](auto function) {
    for (const int c : cells.known_cells()) {
      if (!cells.reaches(c)) continue;
      const int lowest = bases_[c].lowest + loops_->first, beyond = bases_[c].highest + loops_->first + loops_->points;
      const bool whole = lowest >= 0 && beyond <= domain_.size[D - 1];  // no stencil reaches over a border
      if (!whole || (beyond > begin && lowest < end)) function(cells.cells[c]);
    }
  };
  if (D == 2 && cells.node_count() > many_nodes) for_cells([&](const CellRange& cell) { warm(cell, forces); });
  for_cells([&](const CellRange& cell) {
    task.begin = cell.first, task.end = cell.end();
    loops_->spread(&task);
  });
}

// Spreading stops and goes, and visits an outline's nodes from four sides: no prefetcher follows it, while it follows
// this.
template <class T, int D>
void Coupling<T, D>::warm(const CellRange& cell, const Vectors& vectors) const {
  const auto touch = [](const auto* values, int i) {
    static_cast<void>(*static_cast<const volatile std::remove_cvref_t<decltype(*values)>*>(values + i));
  };
  for (int i = cell.first; i < cell.end(); i += 64 / static_cast<int>(sizeof(double))) {
    for (int k = 0; k < D; ++k) {
      touch(vectors[k], i), touch(base_[k].data(), i);
      touch(p_[k].data(), i), touch(q_[k].data(), i);
    }
  }
}

template <class T, int D>
void Coupling<T, D>::interpolate(Worker worker, Cells<D>& cells, const VectorField<T, D>& velocity, Whose whose) const {
  InterpolateTask<T, D> task{};
  describe(task, velocity);
  for (int k = 0; k < D; ++k) {
    task.velocity[k] = cells.velocity[k].data();
    task.origin[k] = velocity[k].row(std::array<int, D - 1>{}) - first_of_block(velocity[k]);
  }
  task.fetch_ahead = velocity[0].bytes() > large_field;
  if (domain_.whole()) {
    const Range nodes = cells.node_share(worker);
    task.begin = nodes.begin, task.end = nodes.end;
    return loops_->interpolate(&task);
  }
  task.block = &domain_.block;
  for (const int c : cells.known_cells(worker)) {
    if (!cells.reaches(c) || !cells.is(c, whose)) continue;
    task.begin = cells.cells[c].first, task.end = cells.cells[c].end();
    loops_->interpolate(&task);
  }
}

template <class T, int D>
WallForces<D> Coupling<T, D>::wall_share(const Cells<D>& cells, const Vectors& force, const SolidNodes<D>* solid,
                                         const Ranks<D>& ranks) const {
  WallForceSums<D> sums;
  for (const int c : cells.own_cells()) {
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      if (base_[D - 1][i] == outside) continue;
      std::array<double, D> of_node;
      std::array<StencilAlong, D> stencil;
      for (int k = 0; k < D; ++k) {
        of_node[k] = force[k][i];
        stencil[k] = loops_->along(base_[k][i], p_[k][i], q_[k][i]);
      }
      add_wall_share<D>(of_node, stencil, domain_, solid, sums);
    }
  }
  return sums.total(ranks);
}

template <class T, int D>
bool Coupling<T, D>::any_escaped(const Cells<D>& cells) const {
  for (const int c : cells.known_cells()) {
    if (bases_[c].lowest == outside) return true;
  }
  return false;
}

template <class T, int D>
int Coupling<T, D>::escaped(const Cells<D>& cells) const {
  const int* base = base_[D - 1].data();
  for (const int c : cells.own_cells()) {
    const CellRange& cell = cells.cells[c];
    if (bases_[c].lowest == outside)
      return static_cast<int>(std::find(base + cell.first, base + cell.end(), outside) - base);
  }
  return -1;
}

template <class T, int D>
void Coupling<T, D>::forget(std::span<const Range> nodes) {
  for (int k = 0; k < D; ++k) {
    release(base_[k], nodes);
    for (auto* values : {&p_[k], &q_[k]}) release(*values, nodes);
  }
}

template class Coupling<float, 2>;
template class Coupling<double, 2>;
template class Coupling<float, 3>;
template class Coupling<double, 3>;

}  // namespace rouleau::core
