// A scalar on the lattice with a halo, in aligned rows.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

#include "storage.hpp"

namespace rouleau::core {

/// A value for each node of a block, and a halo of `halo` nodes on every side. Rows lie along x and start on 64-byte
/// boundaries at x = 0, an odd number of these apart: the rows above and behind each other that a stencil reads would
/// share few places of a cache else. Of fields that are read and written side by side each takes another `place`, from
/// 0 to 2: a processor lets a read wait for writes a multiple of 4096 bytes away, where large arrays all begin.
template <class T, int D>
class Field {
 public:
  static constexpr int halo = 3;  ///< what a kernel of six points needs

  Field() = default;
  /// All values zero. `in_parts`: most of them will stay so, and take little memory.
  explicit Field(const std::array<int, D>& size, int place = 0, bool in_parts = false) : size_(size) {
    stride_[0] = 1;
    stride_[1] = (((size[0] + 2 * halo + line - 1) / line) | 1) * line;
    for (int k = 2; k < D; ++k) stride_[k] = stride_[k - 1] * (size[k - 1] + 2 * halo);
    const std::ptrdiff_t count = stride_[D - 1] * (size[D - 1] + 2 * halo);
    const int before = (1 + 21 * place) * line;  // thirds of 4096 bytes
    storage_ = Storage<T>(static_cast<std::size_t>(count) + before, in_parts);
    origin_ = storage_.data() + before;
    for (int k = 1; k < D; ++k) origin_ += halo * stride_[k];
  }

  [[nodiscard]] int size(int axis) const { return size_[axis]; }
  /// From a node to the next one along an axis, in values.
  [[nodiscard]] std::ptrdiff_t stride(int axis) const { return stride_[axis]; }
  [[nodiscard]] bool allocated() const { return storage_.bytes() != 0; }
  [[nodiscard]] std::size_t bytes() const { return storage_.bytes(); }

  /// Sets all values, halo included.
  void fill(T value) {
    T* const begin = storage_.data();
    std::fill(begin, begin + storage_.bytes() / sizeof(T), value);
  }

  /// The row through these coordinates along the other axes, each in [-halo, size + halo); x in [-halo, size(0) + halo)
  /// may be read and written.
  template <std::integral... Coordinates>
  [[nodiscard]] T* row(Coordinates... along) {
    return row(std::array<int, D - 1>{static_cast<int>(along)...});
  }
  template <std::integral... Coordinates>
  [[nodiscard]] const T* row(Coordinates... along) const {
    return row(std::array<int, D - 1>{static_cast<int>(along)...});
  }
  [[nodiscard]] T* row(const std::array<int, D - 1>& along) { return origin_ + offset(along); }
  [[nodiscard]] const T* row(const std::array<int, D - 1>& along) const { return origin_ + offset(along); }

 private:
  static constexpr int line = 64 / sizeof(T);
  [[nodiscard]] std::ptrdiff_t offset(const std::array<int, D - 1>& along) const {
    std::ptrdiff_t sum = 0;
    for (int k = 1; k < D; ++k) sum += stride_[k] * along[k - 1];
    return sum;
  }

  std::array<int, D> size_{};
  std::array<std::ptrdiff_t, D> stride_{};
  Storage<T> storage_;
  T* origin_ = nullptr;
};

/// Force density, and after the fluid step the velocity, which is written over it: one field for each component.
template <class T, int D>
using VectorField = std::array<Field<T, D>, D>;

}  // namespace rouleau::core
