#include "outline_spread.hpp"
#include "stencils.hpp"

namespace rouleau::core {

namespace {

template <class T, class Kernel>
struct InterpolateOutline {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const InterpolateTask<T, 2>* task) {
    if (task->block == nullptr)
      run_all<false>(*task);
    else
      run_all<true>(*task);
  }

 private:
  using Four = Pack<T, 4>;
  using Velocities = Line<T, Kernel::points>;
  /// `in_block`: only nodes above the block.
  template <bool in_block>
  ROULEAU_ALWAYS_INLINE static void run_all(const InterpolateTask<T, 2>& task) {
    const InterpolateTask<T, 2> t = task;
    if (in_block && t.fetch_ahead)  // a call for each cell
      for (int first = t.begin; first < std::min(t.begin + lead, t.end); ++first) fetch<in_block>(t, first);
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
  ROULEAU_ALWAYS_INLINE static bool here(const InterpolateTask<T, 2>& t, int i) {
    return t.block->contains({std::max(t.at.base[0][i], 0), std::max(t.at.base[1][i], 0)});
  }
  ROULEAU_ALWAYS_INLINE static void interpolate_two(const InterpolateTask<T, 2>& t, int i) {
    Four u[2], v[2];
    for (int k = 0; k < 2; ++k) weigh(t, i + k, u[k], v[k]);
    const Four sums = sum(u[0], u[1], v[0], v[1]);
    for (int k = 0; k < 2; ++k) {
      t.velocity[0][i + k] = sums.vector[k];
      t.velocity[1][i + k] = sums.vector[2 + k];
    }
  }
  ROULEAU_ALWAYS_INLINE static void interpolate(const InterpolateTask<T, 2>& t, int i) {
    Four u, v;
    weigh(t, i, u, v);
    const Four sums = sum(u, u, v, v);
    t.velocity[0][i] = sums.vector[0];
    t.velocity[1][i] = sums.vector[2];
  }
  static constexpr int lead = 16;  // nodes from the fetched one to the present one
  template <bool in_block>
  ROULEAU_ALWAYS_INLINE static void fetch(const InterpolateTask<T, 2>& t, int i) {
    if (t.at.base[1][i] == outside || (in_block && !here(t, i))) return;
    const std::ptrdiff_t at = (t.at.base[1][i] + Kernel::first) * t.stride[1] + t.at.base[0][i];
    for (int k = 0; k < Kernel::points; ++k) {
      __builtin_prefetch(t.origin[0] + at + k * t.stride[1]);
      __builtin_prefetch(t.origin[1] + at + k * t.stride[1]);
    }
  }
  /// Columns of the stencil, weighted along y and x: their sums are the node's velocity.
  ROULEAU_ALWAYS_INLINE static void weigh(const InterpolateTask<T, 2>& t, int i, Four& u, Four& v) {
    u = v = T(0);
    if (t.at.base[1][i] == outside) return;
    const Velocities wx = KernelWeights<Kernel, T>(t.at.p[0][i], t.at.q[0][i]).weight;
    const SpreadWeights<Kernel, T> wy(t.at.p[1][i], t.at.q[1][i]);
    const std::ptrdiff_t at = (t.at.base[1][i] + Kernel::first) * t.stride[1] + t.at.base[0][i] + Kernel::first;
    Velocities along_x{}, along_y{};
    for (int k = 0; k < Kernel::points; ++k) {
      along_x = along_x + Velocities::load(t.origin[0] + at + k * t.stride[1]) * wy.weight[k];
      along_y = along_y + Velocities::load(t.origin[1] + at + k * t.stride[1]) * wy.weight[k];
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

template <class T>
const StencilLoops<T, 2>* loops_of(KernelKind kernel) {
  return with_kernel(kernel, []<class Kernel>(Kernel) {
    static const StencilLoops<T, 2> loops{Kernel::first,
                                          Kernel::points,
                                          Dispatch<Locate<T, 2, Kernel>, LocateTask<T, 2>*>::pick(),
                                          pick_outline_spread<Kernel, T>(),
                                          Dispatch<InterpolateOutline<T, Kernel>, const InterpolateTask<T, 2>*>::pick(),
                                          &StencilAlong::of<Kernel, T>};
    return &loops;
  });
}

}  // namespace

template <>
const StencilLoops<float, 2>* StencilLoops<float, 2>::of(KernelKind kernel) {
  return loops_of<float>(kernel);
}
template <>
const StencilLoops<double, 2>* StencilLoops<double, 2>::of(KernelKind kernel) {
  return loops_of<double>(kernel);
}

}  // namespace rouleau::core
