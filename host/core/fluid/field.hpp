// A scalar on the lattice with a halo, in aligned rows.
#pragma once

#include <algorithm>
#include <cstddef>

#include "storage.hpp"

namespace rouleau::core {

/// nx x ny values and a halo of `halo` nodes on every side. Rows start on 64-byte boundaries at x = 0.
template <class T>
class Field {
 public:
  static constexpr int halo = 2;  ///< what the 4-point kernel needs

  Field() = default;
  /// All values zero.
  Field(int nx, int ny) : nx_(nx), ny_(ny), stride_((nx + 2 * halo + line - 1) / line * line) {
    storage_ = Storage<T>(static_cast<std::size_t>(stride_) * (ny + 2 * halo) + line);
    origin_ = storage_.data() + static_cast<std::size_t>(stride_) * halo + line;
  }

  [[nodiscard]] int nx() const { return nx_; }
  [[nodiscard]] int ny() const { return ny_; }
  [[nodiscard]] bool allocated() const { return storage_.bytes() != 0; }
  [[nodiscard]] std::size_t bytes() const { return storage_.bytes(); }

  /// Sets all values, halo included.
  void fill(T value) {
    for (int y = -halo; y < ny_ + halo; ++y) std::fill(row(y) - halo, row(y) + nx_ + halo, value);
  }

  /// Row y in [-halo, ny + halo); x in [-halo, nx + halo) may be read and written.
  [[nodiscard]] T* row(int y) { return origin_ + static_cast<std::ptrdiff_t>(stride_) * y; }
  [[nodiscard]] const T* row(int y) const { return origin_ + static_cast<std::ptrdiff_t>(stride_) * y; }

 private:
  static constexpr int line = 64 / sizeof(T);
  int nx_ = 0, ny_ = 0, stride_ = 0;
  Storage<T> storage_;
  T* origin_ = nullptr;
};

/// Force density, and after the fluid step the velocity, which is written over it.
template <class T>
struct VectorField {
  Field<T> x, y;
};

}  // namespace rouleau::core
