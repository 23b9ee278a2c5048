#include "surface_coupling.hpp"

#include <algorithm>
#include <rouleau/dispatch.hpp>

#include "core/domain/vectors.hpp"
#include "core/domain/wrapped.hpp"
#include "core/fluid/walls.hpp"
#include "kernel.hpp"
#include "spread.hpp"
#include "wall_share.hpp"

namespace rouleau::core {

namespace {

template <class T>
struct LocateTask {
  const double* place[3];
  int* base[3];
  T *p[3], *q[3];
  int begin, end;  // nodes
  double size[3];  // of the lattice
  bool periodic[3];
  double lowest, highest;  // set to the least and the largest base plane; `outside` for a stencil off the lattice
};

/// Base nodes and what is kept of the weights, which is computed in double precision before it is rounded to T.
template <class T, class Kernel>
struct LocateSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(LocateTask<T>* task) {
    const LocateTask<T> t = *task;
    using Packed = Pack<double, register_bytes / 8>;
    Packed low = t.size[2], high = outside;
    int i = t.begin;
    const auto locate = [&]<class S>(S & lowest, S & highest) __attribute__((always_inline)) {
      for (; i + S::size <= t.end; i += S::size) {
        const S plane = base<S>(t, i);
        lowest = min(lowest, plane), highest = max(highest, plane);
      }
    };
    locate(low, high);
    Pack<double, 1> lowest = least(low), highest = largest(high);
    locate(lowest, highest);
    task->lowest = lowest.vector[0], task->highest = highest.vector[0];
  }

 private:
  /// Returns the base planes. Half a spacing beyond a wall is not outside.
  template <class S>
  ROULEAU_ALWAYS_INLINE static S base(const LocateTask<T>& t, int i) {
    const S none = outside;
    S base[3], lowest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const S shifted = S::load(t.place[k] + i) + Kernel::shift, below = floor(shifted);
      S p, q;
      Kernel::keep(shifted - below, p, q);
      store_as(p, t.p[k] + i), store_as(q, t.q[k] + i);
      // One comparison a line: g++ 12 takes combined masks apart element by element.
      if (t.periodic[k]) {
        base[k] = wrapped(below, t.size[k]);
      } else {
        base[k] = select(below >= S(-1.0), below, none);
        base[k] = select(below < S(t.size[k]), base[k], none);
      }
      base[k] = select(abs(shifted) < S(1e9), base[k], none);  // false for NaN, too
      store_as(base[k], t.base[k] + i);
      lowest = min(lowest, base[k]);
    }
    base[2] = select(lowest > S(outside + 1.0), base[2], none);
    store_as(base[2], t.base[2] + i);
    return base[2];
  }
};

template <class T>
struct SurfaceStencils {
  const int* base[3];
  const T *p[3], *q[3];
};

template <class T>
struct SurfaceSpread {
  SurfaceStencils<T> at;
  const double* force[3];
  int begin, end;  // nodes of one cell
  const Domain<3>* domain;
  int row_begin, row_end;  // of the block
  T* origin[3];            // where node (0, 0, 0) of the lattice lies, or would lie if it belonged to the block
  std::ptrdiff_t stride_y, stride_z;
};

/// Weights of a node's stencil: along x, and one for each of its rows. `before`: Line.
template <class T, class Kernel>
struct StencilWeights {
  using Lanes = typename Line<T, Kernel::points>::Lanes;
  Line<T, Kernel::points> along_x;
  SpreadWeights<Kernel, T> y, z;
  ROULEAU_ALWAYS_INLINE StencilWeights(const SurfaceStencils<T>& at, int i, int before)
      : along_x(KernelWeights<Kernel, T>(at.p[0][i], at.q[0][i], before).weight),
        y(at.p[1][i], at.q[1][i]),
        z(at.p[2][i], at.q[2][i]) {}
  [[nodiscard]] ROULEAU_ALWAYS_INLINE Lanes of_row(int along_z, int along_y) const {
    return z.weight[along_z] * y.weight[along_y];
  }
};

template <class T, class Kernel>
struct SpreadSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceSpread<T>* task) {
    const SurfaceSpread<T> t = *task;
    for (int i = t.begin; i < t.end; ++i) spread(t, i);
  }

 private:
  static constexpr int points = Kernel::points, start = Kernel::first;
  using Forces = Line<T, points>;
  ROULEAU_ALWAYS_INLINE static void spread(const SurfaceSpread<T>& t, int i) {
    const Box<3>& block = t.domain->block;
    const int height = block.size(1);
    const int x = t.at.base[0][i] + start, y = t.at.base[1][i] + start, z = t.at.base[2][i] + start;
    const bool inside = x >= block.begin[0] && x + points <= block.end[0] && y >= block.begin[1] &&
                        y + points <= block.end[1] && z >= block.begin[2] && z + points <= block.end[2];
    if (!inside) {
      const int from[] = {x, y, z};
      for (int k = 0; k < 3; ++k) {
        const bool within = from[k] >= 0 && from[k] + points <= t.domain->size[k];
        if (within && (from[k] + points <= block.begin[k] || from[k] >= block.end[k])) return;
      }
      return spread_at_border(t, i);
    }
    const int first = y - block.begin[1] + height * (z - block.begin[2]), last = first + (points - 1) * (1 + height);
    if (last < t.row_begin || first >= t.row_end) return;
    const std::ptrdiff_t corner = z * t.stride_z + y * t.stride_y + x;
    const int before = Forces::lanes_before(t.origin[0] + corner);
    const StencilWeights<T, Kernel> weights(t.at, i, before);
    using Lanes = typename Forces::Lanes;
    const Forces fx = weights.along_x * Lanes(t.force[0][i]), fy = weights.along_x * Lanes(t.force[1][i]),
                 fz = weights.along_x * Lanes(t.force[2][i]);
    if (first >= t.row_begin && last < t.row_end) {
      add<true>(t, weights, {fx, fy, fz}, corner - before, first);
    } else {
      add<false>(t, weights, {fx, fy, fz}, corner - before, first);
    }
  }
  /// Adds to the nodes from `at` on: to all of them, or to those in rows that are to be added to; `first` is that of `at`.
  template <bool whole>
  ROULEAU_ALWAYS_INLINE static void add(const SurfaceSpread<T>& t, const StencilWeights<T, Kernel>& weights,
                                        const std::array<Forces, 3>& force, std::ptrdiff_t at, int first) {
    const int height = t.domain->block.size(1);
    for (int m = 0; m < points; ++m) {
      T *to_x = t.origin[0] + at + m * t.stride_z, *to_y = t.origin[1] + at + m * t.stride_z,
        *to_z = t.origin[2] + at + m * t.stride_z;
#pragma GCC unroll 6
      for (int l = 0; l < points; ++l) {
        const int row = first + l + height * m;
        if (whole || (row >= t.row_begin && row < t.row_end)) {
          const auto weight = weights.of_row(m, l);
          (Forces::load(to_x) + force[0] * weight).store(to_x);
          (Forces::load(to_y) + force[1] * weight).store(to_y);
          (Forces::load(to_z) + force[2] * weight).store(to_z);
        }
        to_x += t.stride_y, to_y += t.stride_y, to_z += t.stride_y;
      }
    }
  }

  struct Image {
    int node;
    int sign;  // -1 beyond a wall, where a force acts on the mirrored node with reversed sign
  };
  static Image image(const Domain<3>& domain, int axis, int node) {
    const int wrapped = domain.wrapped(axis, node);
    return wrapped >= 0 ? Image{wrapped, 1} : Image{mirrored(node, domain.size[axis]), -1};
  }
  /// The same sums: of a stencil that reaches over the border of the lattice or of the block. Where it does so along x, its points
  /// are among the first and the last nodes of a row.
  ROULEAU_ALWAYS_INLINE static void spread_at_border(const SurfaceSpread<T>& t, int i) {
    if (t.at.base[2][i] == outside) return;
    const Domain<3>& domain = *t.domain;
    const Box<3>& block = domain.block;
    const StencilWeights<T, Kernel> weights(t.at, i, 0);
    Image image_of[3][points];
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < points; ++k) image_of[axis][k] = image(domain, axis, t.at.base[axis][i] + start + k);
    }
    const auto& [along_x, along_y, along_z] = image_of;
    const int x = t.at.base[0][i] + start;
    const bool within = x >= block.begin[0] && x + points <= block.end[0];
    using Lanes = typename Forces::Lanes;
    // What a node of a row gets of the force along x, from the first node of either part on.
    constexpr int width = Lanes::size;
    int first[2] = {block.begin[0], std::max(block.begin[0], block.end[0] - width)};
    T along[2][width] = {};
    bool reached[2] = {within, false};
    if (within) {
      first[0] = x;
      weights.along_x.store(along[0]);
    } else {
      for (int k = 0; k < points; ++k) {
        const auto& [node, sign] = along_x[k];
        if (node < block.begin[0] || node >= block.end[0]) continue;
        const int part = node < first[0] + width ? 0 : 1;
        along[part][node - first[part]] += static_cast<T>(sign) * weights.along_x.at(k);
        reached[part] = true;
      }
    }
    Forces force[2][3];
    for (int part = 0; part < 2; ++part) {
      for (int c = 0; c < 3; ++c) force[part][c] = Forces::load(along[part]) * Lanes(t.force[c][i]);
    }
    for (int m = 0; m < points; ++m) {
      const Image& z = along_z[m];
      for (int l = 0; l < points; ++l) {
        const Image& y = along_y[l];
        if (y.node < block.begin[1] || y.node >= block.end[1]) continue;
        const int row = y.node - block.begin[1] + block.size(1) * (z.node - block.begin[2]);
        if (row < t.row_begin || row >= t.row_end) continue;
        const Lanes weight = Lanes(static_cast<T>(y.sign * z.sign)) * weights.of_row(m, l);
        for (int c = 0; c < 3; ++c) {
          T* const row_of_force = t.origin[c] + z.node * t.stride_z + y.node * t.stride_y;
          for (int part = 0; part < 2; ++part) {
            if (!reached[part]) continue;
            T* const to = row_of_force + first[part];
            (Forces::load(to) + force[part][c] * weight).store(to);
          }
        }
      }
    }
  }
};

template <class T>
struct SurfaceInterpolate {
  SurfaceStencils<T> at;
  double* velocity[3];
  int begin, end;
  const T* origin[3];
  std::ptrdiff_t stride_y, stride_z;
  const Box<3>* block;  // nodes above others are left alone; null: there are no others
};

template <class T, class Kernel>
struct InterpolateSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SurfaceInterpolate<T>* task) {
    const SurfaceInterpolate<T> t = *task;
    constexpr int points = Kernel::points, start = Kernel::first;
    using Velocities = Line<T, points>;
    for (int i = t.begin; i < t.end; ++i) {
      if (t.at.base[2][i] == outside) {
        for (double* velocity : t.velocity) velocity[i] = 0;
        continue;
      }
      if (t.block != nullptr && !t.block->contains({std::max(t.at.base[0][i], 0), std::max(t.at.base[1][i], 0),
                                                    std::max(t.at.base[2][i], 0)}))
        continue;
      std::ptrdiff_t at =
          (t.at.base[2][i] + start) * t.stride_z + (t.at.base[1][i] + start) * t.stride_y + t.at.base[0][i] + start;
      const int before = Velocities::lanes_before(t.origin[0] + at);
      at -= before;
      const StencilWeights<T, Kernel> weights(t.at, i, before);
      // Even and odd rows apart: each sum waits for its last term.
      Velocities u[2]{}, v[2]{}, w[2]{};
      for (int m = 0; m < points; ++m, at += t.stride_z) {
        const T *from_u = t.origin[0] + at, *from_v = t.origin[1] + at, *from_w = t.origin[2] + at;
#pragma GCC unroll 6
        for (int l = 0; l < points; ++l) {
          const auto weight = weights.of_row(m, l);
          u[l % 2] = u[l % 2] + Velocities::load(from_u) * weight;
          v[l % 2] = v[l % 2] + Velocities::load(from_v) * weight;
          w[l % 2] = w[l % 2] + Velocities::load(from_w) * weight;
          from_u += t.stride_y, from_v += t.stride_y, from_w += t.stride_y;
        }
      }
      t.velocity[0][i] = sum(((u[0] + u[1]) * weights.along_x).moved_back(before).folded());
      t.velocity[1][i] = sum(((v[0] + v[1]) * weights.along_x).moved_back(before).folded());
      t.velocity[2][i] = sum(((w[0] + w[1]) * weights.along_x).moved_back(before).folded());
    }
  }

 private:
  static ROULEAU_ALWAYS_INLINE T sum(const Pack<T, 4>& a) {
    return (a.vector[0] + a.vector[1]) + (a.vector[2] + a.vector[3]);
  }
};

}  // namespace

/// The loops for one kernel.
template <class T>
struct SurfaceCoupling<T>::Loops {
  int first, points;  // of the kernel
  void (*locate)(LocateTask<T>*);
  void (*spread)(const SurfaceSpread<T>*);
  void (*interpolate)(const SurfaceInterpolate<T>*);
  StencilAlong (*along)(int base, T p, T q);

  template <class Kernel>
  static const Loops* of() {
    static const Loops loops{Kernel::first,
                             Kernel::points,
                             Dispatch<LocateSurface<T, Kernel>, LocateTask<T>*>::pick(),
                             Dispatch<SpreadSurface<T, Kernel>, const SurfaceSpread<T>*>::pick(),
                             Dispatch<InterpolateSurface<T, Kernel>, const SurfaceInterpolate<T>*>::pick(),
                             &StencilAlong::of<Kernel, T>};
    return &loops;
  }
  static const Loops* of(KernelKind kernel) {
    return with_kernel(kernel, []<class Kernel>(Kernel) { return of<Kernel>(); });
  }
};

template <class T>
SurfaceCoupling<T>::SurfaceCoupling(KernelKind kernel, const Domain<3>& domain)
    : loops_(Loops::of(kernel)), domain_(domain) {}

template <class T>
void SurfaceCoupling<T>::reserve(const Surfaces& surfaces) {
  for (int k = 0; k < 3; ++k) {
    base_[k] = PagedArray<int>(surfaces.position[0].size());
    for (auto* values : {&p_[k], &q_[k]}) *values = PagedArray<T>(surfaces.position[0].size());
  }
  planes_.assign(surfaces.cells.size(), {0, 0});
}

template <class T>
void SurfaceCoupling<T>::locate(Worker worker, const Surfaces& surfaces, const std::array<const double*, 3>& place,
                                Whose whose) {
  LocateTask<T> task{};
  for (int k = 0; k < 3; ++k) {
    task.place[k] = place[k], task.base[k] = base_[k].data();
    task.p[k] = p_[k].data(), task.q[k] = q_[k].data();
    task.size[k] = domain_.size[k], task.periodic[k] = domain_.periodic[k];
  }
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int c : cells) {
    if (!surfaces.is(c, whose)) continue;
    task.begin = surfaces.cells[c].first, task.end = surfaces.cells[c].end();
    loops_->locate(&task);
    planes_[c] = {static_cast<int>(task.lowest), static_cast<int>(task.highest)};
  }
}

template <class T>
void SurfaceCoupling<T>::spread(Range rows, const Surfaces& surfaces, const std::array<const double*, 3>& forces,
                                VectorField<T, 3>& force) const {
  const Box<3>& block = domain_.block;
  SurfaceSpread<T> task{};
  task.stride_y = force[0].stride(1), task.stride_z = force[0].stride(2);
  const std::ptrdiff_t first = first_of_block(task.stride_y, task.stride_z);
  for (int k = 0; k < 3; ++k) {
    task.at.base[k] = base_[k].data(), task.at.p[k] = p_[k].data(), task.at.q[k] = q_[k].data();
    task.origin[k] = force[k].row(0, 0) - first;
    task.force[k] = forces[k];
  }
  task.domain = &domain_;
  task.row_begin = rows.begin, task.row_end = rows.end;
  // Planes of the lattice that these rows lie in.
  const int height = block.size(1), plane_begin = block.begin[2] + rows.begin / height,
            plane_end = block.begin[2] + (rows.end + height - 1) / height;
  for (const int c : surfaces.known_cells()) {
    if (!surfaces.reaches(c)) continue;
    const auto [lowest, highest] = planes_[c];
    const int first_plane = lowest + loops_->first, beyond = highest + loops_->first + loops_->points;
    const bool inside = first_plane >= 0 && beyond <= domain_.size[2];
    if (inside && (beyond <= plane_begin || first_plane >= plane_end)) continue;
    task.begin = surfaces.cells[c].first, task.end = surfaces.cells[c].end();
    loops_->spread(&task);
  }
}

template <class T>
void SurfaceCoupling<T>::interpolate(Worker worker, Surfaces& surfaces, const VectorField<T, 3>& velocity,
                                     Whose whose) const {
  SurfaceInterpolate<T> task{};
  task.stride_y = velocity[0].stride(1), task.stride_z = velocity[0].stride(2);
  const std::ptrdiff_t first = first_of_block(task.stride_y, task.stride_z);
  for (int k = 0; k < 3; ++k) {
    task.at.base[k] = base_[k].data(), task.at.p[k] = p_[k].data(), task.at.q[k] = q_[k].data();
    task.origin[k] = velocity[k].row(0, 0) - first;
  }
  task.velocity[0] = surfaces.velocity[0].data(), task.velocity[1] = surfaces.velocity[1].data();
  task.velocity[2] = surfaces.velocity[2].data();
  task.block = domain_.whole() ? nullptr : &domain_.block;
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int c : cells) {
    if (!surfaces.reaches(c) || !surfaces.is(c, whose)) continue;
    task.begin = surfaces.cells[c].first, task.end = surfaces.cells[c].end();
    loops_->interpolate(&task);
  }
}

template <class T>
WallForces<3> SurfaceCoupling<T>::wall_share(const Surfaces& surfaces, const std::array<const double*, 3>& force,
                                             const SolidNodes<3>* solid, const Ranks<3>& ranks) const {
  WallForceSums<3> sums;
  for (const int c : surfaces.own_cells()) {
    for (int i = surfaces.cells[c].first; i < surfaces.cells[c].end(); ++i) {
      if (base_[2][i] == outside) continue;
      std::array<StencilAlong, 3> stencil;
      for (int k = 0; k < 3; ++k) stencil[k] = loops_->along(base_[k][i], p_[k][i], q_[k][i]);
      add_wall_share<3>({force[0][i], force[1][i], force[2][i]}, stencil, domain_, solid, sums);
    }
  }
  return sums.total(ranks);
}

template <class T>
bool SurfaceCoupling<T>::any_escaped(const Surfaces& surfaces) const {
  for (const int c : surfaces.known_cells()) {
    if (planes_[c].lowest == outside) return true;
  }
  return false;
}

template <class T>
int SurfaceCoupling<T>::escaped(const Surfaces& surfaces) const {
  const PagedArray<int>& base = base_[2];
  for (const int c : surfaces.own_cells()) {
    const CellRange& cell = surfaces.cells[c];
    if (planes_[c].lowest == outside)
      return static_cast<int>(std::find(base.data() + cell.first, base.data() + cell.end(), outside) - base.data());
  }
  return -1;
}

template <class T>
void SurfaceCoupling<T>::forget(std::span<const Range> nodes) {
  for (int k = 0; k < 3; ++k) {
    release(base_[k], nodes);
    for (auto* values : {&p_[k], &q_[k]}) release(*values, nodes);
  }
}

template class SurfaceCoupling<float>;
template class SurfaceCoupling<double>;

}  // namespace rouleau::core
