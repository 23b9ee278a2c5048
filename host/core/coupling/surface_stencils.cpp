#include "base/worker.hpp"
#include "core/fluid/walls.hpp"
#include "stencils.hpp"

namespace rouleau::core {

namespace {

/// Weights of a node's stencil: along x, and one for each of its rows. `before`: Line.
template <class T, class Kernel, int register_bytes>
struct StencilWeights {
  using Lanes = typename Line<T, Kernel::points, register_bytes>::Lanes;
  Line<T, Kernel::points, register_bytes> along_x;
  SpreadWeights<Kernel, T, register_bytes> y, z;
  ROULEAU_ALWAYS_INLINE StencilWeights(const Stencils<const int, const T, 3>& at, int i, int before)
      : along_x(KernelWeights<Kernel, T, register_bytes>(at.p[0][i], at.q[0][i], before).weight),
        y(at.p[1][i], at.q[1][i]),
        z(at.p[2][i], at.q[2][i]) {}
  [[nodiscard]] ROULEAU_ALWAYS_INLINE Lanes of_row(int along_z, int along_y) const {
    return z.weight[along_z] * y.weight[along_y];
  }
};

template <class T, class Kernel, int register_bytes>
class SpreadNode {
  static constexpr int points = Kernel::points, start = Kernel::first;
  using Forces = Line<T, points, register_bytes>;
  using Lanes = typename Forces::Lanes;
  using Weights = StencilWeights<T, Kernel, register_bytes>;

 public:
  /// `planes`: where the rows lie along z.
  ROULEAU_ALWAYS_INLINE static void spread(const SpreadTask<T, 3>& t, Range planes, int i) {
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
      return spread_at_border(t, planes, i);
    }
    const int first = y - block.begin[1] + height * (z - block.begin[2]), last = first + (points - 1) * (1 + height);
    if (last < t.row_begin || first >= t.row_end) return;
    const std::ptrdiff_t corner = z * t.stride[2] + y * t.stride[1] + x;
    const int before = Forces::lanes_before(t.origin[0] + corner);
    const Weights weights(t.at, i, before);
    const std::array<Forces, 3> force = forces(t, i, weights.along_x);
    for (int m = 0; m < points; ++m) {
      const std::ptrdiff_t at = corner - before + m * t.stride[2];
      const int row = first + height * m;
      if (row >= t.row_begin && row + points <= t.row_end)
        add<true>(t, weights, m, force, at, row);
      else if (row + points > t.row_begin && row < t.row_end)
        add<false>(t, weights, m, force, at, row);
    }
  }

 private:
  ROULEAU_ALWAYS_INLINE static std::array<Forces, 3> forces(const SpreadTask<T, 3>& t, int i, const Forces& along_x) {
    return {along_x * Lanes(t.force[0][i]), along_x * Lanes(t.force[1][i]), along_x * Lanes(t.force[2][i])};
  }
  ROULEAU_ALWAYS_INLINE static void add(const SpreadTask<T, 3>& t, const Lanes& weight,
                                        const std::array<Forces, 3>& force, std::ptrdiff_t at) {
    for (int c = 0; c < 3; ++c) {
      T* const to = t.origin[c] + at;
      (Forces::load(to) + force[c] * weight).store(to);
    }
  }
  /// Adds to plane m of a stencil, from `at` on, which lies in this row: to all of its rows, or to those that are to be
  /// added to.
  template <bool whole>
  ROULEAU_ALWAYS_INLINE static void add(const SpreadTask<T, 3>& t, const Weights& weights, int m,
                                        const std::array<Forces, 3>& force, std::ptrdiff_t at, int row) {
#pragma GCC unroll 6
    for (int l = 0; l < points; ++l, at += t.stride[1])
      if (whole || (row + l >= t.row_begin && row + l < t.row_end)) add(t, weights.of_row(m, l), force, at);
  }

  /// What a stencil's points along an axis are images of.
  struct Images {
    int node[points];
    T sign[points];  ///< -1 beyond a wall, where a force acts on the mirrored node with reversed sign
    ROULEAU_ALWAYS_INLINE Images(const Domain<3>& domain, int axis, int first) {
      for (int k = 0; k < points; ++k) {
        const int wrapped = domain.wrapped(axis, first + k);
        node[k] = wrapped >= 0 ? wrapped : mirrored(first + k, domain.size[axis]);
        sign[k] = wrapped >= 0 ? T(1) : T(-1);
      }
    }
  };
  /// The same sums: of a stencil that reaches over the border of the lattice or of the block. Where it does so along x,
  /// its points are among the first and the last nodes of a row.
  ROULEAU_ALWAYS_INLINE static void spread_at_border(const SpreadTask<T, 3>& t, Range planes, int i) {
    if (t.at.base[2][i] == outside) return;
    const Domain<3>& domain = *t.domain;
    const Images along_z(domain, 2, t.at.base[2][i] + start);
    bool any = false;
    for (const int z : along_z.node) any = any || (z >= planes.begin && z < planes.end);
    if (!any) return;
    const Images along_x(domain, 0, t.at.base[0][i] + start), along_y(domain, 1, t.at.base[1][i] + start);
    Weights weights(t.at, i, 0);
    for (int k = 0; k < points; ++k) {
      weights.y.weight[k] = weights.y.weight[k] * Lanes(along_y.sign[k]);
      weights.z.weight[k] = weights.z.weight[k] * Lanes(along_z.sign[k]);
    }
    const Box<3>& block = domain.block;
    const int x = t.at.base[0][i] + start;
    if (x >= block.begin[0] && x + points <= block.end[0])
      return add_images(t, planes, weights, along_y, along_z, forces(t, i, weights.along_x), x);
    // What a node of a row gets of the force along x, from the first node of either part on.
    constexpr int width = Forces::size;
    const int first[2] = {block.begin[0], std::max(block.begin[0], block.end[0] - width)};
    T along[2][width] = {};
    bool reached[2] = {};
    for (int k = 0; k < points; ++k) {
      const int node = along_x.node[k];
      if (node < block.begin[0] || node >= block.end[0]) continue;
      const int part = node < first[0] + width ? 0 : 1;
      along[part][node - first[part]] += along_x.sign[k] * weights.along_x.at(k);
      reached[part] = true;
    }
    for (int part = 0; part < 2; ++part)
      if (reached[part])
        add_images(t, planes, weights, along_y, along_z, forces(t, i, Forces::load(along[part])), first[part]);
  }
  ROULEAU_ALWAYS_INLINE static void add_images(const SpreadTask<T, 3>& t, Range planes, const Weights& weights,
                                               const Images& along_y, const Images& along_z,
                                               const std::array<Forces, 3>& force, int x) {
    const Box<3>& block = t.domain->block;
    for (int m = 0; m < points; ++m) {
      const int z = along_z.node[m];
      if (z < planes.begin || z >= planes.end) continue;
      const int first = block.size(1) * (z - block.begin[2]) - block.begin[1];
      const std::ptrdiff_t at = z * t.stride[2] + x;
      for (int l = 0; l < points; ++l) {
        const int y = along_y.node[l];
        if (y < block.begin[1] || y >= block.end[1] || first + y < t.row_begin || first + y >= t.row_end) continue;
        add(t, weights.of_row(m, l), force, at + y * t.stride[1]);
      }
    }
  }
};

template <class T, class Kernel>
struct SpreadSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SpreadTask<T, 3>* task) {
    const SpreadTask<T, 3> t = *task;
    const Box<3>& block = t.domain->block;
    const int layer = block.size(1);
    const Range planes{block.begin[2] + t.row_begin / layer, block.begin[2] + (t.row_end + layer - 1) / layer};
    for (int i = t.begin; i < t.end; ++i) SpreadNode<T, Kernel, register_bytes>::spread(t, planes, i);
  }
};

template <class T, class Kernel>
struct InterpolateSurface {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const InterpolateTask<T, 3>* task) {
    const InterpolateTask<T, 3> t = *task;
    constexpr int points = Kernel::points, start = Kernel::first;
    using Velocities = Line<T, points, register_bytes>;
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
      const StencilWeights<T, Kernel, register_bytes> weights(t.at, i, before);
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
      t.velocity[0][i] = sum(((u[0] + u[1]) * weights.along_x).folded(before));
      t.velocity[1][i] = sum(((v[0] + v[1]) * weights.along_x).folded(before));
      t.velocity[2][i] = sum(((w[0] + w[1]) * weights.along_x).folded(before));
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
