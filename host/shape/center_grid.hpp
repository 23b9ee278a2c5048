// Cells sorted by the squares in which their centres lie, while a packing moves them about.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "rigid_outline.hpp"

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

class CenterGrid {
 public:
  /// Squares at least as wide as `width`, or one across the whole box.
  CenterGrid(const Axis& x, const Axis& y, double width) : x_(x, width), y_(y, width) {
    cells_.resize(static_cast<std::size_t>(x_.count) * static_cast<std::size_t>(y_.count));
  }
  void add(std::size_t cell, Pair center) { cells_[square(center)].push_back(cell); }
  void remove(std::size_t cell, Pair center) {
    auto& list = cells_[square(center)];
    *std::find(list.begin(), list.end(), cell) = list.back();
    list.pop_back();
  }
  /// Whether `test(cell)` holds for all cells with a centre within the width of a square, each asked once.
  template <class Test>
  [[nodiscard]] bool all_near(Pair center, Test test) const {
    const int i = x_.index(center.x), j = y_.index(center.y);
    for (int dj = y_.first(); dj <= y_.last(); ++dj) {
      for (int di = x_.first(); di <= x_.last(); ++di) {
        const int column = x_.neighbour(i + di), row = y_.neighbour(j + dj);
        if (column < 0 || row < 0) continue;
        const auto& list = cells_[row * x_.count + column];
        if (!std::all_of(list.begin(), list.end(), test)) return false;
      }
    }
    return true;
  }

 private:
  struct Squares {
    Squares(const Axis& whole, double width)
        : axis(whole), count(std::clamp(static_cast<int>(whole.length() / width), 1, 2000)) {}
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
    int count;
  };
  [[nodiscard]] std::size_t square(Pair center) const {
    return static_cast<std::size_t>(y_.index(center.y) * x_.count + x_.index(center.x));
  }
  Squares x_, y_;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace rouleau::shape
