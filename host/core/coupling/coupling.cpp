#include "coupling.hpp"

#include <stdexcept>
#include <type_traits>

#include "stencils.hpp"

namespace rouleau::core {

namespace {

constexpr std::size_t large_field = 1 << 20;  // bytes; a field that does not stay in the cache
constexpr int many_nodes = 4000;              // whose forces and weights do not stay there, either

}  // namespace

template <class T, int D>
Coupling<T, D>::Coupling(KernelKind kernel, const Domain<D>& domain, const SolidNodes<D>* solid,
                         const RegionPointer<D>& region, double wall_time)
    : loops_(StencilLoops<T, D>::of(kernel)), domain_(domain) {
  if (solid != nullptr && !region) throw std::invalid_argument("cells beside solid nodes need the region of the fluid");
  if (solid != nullptr)
    reach_ = std::make_unique<const WallReach<D>>(domain, *solid, *region, loops_->points, wall_time);
  walls_move_ = wall_time != 0;
}

template <class T, int D>
void Coupling<T, D>::reserve(const Cells<D>& cells) {
  const auto nodes = static_cast<std::size_t>(cells.node_count());
  for (int k = 0; k < D; ++k) {
    base_[k] = PagedArray<int>(nodes);
    for (auto* values : {&p_[k], &q_[k]}) *values = PagedArray<T>(nodes);
  }
  bases_.assign(cells.cells.size(), {0, 0});
  if (!reach_) return;
  factors_ = PagedArray<double>(nodes);
  for (int k = 0; k < D && walls_move_; ++k) carried_[k] = PagedArray<double>(nodes);
  beside_wall_.assign(cells.cells.size(), 0);
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
    if (reach_) find_factors(cells.cells[c], c);
  }
}

template <class T, int D>
std::array<StencilAlong, D> Coupling<T, D>::stencil(int node) const {
  std::array<StencilAlong, D> stencil;
  for (int k = 0; k < D; ++k) stencil[k] = loops_->along(base_[k][node], p_[k][node], q_[k][node]);
  return stencil;
}

template <class T, int D>
void Coupling<T, D>::find_factors(const CellRange& cell, int number) {
  beside_wall_[number] = 0;
  for (int i = cell.first; i < cell.end(); ++i) {
    factors_[i] = 1;
    for (int k = 0; k < D && walls_move_; ++k) carried_[k][i] = 0;
    if (base_[D - 1][i] == outside) continue;
    std::array<int, D> first;
    for (int k = 0; k < D; ++k) first[k] = base_[k][i] + loops_->first;
    if (!reach_->touches(first)) continue;
    factors_[i] = reach_->factor(stencil(i));
    beside_wall_[number] = 1;
    if (!walls_move_) continue;
    const Vec<D> carried = reach_->carried(stencil(i), factors_[i]);
    for (int k = 0; k < D; ++k) carried_[k][i] = carried[k];
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
  for (int k = 0; k < D; ++k) task.origin[k] = force[k].row(std::array<int, D - 1>{}) - first_of_block(force[k]);
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
      if (!whole || (beyond > begin && lowest < end)) function(cells.cells[c], c);
    }
  };
  if (D == 2 && cells.node_count() > many_nodes) for_cells([&](const CellRange& cell, int) { warm(cell, forces); });
  std::array<std::vector<double>, D> scaled;  // of a cell
  for_cells([&](const CellRange& cell, int c) {
    const bool beside_wall = reach_ && beside_wall_[c] != 0;
    for (int k = 0; k < D; ++k) {
      task.force[k] = forces[k];
      if (!beside_wall) continue;
      scaled[k].assign(forces[k] + cell.first, forces[k] + cell.end());
      for (int i = 0; i < cell.count; ++i) scaled[k][i] *= factors_[cell.first + i];
      task.force[k] = scaled[k].data() - cell.first;
    }
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
  if (domain_.whole() && cells.part.empty()) {
    const Range nodes = cells.node_share(worker);
    task.begin = nodes.begin, task.end = nodes.end;
    loops_->interpolate(&task);
    for (int i = nodes.begin; i < nodes.end && reach_; ++i) complete(i, task.velocity);
    return;
  }
  task.block = &domain_.block;
  for (const int c : cells.known_cells(worker)) {
    if (!cells.reaches(c) || !cells.is(c, whose)) continue;
    task.begin = cells.cells[c].first, task.end = cells.cells[c].end();
    loops_->interpolate(&task);
    for (int i = task.begin; i < task.end && reach_ && beside_wall_[c] != 0; ++i)
      if (domain_.block.contains(base(i))) complete(i, task.velocity);
  }
}

template <class T, int D>
WallForces<D> Coupling<T, D>::wall_share(const Cells<D>& cells, const Vectors& force, const Ranks<D>& ranks) const {
  WallForceSums<D> sums;
  for (const int c : cells.known_cells()) {
    if (!cells.reaches(c)) continue;
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      // Each node is one block's.
      if (base_[D - 1][i] == outside || !domain_.block.contains(base(i))) continue;
      const std::array<StencilAlong, D> of_stencil = stencil(i);
      std::array<double, D> of_node;
      std::array<int, D> first;
      for (int k = 0; k < D; ++k) of_node[k] = force[k][i], first[k] = of_stencil[k].first;
      if (reach_ && reach_->touches(first))
        reach_->add_share(of_node, of_stencil, sums);
      else
        add_wall_share<D>(of_node, of_stencil, domain_, sums);
    }
  }
  return sums.total(ranks);
}

template <class T, int D>
bool Coupling<T, D>::any_escaped(const Cells<D>& cells) const {
  for (const int c : cells.known_cells())
    if (bases_[c].lowest == outside) return true;
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
  if (reach_) release(factors_, nodes);
  for (int k = 0; k < D && walls_move_; ++k) release(carried_[k], nodes);
}

template class Coupling<float, 2>;
template class Coupling<double, 2>;
template class Coupling<float, 3>;
template class Coupling<double, 3>;

}  // namespace rouleau::core
