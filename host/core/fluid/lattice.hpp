// Populations of a block, streamed in place (AA pattern: Bailey et al., ICPP 2009).
//
// Even steps read f_q(x) from slot q and write f'_q(x) to the opposite slot of the same node; odd steps read what
// streams in from the neighbours' opposite slots and write to the neighbours' slots. One array serves both, and a
// collision operator sees an input and an output pointer for each velocity either way. Populations are deviations from
// rest, f_q - w_q.
#pragma once

#include <array>
#include <cstddef>
#include <rouleau/d2q9.hpp>
#include <rouleau/d3q19.hpp>

#include "core/domain/domain.hpp"
#include "storage.hpp"

namespace rouleau::core {

// The velocity sets are the SDK's, where models find them, too.
using rouleau::D2Q9;
using rouleau::D3Q19;

/// Which half of the in-place pair comes next.
enum class Parity { even, odd };
constexpr Parity next(Parity parity) { return parity == Parity::even ? Parity::odd : Parity::even; }

/// `Set`: the velocities (D2Q9, D3Q19). Rows lie along x; a row is named by its coordinates along the other axes.
template <class T, class Set>
class Lattice {
 public:
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  using Row = std::array<int, dimension - 1>;
  using In = const T* [velocity_count];
  using Out = T* [velocity_count];

  /// The domain's block, fluid at rest. Its first axis is periodic, cut, or open.
  explicit Lattice(const Domain<dimension>& domain);

  [[nodiscard]] int size(int axis) const { return domain_.block.size(axis); }
  [[nodiscard]] const Domain<dimension>& domain() const { return domain_; }
  /// Number of rows; row i of them, whose second coordinate counts first.
  [[nodiscard]] int rows() const { return row_count(domain_.block); }
  [[nodiscard]] Row row(int i) const { return row_of(domain_.block, i); }
  /// Whether the block is its own neighbour across both ends of an axis.
  [[nodiscard]] bool wraps(int axis) const { return wraps_[axis]; }
  [[nodiscard]] std::size_t bytes() const { return storage_.bytes(); }

  /// A row of slot q; all coordinates in [-1, size].
  [[nodiscard]] T* slot(int q, const Row& row) { return origin_[q] + offset(0, row); }
  [[nodiscard]] const T* slot(int q, const Row& row) const { return origin_[q] + offset(0, row); }

  /// From the first node of the block to node x of a row, in the same slot, halo included.
  [[nodiscard]] std::ptrdiff_t offset(int x, const Row& row) const {
    std::ptrdiff_t sum = x;
    for (int k = 1; k < dimension; ++k) sum += stride_[k] * row[k - 1];
    return sum;
  }

  /// Pointers to the populations of a row before and after a collision at this parity, from x = 0 on. Rows beside a
  /// wall get half-way bounce-back: what would leave the fluid stays in its node and comes back reversed in the next
  /// step.
  void row_pointers(Parity parity, const Row& row, In& in, Out& out);
  /// The same given those of another row: quicker, row after row.
  void next_row_pointers(Parity parity, const Row& from, const Row& row, In& in, Out& out);
  /// Whether it is worth asking for rows ahead of time: in three dimensions, where rows are too short for the processor
  /// to find out by itself what comes next, if the lattice leaves the cache between two steps.
  [[nodiscard]] bool fetches_ahead() const { return dimension == 3 && bytes() >= (std::size_t{8} << 20); }
  /// Asks for the populations of row `next`, given the pointers of another one.
  void fetch_row(const In& in, const Row& from, const Row& next) const;
  /// The populations alone, for observers; the halo must be complete (Fluid::settle).
  void row_pointers(Parity parity, const Row& row, In& in) const;

 private:
  /// Whether what lies at `coordinate` along an axis is beyond a wall.
  [[nodiscard]] bool outside(int axis, int coordinate) const {
    return (coordinate < 0 && wall_below_[axis]) || (coordinate >= size_[axis] && wall_above_[axis]);
  }
  [[nodiscard]] bool beside_wall(const Row& row) const {
    for (int k = 1; k < dimension; ++k) {
      if (outside(k, row[k - 1] - 1) || outside(k, row[k - 1] + 1)) return true;
    }
    return false;
  }
  /// Calls function(q, in, out) with the pointers of every population.
  template <class Function>
  void for_slots(Parity parity, const Row& row, Function function) const;

  Domain<dimension> domain_;
  std::array<int, dimension> size_;
  std::array<std::ptrdiff_t, dimension> stride_;
  std::array<bool, dimension> wall_below_, wall_above_, wraps_;
  Storage<T> storage_;
  T* origin_[velocity_count];
};

template <class T, class Set>
template <class Function>
inline void Lattice<T, Set>::for_slots(Parity parity, const Row& row, Function function) const {
  const std::ptrdiff_t here = offset(0, row);
  const bool streamed = parity == Parity::odd;
  bool below[dimension], above[dimension];  // whether there is anything to stream with, along each axis
  below[0] = above[0] = streamed;
  for (int k = 1; k < dimension; ++k) {
    below[k] = streamed && !outside(k, row[k - 1] - 1);
    above[k] = streamed && !outside(k, row[k - 1] + 1);
  }
  Set::for_each_velocity([&](auto q) {
    constexpr auto& c = Set::velocity[q];
    bool comes = streamed, goes = streamed;
    std::ptrdiff_t way = c[0];
    for (int k = 1; k < dimension; ++k) {
      if (c[k] != 0) comes = comes && (c[k] > 0 ? below[k] : above[k]), goes = goes && (c[k] > 0 ? above[k] : below[k]);
      way += c[k] * stride_[k];
    }
    T* const own = origin_[q] + here;
    T* const other = origin_[Set::opposite[q]] + here;
    function(q, comes ? other - way : own, goes ? own + way : other);
  });
}

template <class T, class Set>
inline void Lattice<T, Set>::row_pointers(Parity parity, const Row& row, In& in) const {
  for_slots(parity, row, [&](int q, const T* from, const T*) { in[q] = from; });
}

template <class T, class Set>
inline void Lattice<T, Set>::row_pointers(Parity parity, const Row& row, In& in, Out& out) {
  for_slots(parity, row, [&](int q, const T* from, T* to) {
    in[q] = from;
    out[q] = to;
  });
}

template <class T, class Set>
inline void Lattice<T, Set>::next_row_pointers(Parity parity, const Row& from, const Row& row, In& in, Out& out) {
  if (beside_wall(from) || beside_wall(row)) {
    row_pointers(parity, row, in, out);
    return;
  }
  const std::ptrdiff_t way = offset(0, row) - offset(0, from);
  Set::for_each_velocity([&](auto q) { in[q] += way, out[q] += way; });
}

template <class T, class Set>
inline void Lattice<T, Set>::fetch_row(const In& in, const Row& from, const Row& next) const {
  const std::ptrdiff_t way = offset(0, next) - offset(0, from);
  // Slot after slot: memory gives neighbouring lines faster than lines of all slots in turn.
  for (int q = 0; q < velocity_count; ++q) fetch(in[q] + way, size_[0]);
}

extern template class Lattice<float, D2Q9>;
extern template class Lattice<double, D2Q9>;
extern template class Lattice<float, D3Q19>;
extern template class Lattice<double, D3Q19>;

}  // namespace rouleau::core
