// The loops over the stencils of nodes, for one kernel: where they lie, what is spread over them and read from them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <rouleau/dispatch.hpp>
#include <rouleau/pack.hpp>

#include "core/domain/domain.hpp"
#include "core/domain/vectors.hpp"
#include "kernel.hpp"
#include "wall_share.hpp"

namespace rouleau::core {

/// Largest integer not above x, for |x| < 2^51. `S`: a Pack of double.
template <class S>
ROULEAU_ALWAYS_INLINE S floor(const S& x) {
  const S shift = 6755399441055744.0, rounded = (x + shift) - shift;
  return select(rounded > x, rounded - 1.0, rounded);
}

/// The node in [0, size) that a whole number is an image of along a periodic axis.
template <class S>
ROULEAU_ALWAYS_INLINE S wrapped(const S& node, double size) {
  const S inside = node - size * floor(node * (1.0 / size));
  const S raised = select(inside < S(0.0), inside + size, inside);  // the quotient may be rounded across an integer
  return select(raised >= S(size), raised - size, raised);
}

constexpr int outside = -1000000;  // along the last axis of a node whose stencil is not on the lattice

/// Base nodes and what is kept of the weights (kernel.hpp), of all nodes: written by Locate, read by the others.
template <class Integer, class Number, int D>
struct Stencils {
  Integer* base[D];
  Number *p[D], *q[D];
};

template <class T, int D>
struct LocateTask {
  Stencils<int, T, D> to;
  const double* place[D];
  double size[D];  // of the lattice
  bool periodic[D];
  int begin, end;  // nodes
  double lowest,
      highest;  // set to the least and the largest base along the last axis; `outside` for a stencil off the lattice
};

template <class T, int D>
struct SpreadTask {
  Stencils<const int, const T, D> at;
  const double* force[D];
  int begin, end;  // nodes of one cell
  const Domain<D>* domain;
  int row_begin, row_end;    // of the block
  T* origin[D];              // where node 0 of the lattice lies, or would lie if it belonged to the block
  std::ptrdiff_t stride[D];  // from a node to the next along an axis, the same in all components
};

template <class T, int D>
struct InterpolateTask {
  Stencils<const int, const T, D> at;
  double* velocity[D];
  int begin, end;
  const T* origin[D];
  std::ptrdiff_t stride[D];
  bool fetch_ahead;     // most of the fields has left the cache since the fluid's step
  const Box<D>* block;  // nodes above others are left alone; null: there are no others
};

/// The loops for one kernel.
template <class T, int D>
struct StencilLoops {
  int first, points;  // of the kernel
  void (*locate)(LocateTask<T, D>*);
  void (*spread)(const SpreadTask<T, D>*);
  void (*interpolate)(const InterpolateTask<T, D>*);
  StencilAlong (*along)(int base, T p, T q);

  static const StencilLoops* of(KernelKind kernel);
};

/// Base nodes and what is kept of the weights, which is computed in double precision before it is rounded to T.
template <class T, int D, class Kernel>
struct Locate {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(LocateTask<T, D>* task) {
    const LocateTask<T, D> t = *task;
    using Packed = Pack<double, register_bytes / 8>;
    Packed low = t.size[D - 1], high = outside;
    int i = t.begin;
    for (; i + Packed::size <= t.end; i += Packed::size) {
      const Packed last = base<Packed>(t, i, Packed::size);
      low = min(low, last), high = max(high, last);
    }
    if (D == 2 && i < t.end) {  // wide packs have another square root: checkpoints of outlines go on with theirs
      const Packed last = base<Packed>(t, i, t.end - i);
      low = min(low, last), high = max(high, last);
      i = t.end;
    }
    Pack<double, 1> lowest = least(low), highest = largest(high);
    for (; i < t.end; ++i) {
      const Pack<double, 1> last = base<Pack<double, 1>>(t, i, 1);
      lowest = min(lowest, last), highest = max(highest, last);
    }
    task->lowest = lowest.vector[0], task->highest = highest.vector[0];
  }

 private:
  /// Of the first `valid` nodes of a pack; returns the base along the last axis. Half a spacing beyond a wall is not
  /// outside.
  template <class S>
  ROULEAU_ALWAYS_INLINE static S base(const LocateTask<T, D>& t, int i, int valid) {
    const S none = outside;
    S base[D], lowest = 0.0;
    for (int k = 0; k < D; ++k) {
      const S shifted = get<S>(t.place[k] + i, valid) + Kernel::shift, below = floor(shifted);
      S p, q;
      Kernel::keep(shifted - below, p, q);
      put(p, t.to.p[k] + i, valid), put(q, t.to.q[k] + i, valid);
      // One comparison a line: g++ 12 takes combined masks apart element by element.
      if (t.periodic[k]) {
        base[k] = wrapped(below, t.size[k]);
      } else {
        base[k] = select(below >= S(-1.0), below, none);
        base[k] = select(below < S(t.size[k]), base[k], none);
      }
      base[k] = select(abs(shifted) < S(1e9), base[k], none);  // false for NaN, too
      put(base[k], t.to.base[k] + i, valid);
      lowest = min(lowest, base[k]);
    }
    base[D - 1] = select(lowest > S(outside + 1.0), base[D - 1], none);
    put(base[D - 1], t.to.base[D - 1] + i, valid);
    return base[D - 1];
  }
  /// The last of the values stands for those that are missing.
  template <class S>
  ROULEAU_ALWAYS_INLINE static S get(const double* values, int valid) {
    if (valid == S::size) return S::load(values);
    double all[S::size];
    for (int k = 0; k < S::size; ++k) all[k] = values[std::min(k, valid - 1)];
    return S::load(all);
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

}  // namespace rouleau::core
