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
#include "core/domain/row_pieces.hpp"
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

  /// The domain's block, fluid at rest. Its first axis is periodic, cut, or open. `pieces`: where populations are kept;
  /// of a piece of a row at a time.
  explicit Lattice(const Domain<dimension>& domain, RowPieces<dimension> pieces = {});

  [[nodiscard]] int size(int axis) const { return domain_.block.size(axis); }
  [[nodiscard]] const Domain<dimension>& domain() const { return domain_; }
  /// Number of rows; row i of them, whose second coordinate counts first.
  [[nodiscard]] int rows() const { return row_count(domain_.block); }
  [[nodiscard]] Row row(int i) const { return row_of(domain_.block, i); }
  /// Whether the block is its own neighbour across both ends of an axis.
  [[nodiscard]] bool wraps(int axis) const { return wraps_[axis]; }
  [[nodiscard]] std::size_t bytes() const { return storage_.bytes() + pieces_.bytes(); }
  [[nodiscard]] const RowPieces<dimension>& pieces() const { return pieces_; }
  /// Calls function(piece, number) for the pieces of row i; numbers are those of pieces().
  template <class Function>
  void for_pieces(int i, Function function) const {
    if (pieces_.all()) return function(RowPiece{i, 0, size_[0]}, std::size_t{0});
    for (std::size_t n = pieces_.first_piece(i); n < pieces_.first_piece(i + 1); ++n) function(pieces_.piece(n), n);
  }
  /// Whether a node, in or around the block, has populations.
  [[nodiscard]] bool holds(int x, const Row& row) const { return pieces_.all() || pieces_.holds(x, row); }

  /// A row of slot q, from x = 0 on, where it has the node at x; all coordinates in [-1, size].
  [[nodiscard]] T* slot(int q, const Row& row, int x = 0) { return origin_[q] + start(x, row); }
  [[nodiscard]] const T* slot(int q, const Row& row, int x = 0) const { return origin_[q] + start(x, row); }
  /// What offset() counts from.
  [[nodiscard]] T* origin(int q) { return origin_[q]; }
  /// To node x of a row, in the same slot, halo included.
  [[nodiscard]] std::ptrdiff_t offset(int x, const Row& row) const { return start(x, row) + x; }

  /// Pointers to the populations of a row before and after a collision at this parity, from x = 0 on, for the piece
  /// that has the node at x. Rows beside a wall get half-way bounce-back: what would leave the fluid stays in its node
  /// and comes back reversed in the next step.
  /// For observers the halo must be complete (Fluid::settle).
  void row_pointers(Parity parity, const Row& row, int x, In& in, Out& out) const;
  /// The same given those of another row: quicker, row after row where all nodes are there.
  void next_row_pointers(Parity parity, const Row& from, const Row& row, In& in, Out& out);
  /// Whether it is worth asking for rows ahead of time: in three dimensions, where rows are too short for the processor
  /// to find out by itself what comes next, if the lattice leaves the cache between two steps.
  [[nodiscard]] bool fetches_ahead() const { return dimension == 3 && bytes() >= (std::size_t{8} << 20); }
  /// Asks for the populations of row `next`, given the pointers of another one.
  void fetch_row(const In& in, const Row& from, const Row& next) const;

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
  [[nodiscard]] std::ptrdiff_t start(int x, const Row& row) const {
    if (!pieces_.all()) return pieces_.start(x, row);
    std::ptrdiff_t sum = 0;
    for (int k = 1; k < dimension; ++k) sum += stride_[k] * row[k - 1];
    return sum;
  }
  /// Rows around a row, itself in the middle, by -1, 0 or 1 along y, then along z; the row that velocity q goes to.
  static constexpr int rows_around = dimension == 2 ? 3 : 9, middle = rows_around / 2;
  static constexpr int goes_to(int q) {
    int place = 0;
    for (int k = dimension - 1; k > 0; --k) place = 3 * place + 1 + Set::velocity[q][k];
    return place;
  }
  /// Calls function(q, in, out) with the pointers of every population.
  template <class Function>
  void for_slots(Parity parity, const Row& row, int x, Function function) const;

  Domain<dimension> domain_;
  std::array<int, dimension> size_;
  std::array<std::ptrdiff_t, dimension> stride_;
  std::array<bool, dimension> wall_below_, wall_above_, wraps_;
  RowPieces<dimension> pieces_;
  Storage<T> storage_;
  T* origin_[velocity_count];
};

template <class T, class Set>
template <class Function>
inline void Lattice<T, Set>::for_slots(Parity parity, const Row& row, int x, Function function) const {
  const bool streamed = parity == Parity::odd;
  std::ptrdiff_t start_of[rows_around];
  for (int place = 0; place < rows_around; ++place) {
    if (!streamed && place != middle) continue;
    Row beside = row;
    for (int k = 1, rest = place; k < dimension; ++k, rest /= 3) beside[k - 1] += rest % 3 - 1;
    start_of[place] = start(x, beside);
  }
  bool below[dimension], above[dimension];  // whether there is anything to stream with, along each axis
  below[0] = above[0] = streamed;
  for (int k = 1; k < dimension; ++k) {
    below[k] = streamed && !outside(k, row[k - 1] - 1);
    above[k] = streamed && !outside(k, row[k - 1] + 1);
  }
  Set::for_each_velocity([&](auto q) {
    constexpr auto& c = Set::velocity[q];
    constexpr int back = Set::opposite[q];
    bool comes = streamed, goes = streamed;
    for (int k = 1; k < dimension; ++k) {
      if (c[k] != 0) comes = comes && (c[k] > 0 ? below[k] : above[k]), goes = goes && (c[k] > 0 ? above[k] : below[k]);
    }
    T* const own = origin_[q] + start_of[middle];
    T* const other = origin_[back] + start_of[middle];
    function(q, comes ? origin_[back] + start_of[goes_to(back)] - c[0] : own,
             goes ? origin_[q] + start_of[goes_to(q)] + c[0] : other);
  });
}

template <class T, class Set>
inline void Lattice<T, Set>::row_pointers(Parity parity, const Row& row, int x, In& in, Out& out) const {
  for_slots(parity, row, x, [&](int q, const T* from, T* to) {
    in[q] = from;
    out[q] = to;
  });
}

template <class T, class Set>
inline void Lattice<T, Set>::next_row_pointers(Parity parity, const Row& from, const Row& row, In& in, Out& out) {
  if (beside_wall(from) || beside_wall(row)) {
    row_pointers(parity, row, 0, in, out);
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
