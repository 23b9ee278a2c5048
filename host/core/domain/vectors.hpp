// Vectors in space, side by side in packs: what loops over nodes and triangles are written in.
#pragma once

#include <cstring>
#include <rouleau/pack.hpp>
#include <utility>

namespace rouleau::core {

/// from[index[0]], from[index[1]] ... side by side.
template <class S>
ROULEAU_ALWAYS_INLINE S gathered(const double* from, const int* index) {
  return [=]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
    return S(typename S::Vector{from[index[k]]...});
  }
  (std::make_integer_sequence<int, S::size>());
}

/// Writes the numbers of a pack, converted.
template <class S, class To>
ROULEAU_ALWAYS_INLINE void store_as(const S& values, To* to) {
  using Converted __attribute__((vector_size(S::size * sizeof(To)))) = To;
  const Converted converted = __builtin_convertvector(values.vector, Converted);
  std::memcpy(to, &converted, sizeof converted);
}

/// A vector of numbers, or of packs of them.
template <class S>
struct Vectors {
  S x, y, z;
  ROULEAU_ALWAYS_INLINE static Vectors load(const auto& from, int at) {
    return {S::load(from[0] + at), S::load(from[1] + at), S::load(from[2] + at)};
  }
  ROULEAU_ALWAYS_INLINE static Vectors gather(const auto& from, const int* index) {
    return {gathered<S>(from[0], index), gathered<S>(from[1], index), gathered<S>(from[2], index)};
  }
  ROULEAU_ALWAYS_INLINE void store(auto& to, int at) const {
    x.store(to[0] + at), y.store(to[1] + at), z.store(to[2] + at);
  }
  ROULEAU_ALWAYS_INLINE friend Vectors operator+(const Vectors& a, const Vectors& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  ROULEAU_ALWAYS_INLINE friend Vectors operator-(const Vectors& a, const Vectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  ROULEAU_ALWAYS_INLINE friend Vectors operator*(const S& a, const Vectors& b) { return {a * b.x, a * b.y, a * b.z}; }
  ROULEAU_ALWAYS_INLINE friend S dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  ROULEAU_ALWAYS_INLINE friend Vectors cross(const Vectors& a, const Vectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

}  // namespace rouleau::core
