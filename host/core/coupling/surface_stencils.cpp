#include "core/fluid/walls.hpp"
#include "stencils.hpp"

namespace rouleau::core {

namespace {

/// Weights of a node's stencil: along x, and one for each of its rows. `before`: Line.
template <class T, class Kernel>
struct StencilWeights {
  using Lanes = typename Line<T, Kernel::points>::Lanes;
  Line<T, Kernel::points> along_x;
  SpreadWeights<Kernel, T> y, z;
  ROULEAU_ALWAYS_INLINE StencilWeights(const Stencils<const int, const T, 3>& at, int i, int before)
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
  ROULEAU_ALWAYS_INLINE static void run(const SpreadTask<T, 3>* task) {
    const SpreadTask<T, 3> t = *task;
    for (int i = t.begin; i < t.end; ++i) spread(t, i);
  }

 private:
  static constexpr int points = Kernel::points, start = Kernel::first;
  using Forces = Line<T, points>;
  ROULEAU_ALWAYS_INLINE static void spread(const SpreadTask<T, 3>& t, int i) {
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
    const std::ptrdiff_t corner = z * t.stride[2] + y * t.stride[1] + x;
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
  /// Adds to the nodes from `at` on: to all of them, or to those in rows that are to be added to; `first` is that of
  /// `at`.
  template <bool whole>
  ROULEAU_ALWAYS_INLINE static void add(const SpreadTask<T, 3>& t, const StencilWeights<T, Kernel>& weights,
                                        const std::array<Forces, 3>& force, std::ptrdiff_t at, int first) {
    const int height = t.domain->block.size(1);
    for (int m = 0; m < points; ++m) {
      T *to_x = t.origin[0] + at + m * t.stride[2], *to_y = t.origin[1] + at + m * t.stride[2],
        *to_z = t.origin[2] + at + m * t.stride[2];
#pragma GCC unroll 6
      for (int l = 0; l < points; ++l) {
        const int row = first + l + height * m;
        if (whole || (row >= t.row_begin && row < t.row_end)) {
          const auto weight = weights.of_row(m, l);
          (Forces::load(to_x) + force[0] * weight).store(to_x);
          (Forces::load(to_y) + force[1] * weight).store(to_y);
          (Forces::load(to_z) + force[2] * weight).store(to_z);
        }
        to_x += t.stride[1], to_y += t.stride[1], to_z += t.stride[1];
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
  /// The same sums: of a stencil that reaches over the border of the lattice or of the block. Where it does so along x,
  /// its points are among the first and the last nodes of a row.
  ROULEAU_ALWAYS_INLINE static void spread_at_border(const SpreadTask<T, 3>& t, int i) {
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
          T* const row_of_force = t.origin[c] + z.node * t.stride[2] + y.node * t.stride[1];
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

template <class T, class Kernel>
struct InterpolateSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const InterpolateTask<T, 3>* task) {
    const InterpolateTask<T, 3> t = *task;
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
          (t.at.base[2][i] + start) * t.stride[2] + (t.at.base[1][i] + start) * t.stride[1] + t.at.base[0][i] + start;
      const int before = Velocities::lanes_before(t.origin[0] + at);
      at -= before;
      const StencilWeights<T, Kernel> weights(t.at, i, before);
      // Even and odd rows apart: each sum waits for its last term.
      Velocities u[2]{}, v[2]{}, w[2]{};
      for (int m = 0; m < points; ++m, at += t.stride[2]) {
        const T *from_u = t.origin[0] + at, *from_v = t.origin[1] + at, *from_w = t.origin[2] + at;
#pragma GCC unroll 6
        for (int l = 0; l < points; ++l) {
          const auto weight = weights.of_row(m, l);
          u[l % 2] = u[l % 2] + Velocities::load(from_u) * weight;
          v[l % 2] = v[l % 2] + Velocities::load(from_v) * weight;
          w[l % 2] = w[l % 2] + Velocities::load(from_w) * weight;
          from_u += t.stride[1], from_v += t.stride[1], from_w += t.stride[1];
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

template <class T>
const StencilLoops<T, 3>* loops_of(KernelKind kernel) {
  return with_kernel(kernel, []<class Kernel>(Kernel) {
    static const StencilLoops<T, 3> loops{Kernel::first,
                                          Kernel::points,
                                          Dispatch<Locate<T, 3, Kernel>, LocateTask<T, 3>*>::pick(),
                                          Dispatch<SpreadSurface<T, Kernel>, const SpreadTask<T, 3>*>::pick(),
                                          Dispatch<InterpolateSurface<T, Kernel>, const InterpolateTask<T, 3>*>::pick(),
                                          &StencilAlong::of<Kernel, T>};
    return &loops;
  });
}

}  // namespace

template <>
const StencilLoops<float, 3>* StencilLoops<float, 3>::of(KernelKind kernel) {
  return loops_of<float>(kernel);
}
template <>
const StencilLoops<double, 3>* StencilLoops<double, 3>::of(KernelKind kernel) {
  return loops_of<double>(kernel);
}

}  // namespace rouleau::core
