#include "coupling.hpp"

#include <algorithm>
#include <rouleau/dispatch.hpp>
#include <type_traits>

#include "core/domain/vectors.hpp"
#include "core/domain/wrapped.hpp"
#include "core/fluid/walls.hpp"
#include "kernel.hpp"
#include "spread.hpp"
#include "wall_share.hpp"

namespace rouleau::core {

namespace {

constexpr std::size_t large_field = 1 << 20;  // bytes; a field that does not stay in the cache
constexpr int many_nodes = 4000;              // whose forces and weights do not stay there, either
template <class T>
struct LocateTask {
  Stencils<int, T> to;
  const double *x, *y;
  int begin, end;
  double width, height;    // of the whole lattice
  bool walls;              // below and above
  double lowest, highest;  // set to the least and the largest base row; `outside` for a stencil off the lattice
};

/// Base nodes and what is kept of the weights, which is computed in double precision before it is rounded to T.
template <class T, class Kernel>
struct Locate {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(LocateTask<T>* task) {
    using S = Pack<double, register_bytes / 8>;
    const LocateTask<T> t = *task;
    S lowest = t.height, highest = outside;
    for (int first = t.begin; first < t.end; first += S::size) {
      const int valid = std::min(S::size, t.end - first);
      if (valid == S::size) {
        const S base = group<S>(t, S::load(t.x + first), S::load(t.y + first), first, valid);
        lowest = min(lowest, base), highest = max(highest, base);
      } else {
        // The last node stands for those that are missing.
        double x[S::size], y[S::size];
        for (int k = 0; k < S::size; ++k) {
          x[k] = t.x[first + std::min(k, valid - 1)];
          y[k] = t.y[first + std::min(k, valid - 1)];
        }
        const S base = group<S>(t, S::load(x), S::load(y), first, valid);
        lowest = min(lowest, base), highest = max(highest, base);
      }
    }
    task->lowest = least(lowest);
    task->highest = largest(highest);
  }

 private:
  /// Returns the base rows.
  template <class S>
  ROULEAU_ALWAYS_INLINE static S group(const LocateTask<T>& t, const S& x, const S& y, int first, int valid) {
    const S shifted_x = x + Kernel::shift, shifted_y = y + Kernel::shift;
    S base_x = floor(shifted_x), base_y = floor(shifted_y);
    S p_x, q_x, p_y, q_y;
    Kernel::keep(shifted_x - base_x, p_x, q_x);
    Kernel::keep(shifted_y - base_y, p_y, q_y);
    base_x = wrapped(base_x, t.width);
    // Beyond 1e9, and for NaN, the conversion to int below would be undefined. One comparison a line: g++ 12 takes
    // combined masks apart element by element.
    const S last = 1e9, none = outside;
    if (t.walls) {
      base_y = select(base_y >= S(-1.0), base_y, none);
      base_y = select(base_y < S(t.height), base_y, none);
    } else {
      base_y = select(abs(y) < last, wrapped(base_y, t.height), none);
    }
    base_y = select(abs(x) < last, base_y, none);
    base_x = select(base_y > S(outside + 1.0), base_x, S(0.0));
    put(base_x, t.to.column + first, valid);
    put(base_y, t.to.row + first, valid);
    put(p_x, t.to.p_x + first, valid);
    put(q_x, t.to.q_x + first, valid);
    put(p_y, t.to.p_y + first, valid);
    put(q_y, t.to.q_y + first, valid);
    return base_y;
  }
  /// Writes the first `valid` of the values, converted.
  template <class S, class To>
  ROULEAU_ALWAYS_INLINE static void put(const S& values, To* to, int valid) {
    if (valid == S::size) return store_as(values, to);
    To all[S::size];
    store_as(values, all);
    std::copy_n(all, valid, to);
  }
};

template <class T>
struct InterpolateTask {
  KnownStencils<T> at;
  double *velocity_x, *velocity_y;
  int begin, end;
  const T *origin_x, *origin_y;
  std::ptrdiff_t stride;
  bool fetch_ahead;     // most of the fields has left the cache since the fluid's step
  const Box<2>* block;  // nodes above others are left alone; null: there are no others
};

template <class T, class Kernel>
struct Interpolate {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const InterpolateTask<T>* task) {
    if (task->block == nullptr) {
      run_all<false>(*task);
    } else {
      run_all<true>(*task);
    }
  }

 private:
  using Four = Pack<T, 4>;
  using Velocities = Line<T, Kernel::points>;
  /// `in_block`: only nodes above the block.
  template <bool in_block>
  ROULEAU_ALWAYS_INLINE static void run_all(const InterpolateTask<T>& task) {
    const InterpolateTask<T> t = task;
    if (in_block && t.fetch_ahead) {  // a call for each cell
      for (int first = t.begin; first < std::min(t.begin + lead, t.end); ++first) fetch<in_block>(t, first);
    }
    int i = t.begin;
    for (; i + 2 <= t.end; i += 2) {
      if (t.fetch_ahead && i + lead + 2 <= t.end) {
        fetch<in_block>(t, i + lead);
        fetch<in_block>(t, i + lead + 1);
      }
      if (!in_block || (here(t, i) && here(t, i + 1))) {
        interpolate_two(t, i);
      } else {
        if (here(t, i)) interpolate(t, i);
        if (here(t, i + 1)) interpolate(t, i + 1);
      }
    }
    if (i < t.end && (!in_block || here(t, i))) interpolate(t, i);
  }
  ROULEAU_ALWAYS_INLINE static bool here(const InterpolateTask<T>& t, int i) {
    return t.block->contains({t.at.column[i], std::max(t.at.row[i], 0)});
  }
  ROULEAU_ALWAYS_INLINE static void interpolate_two(const InterpolateTask<T>& t, int i) {
    Four u[2], v[2];
    for (int k = 0; k < 2; ++k) weigh(t, i + k, u[k], v[k]);
    const Four sums = sum(u[0], u[1], v[0], v[1]);
    for (int k = 0; k < 2; ++k) {
      t.velocity_x[i + k] = sums.vector[k];
      t.velocity_y[i + k] = sums.vector[2 + k];
    }
  }
  ROULEAU_ALWAYS_INLINE static void interpolate(const InterpolateTask<T>& t, int i) {
    Four u, v;
    weigh(t, i, u, v);
    const Four sums = sum(u, u, v, v);
    t.velocity_x[i] = sums.vector[0];
    t.velocity_y[i] = sums.vector[2];
  }
  static constexpr int lead = 16;  // nodes from the fetched one to the present one
  template <bool in_block>
  ROULEAU_ALWAYS_INLINE static void fetch(const InterpolateTask<T>& t, int i) {
    if (t.at.row[i] == outside || (in_block && !here(t, i))) return;
    const std::ptrdiff_t at = (t.at.row[i] + Kernel::first) * t.stride + t.at.column[i];
    for (int k = 0; k < Kernel::points; ++k) {
      __builtin_prefetch(t.origin_x + at + k * t.stride);
      __builtin_prefetch(t.origin_y + at + k * t.stride);
    }
  }
  /// Columns of the stencil, weighted along y and x: their sums are the node's velocity.
  ROULEAU_ALWAYS_INLINE static void weigh(const InterpolateTask<T>& t, int i, Four& u, Four& v) {
    u = v = T(0);
    if (t.at.row[i] == outside) return;
    const Velocities wx = KernelWeights<Kernel, T>(t.at.p_x[i], t.at.q_x[i]).weight;
    const SpreadWeights<Kernel, T> wy(t.at.p_y[i], t.at.q_y[i]);
    const std::ptrdiff_t at = (t.at.row[i] + Kernel::first) * t.stride + t.at.column[i] + Kernel::first;
    Velocities along_x{}, along_y{};
    for (int k = 0; k < Kernel::points; ++k) {
      along_x = along_x + Velocities::load(t.origin_x + at + k * t.stride) * wy.weight[k];
      along_y = along_y + Velocities::load(t.origin_y + at + k * t.stride) * wy.weight[k];
    }
    u = (along_x * wx).folded();
    v = (along_y * wx).folded();
  }
  /// Sums of four packs, side by side.
  ROULEAU_ALWAYS_INLINE static Four sum(const Four& a, const Four& b, const Four& c, const Four& d) {
    const Four low = Four(interleave_even(a.vector, b.vector)) + Four(interleave_odd(a.vector, b.vector));
    const Four high = Four(interleave_even(c.vector, d.vector)) + Four(interleave_odd(c.vector, d.vector));
    return Four(first_halves(low.vector, high.vector)) + Four(second_halves(low.vector, high.vector));
  }
  using Vector = typename Four::Vector;
  ROULEAU_ALWAYS_INLINE static Vector interleave_even(const Vector& a, const Vector& b) {
    return __builtin_shufflevector(a, b, 0, 4, 2, 6);
  }
  ROULEAU_ALWAYS_INLINE static Vector interleave_odd(const Vector& a, const Vector& b) {
    return __builtin_shufflevector(a, b, 1, 5, 3, 7);
  }
  ROULEAU_ALWAYS_INLINE static Vector first_halves(const Vector& a, const Vector& b) {
    return __builtin_shufflevector(a, b, 0, 1, 4, 5);
  }
  ROULEAU_ALWAYS_INLINE static Vector second_halves(const Vector& a, const Vector& b) {
    return __builtin_shufflevector(a, b, 2, 3, 6, 7);
  }
};

}  // namespace

/// The loops for one kernel.
template <class T>
struct Coupling<T>::Loops {
  int first, points;  // of the kernel
  void (*locate)(LocateTask<T>*);
  void (*spread)(const SpreadTask<T>*);
  void (*interpolate)(const InterpolateTask<T>*);
  StencilAlong (*along)(int base, T p, T q);

  template <class Kernel>
  static const Loops* of() {
    static const Loops loops{Kernel::first,
                             Kernel::points,
                             Dispatch<Locate<T, Kernel>, LocateTask<T>*>::pick(),
                             pick_spread<Kernel, T>(),
                             Dispatch<Interpolate<T, Kernel>, const InterpolateTask<T>*>::pick(),
                             &StencilAlong::of<Kernel, T>};
    return &loops;
  }
  static const Loops* of(KernelKind kernel) {
    return with_kernel(kernel, []<class Kernel>(Kernel) { return of<Kernel>(); });
  }
};

template <class T>
Coupling<T>::Coupling(KernelKind kernel, const Domain<2>& domain) : loops_(Loops::of(kernel)), domain_(domain) {}

template <class T>
void Coupling<T>::reserve(const Membranes& membranes) {
  const auto nodes = static_cast<std::size_t>(membranes.node_count());
  for (auto* values : {&column_, &row_}) *values = PagedArray<int>(nodes);
  for (auto* values : {&p_x_, &q_x_, &p_y_, &q_y_}) *values = PagedArray<T>(nodes);
  rows_.assign(membranes.cells.size(), {0, 0});
}

template <class T>
void Coupling<T>::locate(Worker worker, const Membranes& membranes, NodeVectors position, Whose whose) {
  const CellNumbers cells = membranes.known_cells(worker);
  for (const int c : cells) {
    if (!membranes.is(c, whose)) continue;
    const CellRange& cell = membranes.cells[c];
    LocateTask<T> task{.to = {column_.data(), row_.data(), p_x_.data(), q_x_.data(), p_y_.data(), q_y_.data()},
                       .x = position.x,
                       .y = position.y,
                       .begin = cell.first,
                       .end = cell.end(),
                       .width = 1.0 * domain_.size[0],
                       .height = 1.0 * domain_.size[1],
                       .walls = domain_.walled(1),
                       .lowest = 0,
                       .highest = 0};
    loops_->locate(&task);
    rows_[c] = {static_cast<int>(task.lowest), static_cast<int>(task.highest)};
  }
}

template <class T>
void Coupling<T>::spread(Range rows, const Membranes& membranes, NodeVectors node_force,
                         VectorField<T, 2>& force) const {
  const std::ptrdiff_t stride = force[0].stride(1);
  const std::ptrdiff_t first = domain_.block.begin[1] * stride + domain_.block.begin[0];
  SpreadTask<T> task{.at = {column_.data(), row_.data(), p_x_.data(), q_x_.data(), p_y_.data(), q_y_.data()},
                     .force_x = node_force.x,
                     .force_y = node_force.y,
                     .begin = 0,
                     .end = 0,
                     .domain = &domain_,
                     .row_begin = domain_.block.begin[1] + rows.begin,
                     .row_end = domain_.block.begin[1] + rows.end,
                     .origin_x = force[0].row(0) - first,
                     .origin_y = force[1].row(0) - first,
                     .stride = stride};
  const auto for_cells = [&](auto function) {
    for (const int c : membranes.known_cells()) {
      if (!membranes.reaches(c)) continue;
      const BaseRows& base = rows_[c];
      const int lowest = base.lowest + loops_->first, beyond = base.highest + loops_->first + loops_->points;
      const bool whole = lowest >= 0 && beyond <= domain_.size[1];  // no stencil reaches over a border
      if (!whole || (beyond > task.row_begin && lowest < task.row_end)) function(membranes.cells[c]);
    }
  };
  if (membranes.node_count() > many_nodes) for_cells([&](const CellRange& cell) { warm(cell, node_force); });
  for_cells([&](const CellRange& cell) {
    task.begin = cell.first, task.end = cell.end();
    loops_->spread(&task);
  });
}

// Spreading stops and goes, and visits a cell's nodes from four sides: no prefetcher follows it, while it follows this.
template <class T>
void Coupling<T>::warm(const CellRange& cell, NodeVectors vectors) const {
  const auto touch = [](const auto* values, int i) {
    static_cast<void>(*static_cast<const volatile std::remove_cvref_t<decltype(*values)>*>(values + i));
  };
  for (int i = cell.first; i < cell.end(); i += 64 / static_cast<int>(sizeof(double))) {
    touch(vectors.x, i), touch(vectors.y, i), touch(column_.data(), i), touch(row_.data(), i);
    for (const auto* values : {&p_x_, &q_x_, &p_y_, &q_y_}) touch(values->data(), i);
  }
}

template <class T>
void Coupling<T>::interpolate(Worker worker, Membranes& membranes, const VectorField<T, 2>& velocity,
                              Whose whose) const {
  const Range nodes = membranes.node_share(worker);
  const std::ptrdiff_t stride = velocity[0].stride(1);
  const std::ptrdiff_t first = domain_.block.begin[1] * stride + domain_.block.begin[0];
  InterpolateTask<T> task{{column_.data(), row_.data(), p_x_.data(), q_x_.data(), p_y_.data(), q_y_.data()},
                          membranes.velocity[0].data(),
                          membranes.velocity[1].data(),
                          nodes.begin,
                          nodes.end,
                          velocity[0].row(0) - first,
                          velocity[1].row(0) - first,
                          stride,
                          velocity[0].bytes() > large_field,
                          domain_.whole() ? nullptr : &domain_.block};
  if (domain_.whole()) return loops_->interpolate(&task);
  const CellNumbers cells = membranes.known_cells(worker);
  for (const int c : cells) {
    if (!membranes.reaches(c) || !membranes.is(c, whose)) continue;
    task.begin = membranes.cells[c].first, task.end = membranes.cells[c].end();
    loops_->interpolate(&task);
  }
}

template <class T>
WallForces<2> Coupling<T>::wall_share(const Membranes& membranes, NodeVectors force, const Ranks<2>& ranks) const {
  WallForceSums<2> sums;
  for (const int c : membranes.own_cells()) {
    for (int i = membranes.cells[c].first; i < membranes.cells[c].end(); ++i) {
      if (row_[i] == outside) continue;
      add_wall_share<2>({force.x[i], force.y[i]}, {StencilAlong{}, loops_->along(row_[i], p_y_[i], q_y_[i])}, domain_,
                        nullptr, sums);
    }
  }
  return sums.total(ranks);
}

template <class T>
bool Coupling<T>::any_escaped(const Membranes& membranes) const {
  for (const int c : membranes.known_cells()) {
    if (rows_[c].lowest == outside) return true;
  }
  return false;
}

template <class T>
int Coupling<T>::escaped(const Membranes& membranes) const {
  for (const int c : membranes.own_cells()) {
    const CellRange& cell = membranes.cells[c];
    if (rows_[c].lowest == outside)
      return static_cast<int>(std::find(row_.data() + cell.first, row_.data() + cell.end(), outside) - row_.data());
  }
  return -1;
}

template <class T>
void Coupling<T>::forget(std::span<const Range> nodes) {
  for (auto* values : {&column_, &row_}) release(*values, nodes);
  for (auto* values : {&p_x_, &q_x_, &p_y_, &q_y_}) release(*values, nodes);
}

template class Coupling<float>;
template class Coupling<double>;

}  // namespace rouleau::core
