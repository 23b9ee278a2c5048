#include "outline_spread.hpp"

#include "core/fluid/walls.hpp"

namespace rouleau::core {

namespace {

// Each number of the lattice gets its terms in an order that does not depend on blocks, bands and workers: cell by
// cell, in a cell as spread() visits its nodes, of a node by rows. What lies beyond a border is added to the node that
// it is an image of, at once, never summed apart.
template <class T, class Kernel>
struct Spread {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SpreadTask<T, 2>* task) {
    SpreadTask<T, 2> t = *task;
    const Box<2>& block = t.domain->block;
    t.row_begin += block.begin[1], t.row_end += block.begin[1];  // from now on of the lattice
    const Inside inside{std::max(t.row_begin, 0), std::min(t.row_end, t.domain->size[1]), block.begin[0], block.end[0],
                        t.domain->size[1]};
    // Neighbouring nodes add to the same places, and a sum that is still on its way to memory stalls the next one:
    // nodes from four parts of the cell take turns.
    constexpr int parts = 4;
    const int length = (t.end - t.begin) / parts;
    for (int i = t.begin; i < t.begin + length; ++i)
      for (int part = 0; part < parts; ++part) spread(t, inside, i + part * length);
    for (int i = t.begin + parts * length; i < t.end; ++i) spread(t, inside, i);
  }

 private:
  static constexpr int points = Kernel::points, start = Kernel::first;
  using Forces = Line<T, points>;
  using Lanes = typename Forces::Lanes;
  /// What a stencil has to lie in to be added without a thought.
  struct Inside {
    int row_begin, row_end, column_begin, column_end, height;
  };
  ROULEAU_ALWAYS_INLINE static void spread(const SpreadTask<T, 2>& t, const Inside& inside, int i) {
    const int row = t.at.base[1][i] + start, column = t.at.base[0][i] + start;
    const bool whole = row >= 0 && row + points <= inside.height;
    if (whole && (row + points <= inside.row_begin || row >= inside.row_end)) return;
    if (column < inside.column_begin || column + points > inside.column_end || !whole) {
      const bool within = column >= 0 && column + points <= t.domain->size[0];
      if (within && (column + points <= inside.column_begin || column >= inside.column_end)) return;
      return spread_at_border(t, i);
    }
    const Forces wx = KernelWeights<Kernel, T>(t.at.p[0][i], t.at.q[0][i]).weight;
    const SpreadWeights<Kernel, T> wy(t.at.p[1][i], t.at.q[1][i]);
    const Forces fx = wx * Lanes(t.force[0][i]), fy = wx * Lanes(t.force[1][i]);
    const std::ptrdiff_t at = row * t.stride[1] + column;
    if (row >= inside.row_begin && row + points <= inside.row_end) {
      for (int k = 0; k < points; ++k) add(t, fx, fy, wy.weight[k], at + k * t.stride[1]);
    } else {
      for (int k = 0; k < points; ++k)
        if (row + k >= inside.row_begin && row + k < inside.row_end) add(t, fx, fy, wy.weight[k], at + k * t.stride[1]);
    }
  }
  ROULEAU_ALWAYS_INLINE static void add(const SpreadTask<T, 2>& t, const Forces& fx, const Forces& fy,
                                        const Lanes& weight, std::ptrdiff_t at) {
    (Forces::load(t.origin[0] + at) + fx * weight).store(t.origin[0] + at);
    (Forces::load(t.origin[1] + at) + fy * weight).store(t.origin[1] + at);
  }

  /// The same sums, number by number: of a stencil that reaches over the border of the lattice or of the block.
  [[gnu::noinline, gnu::cold]] static void spread_at_border(const SpreadTask<T, 2>& t, int i) {
    if (t.at.base[1][i] == outside) return;
    const Domain<2>& domain = *t.domain;
    const Forces wx = KernelWeights<Kernel, T>(t.at.p[0][i], t.at.q[0][i]).weight;
    const SpreadWeights<Kernel, T> wy(t.at.p[1][i], t.at.q[1][i]);
    const Forces fx = wx * Lanes(t.force[0][i]), fy = wx * Lanes(t.force[1][i]);
    for (int k = 0; k < points; ++k) {
      int row = domain.wrapped(1, t.at.base[1][i] + start + k);
      Lanes weight = wy.weight[k];
      if (row < 0) {  // beyond a wall
        row = mirrored(t.at.base[1][i] + start + k, domain.size[1]);
        weight = -weight;
      }
      if (row < t.row_begin || row >= t.row_end) continue;
      for (int l = 0; l < points; ++l) {
        const int column = domain.wrapped(0, t.at.base[0][i] + start + l);
        if (column < domain.block.begin[0] || column >= domain.block.end[0]) continue;
        const std::ptrdiff_t at = row * t.stride[1] + column;
        t.origin[0][at] = (Forces::all(t.origin[0][at]) + fx * weight).at(l);
        t.origin[1][at] = (Forces::all(t.origin[1][at]) + fy * weight).at(l);
      }
    }
  }
};

}  // namespace

template <class Kernel, class T>
void (*pick_outline_spread())(const SpreadTask<T, 2>*) {
  return Dispatch<Spread<T, Kernel>, const SpreadTask<T, 2>*>::pick();
}

#define ROULEAU_INSTANTIATE(Kernel)                                                   \
  template void (*pick_outline_spread<Kernel, float>())(const SpreadTask<float, 2>*); \
  template void (*pick_outline_spread<Kernel, double>())(const SpreadTask<double, 2>*);
ROULEAU_INSTANTIATE(Peskin4)
ROULEAU_INSTANTIATE(Cosine4)
ROULEAU_INSTANTIATE(Roma3)
ROULEAU_INSTANTIATE(Linear2)
ROULEAU_INSTANTIATE(Sharp6)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
