// Cells sorted by the squares, or cubes, in which their centres lie, while a packing moves them about.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "rigid_body.hpp"

namespace rouleau::shape {

/// Extent of a box along one axis.
struct Axis {
  double lower = 0, upper = 1;
  bool periodic = false;
  [[nodiscard]] double length() const { return upper - lower; }
  /// The same place in [lower, upper) where the axis is periodic.
  [[nodiscard]] double wrapped(double value) const {
    if (!periodic) return value;
    const double inside = value - std::floor((value - lower) / length()) * length();
    return inside < upper ? std::max(inside, lower) : lower;
  }
};

template <int D>
class CenterGrid {
 public:
  /// Squares or cubes at least as wide as `width`, or one across the whole box.
  CenterGrid(const std::array<Axis, D>& box, double width) {
    std::size_t total = 1;
    for (int k = 0; k < D; ++k) {
      squares_[k] = Squares(box[k], width);
      total *= static_cast<std::size_t>(squares_[k].count);
    }
    cells_.resize(total);
  }
  void add(std::size_t cell, const Place<D>& center) { cells_[square(center)].push_back(cell); }
  void remove(std::size_t cell, const Place<D>& center) {
    auto& list = cells_[square(center)];
    *std::find(list.begin(), list.end(), cell) = list.back();
    list.pop_back();
  }
  /// Whether `test(cell)` holds for all cells with a centre within the width of a square, each asked once.
  template <class Test>
  [[nodiscard]] bool all_near(const Place<D>& center, const Test& test) const {
    return all_near<D - 1>(center, 0, test);
  }

 private:
  struct Squares {
    static constexpr int most = std::array{2000, 100}[D - 2];
    Squares() = default;
    Squares(const Axis& whole, double width)
        : axis(whole), count(std::clamp(static_cast<int>(whole.length() / width), 1, most)) {}
    [[nodiscard]] int index(double value) const {
      const double place = (axis.wrapped(value) - axis.lower) / axis.length() * count;
      return static_cast<int>(std::clamp(place, 0.0, count - 0.5));
    }
    // Of one or two squares around a period none is to be asked twice.
    [[nodiscard]] int first() const { return axis.periodic && count == 1 ? 0 : -1; }
    [[nodiscard]] int last() const { return axis.periodic && count <= 2 ? 0 : 1; }
    /// -1: there is none.
    [[nodiscard]] int neighbour(int i) const {
      if (axis.periodic) return (i + count) % count;
      return i < count ? i : -1;
    }
    Axis axis;
    int count = 1;
  };
  [[nodiscard]] std::size_t square(const Place<D>& center) const {
    std::size_t found = 0;
    for (int k = D - 1; k >= 0; --k) found = found * squares_[k].count + squares_[k].index(center[k]);
    return found;
  }
  template <int K, class Test>
  [[nodiscard]] bool all_near(const Place<D>& center, std::size_t above, const Test& test) const {
    const Squares& along = squares_[K];
    const int middle = along.index(center[K]);
    for (int way = along.first(); way <= along.last(); ++way) {
      const int i = along.neighbour(middle + way);
      if (i < 0) continue;
      const std::size_t found = above * along.count + i;
      if constexpr (K > 0) {
        if (!all_near<K - 1>(center, found, test)) return false;
      } else if (!std::all_of(cells_[found].begin(), cells_[found].end(), test)) {
        return false;
      }
    }
    return true;
  }

  std::array<Squares, D> squares_;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace rouleau::shape
