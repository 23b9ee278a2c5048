// Boxes with packings in them, in two or three dimensions, and what is asked of the cells that come out.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "shape/packing.hpp"

namespace rouleau::test {

/// Packings of a scene, placed as read_scene places them; Packed is derived from it, and makes the domain and the
/// types.
template <class Packed>
struct PackedScene {
  scene::Scene scene;
  std::optional<shape::PackingShortfall> shortfall;

  scene::RandomPacking& add(int type, std::uint32_t seed, double gap) {
    scene::RandomPacking packing{};
    packing.type = type;
    packing.seed = seed;
    packing.gap = gap;
    packing.lower = scene::Vector::filled(scene.domain.dimension(), 0);
    packing.upper = scene.domain.size;
    scene.packings.push_back(packing);
    return scene.packings.back();
  }
  Packed& hematocrit(int type, double share, std::uint32_t seed, double gap) {
    scene::RandomPacking& packing = add(type, seed, gap);
    packing.hematocrit = share;
    packing.count = static_cast<int>(
        shape::cells_for(share, scene.cell_types[static_cast<std::size_t>(type)], packing, scene.domain));
    return self();
  }
  Packed& count(int type, int number, std::uint32_t seed, double gap) {
    add(type, seed, gap).count = number;
    return self();
  }
  Packed& run(const shape::PackingWatch& watch = {}) {
    for (scene::RandomPacking& packing : scene.packings) {
      packing.first = static_cast<int>(scene.cells.size());
      for (int i = 0; i < packing.count; ++i) scene.cells.push_back({packing.type, packing.lower, 0, "/cells"});
    }
    shortfall = shape::pack(scene.domain, scene.cell_types, scene.packings, scene.cells, watch);
    return self();
  }
  /// Runs and says how long that took.
  double seconds_of_run() {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  Packed& self() { return static_cast<Packed&>(*this); }
};

/// FNV-1a over the bits of numbers.
class HashOfBits {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash_ = (hash_ ^ bits) * 1099511628211U;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037U;
};

/// Sum of (found - expected)^2 / expected over equal bins of a number in [0, 1).
inline double chi_square(const std::vector<double>& values, int bins) {
  std::vector<double> found(static_cast<std::size_t>(bins), 0.0);
  for (const double v : values) found[static_cast<std::size_t>(v * bins)] += 1;
  double sum = 0;
  const double expected = static_cast<double>(values.size()) / bins;
  for (const double f : found) sum += (f - expected) * (f - expected) / expected;
  return sum;
}

/// Where a value lies in its period, in [0, 1).
inline double part(double value, double whole) { return value / whole - std::floor(value / whole); }

}  // namespace rouleau::test
