// Populations of a D2Q9 block, streamed in place (AA pattern: Bailey et al., ICPP 2009).
//
// Even steps read f_q(x) from slot q and write f'_q(x) to the opposite slot of the same node; odd steps read what
// streams in from the neighbours' opposite slots and write to the neighbours' slots. One array serves both, and a
// collision operator sees nine input and nine output pointers either way. Populations are deviations from rest, f_q -
// w_q.
#pragma once

#include <algorithm>
#include <cstddef>
#include <rouleau/d2q9.hpp>

#include "core/domain/domain.hpp"
#include "storage.hpp"

namespace rouleau::core {

namespace d2q9 = rouleau::d2q9;

/// Which half of the in-place pair comes next.
enum class Parity { even, odd };
constexpr Parity next(Parity parity) { return parity == Parity::even ? Parity::odd : Parity::even; }

template <class T>
class Lattice {
 public:
  /// The domain's block, fluid at rest.
  explicit Lattice(const Domain<2>& domain);

  [[nodiscard]] int nx() const { return nx_; }
  [[nodiscard]] int ny() const { return ny_; }
  [[nodiscard]] const Domain<2>& domain() const { return domain_; }
  /// Whether the block is its own neighbour across both ends of an axis.
  [[nodiscard]] bool wraps(int axis) const { return wraps_[axis]; }
  [[nodiscard]] std::size_t bytes() const { return storage_.bytes(); }

  /// Row y of slot q; x in [-1, nx], y in [-1, ny].
  [[nodiscard]] T* slot(int q, int y) { return origin_[q] + static_cast<std::ptrdiff_t>(stride_) * y; }
  [[nodiscard]] const T* slot(int q, int y) const { return origin_[q] + static_cast<std::ptrdiff_t>(stride_) * y; }

  /// From slot(q, 0) to the same slot of node (x, y) of the block, halo included.
  [[nodiscard]] std::ptrdiff_t offset(int x, int y) const { return static_cast<std::ptrdiff_t>(stride_) * y + x; }

  /// Pointers to the populations of row y before and after a collision at this parity, from x = 0 on. Rows beside a
  /// wall get half-way bounce-back: what would leave the fluid stays in its node and comes back reversed in the next
  /// step.
  void row_pointers(Parity parity, int y, const T* (&in)[9], T* (&out)[9]);
  /// The same given those of the row before, `from`, one above or below: quicker, row after row.
  void next_row_pointers(Parity parity, int from, int y, const T* (&in)[9], T* (&out)[9]);
  /// The populations alone, for observers; the halo must be complete (Fluid::settle).
  void row_pointers(Parity parity, int y, const T* (&in)[9]) const;

 private:
  [[nodiscard]] bool outside(int y) const { return (y < 0 && wall_below_) || (y >= ny_ && wall_above_); }
  /// Calls function(q, in, out) with the pointers of every population.
  template <class Function>
  void for_slots(Parity parity, int y, Function function) const;

  Domain<2> domain_;
  int nx_, ny_, stride_;
  bool wall_below_, wall_above_, wraps_[2];
  Storage<T> storage_;
  T* origin_[9];
};

template <class T>
template <class Function>
inline void Lattice<T>::for_slots(Parity parity, int y, Function function) const {
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(stride_) * y, stride = stride_;
  const bool streamed = parity == Parity::odd, below = streamed && !outside(y - 1), above = streamed && !outside(y + 1);
  d2q9::for_each_velocity([&](auto q) {
    constexpr int opposite = d2q9::opposite[q], cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
    const bool comes = cy == 0 ? streamed : (cy > 0 ? below : above);
    const bool goes = cy == 0 ? streamed : (cy > 0 ? above : below);
    T* const own = origin_[q] + row;
    T* const other = origin_[opposite] + row;
    function(q, comes ? other - (cy * stride + cx) : own, goes ? own + (cy * stride + cx) : other);
  });
}

template <class T>
inline void Lattice<T>::row_pointers(Parity parity, int y, const T* (&in)[9]) const {
  for_slots(parity, y, [&](int q, const T* from, const T*) { in[q] = from; });
}

template <class T>
inline void Lattice<T>::row_pointers(Parity parity, int y, const T* (&in)[9], T* (&out)[9]) {
  for_slots(parity, y, [&](int q, const T* from, T* to) {
    in[q] = from;
    out[q] = to;
  });
}

template <class T>
inline void Lattice<T>::next_row_pointers(Parity parity, int from, int y, const T* (&in)[9], T* (&out)[9]) {
  if (outside(std::min(from, y) - 1) || outside(std::max(from, y) + 1)) {  // one of the two rows lies beside a wall
    row_pointers(parity, y, in, out);
    return;
  }
  const std::ptrdiff_t way = y > from ? stride_ : -stride_;
  d2q9::for_each_velocity([&](auto q) { in[q] += way, out[q] += way; });
}

extern template class Lattice<float>;
extern template class Lattice<double>;

}  // namespace rouleau::core
