#include "area_fraction.hpp"

#include <algorithm>

#include "core/membrane/geometry.hpp"
#include "core/membrane/rounding.hpp"

namespace rouleau::core {

namespace {

constexpr int window_margin = 2;

/// Adds what one edge contributes to the columns right of it in one row. `a` and `b` are where it enters and leaves the
/// row, `rise` its signed height there. After a sum along the row, an element holds the area right of the edge.
void add_piece(double* row, int& begin, int& end, double a, double b, double rise) {
  const double left = std::min(a, b), right = std::max(a, b);
  const int first = core::floor_int(left), last = core::floor_int(right);
  begin = std::min(begin, first);
  end = std::max(end, last + 1);
  if (first == last) {
    const double inside = rise * (first + 1 - 0.5 * (left + right));
    row[first] += inside;
    row[first + 1] += rise - inside;
    return;
  }
  // The area right of the edge in column c is that of a trapezium; c ends at c + 1.
  const double slope = rise / (right - left);
  double before = 0;  // area in the columns up to c, minus what the running sum already gives them
  for (int c = first; c <= last; ++c) {
    const double from = std::max(left, static_cast<double>(c)), to = std::min(right, c + 1.0);
    const double height = slope * (to - from), passed = slope * (from - left);
    const double area = passed + height * (c + 1 - 0.5 * (from + to));
    row[c] += area - before;
    before = area;
  }
  row[last + 1] += rise - before;
}

}  // namespace

void cover(const Membranes& membranes, const CellRange& cell, AreaFraction& fraction) {
  const BoundingBox<2> box = box_of<2>(membranes, cell);
  fraction.width = fraction.height = 0;
  if (!box.usable()) return;
  // Node n's unit square is [n - 1/2, n + 1/2]: half a spacing later, it is the cell between two integers.
  fraction.x0 = core::floor_int(box.least[0] + 0.5) - window_margin;
  fraction.y0 = core::floor_int(box.least[1] + 0.5) - window_margin;
  const int width = core::floor_int(box.most[0] + 0.5) - fraction.x0 + 1 + window_margin;
  const int height = core::floor_int(box.most[1] + 0.5) - fraction.y0 + 1 + window_margin;
  if (static_cast<double>(width) * height > 1e8) return;  // blown up, see BoundingBox::usable
  fraction.width = width;
  fraction.height = height;
  fraction.value.assign(static_cast<std::size_t>(width) * height, 0.0);
  fraction.begin.assign(static_cast<std::size_t>(height), width);
  fraction.end.assign(static_cast<std::size_t>(height), 0);

  const double shift_x = 0.5 - fraction.x0, shift_y = 0.5 - fraction.y0;
  const double *xs = membranes.position[0].data(), *ys = membranes.position[1].data();
  for (int i = cell.first; i < cell.end(); ++i) {
    const int j = cell.next(i);
    double x0 = xs[i] + shift_x, y0 = ys[i] + shift_y, x1 = xs[j] + shift_x, y1 = ys[j] + shift_y;
    if (y0 == y1) continue;
    // The interior of a counter-clockwise outline lies right of edges that go down.
    double sign = -1;
    if (y0 > y1) {
      std::swap(x0, x1);
      std::swap(y0, y1);
      sign = 1;
    }
    const double slope = (x1 - x0) / (y1 - y0);
    const double left = std::min(x0, x1), right = std::max(x0, x1);
    double x = x0, y = y0;
    for (int r = core::floor_int(y0); y < y1; ++r) {
      const double next_y = std::min(r + 1.0, y1);
      // Rounding must not leave the box.
      const double next_x = next_y < y1 ? std::clamp(x0 + (next_y - y0) * slope, left, right) : x1;
      add_piece(fraction.row(r), fraction.begin[r], fraction.end[r], x, next_x, sign * (next_y - y));
      x = next_x;
      y = next_y;
    }
  }
  for (int r = 0; r < height; ++r) {
    const int begin = fraction.begin[r], end = fraction.end[r];
    if (begin >= end) {
      fraction.begin[r] = fraction.end[r] = 0;
      continue;
    }
    double* row = fraction.row(r);
    double sum = 0;
    for (int c = begin; c < end; ++c) row[c] = sum += row[c];
    row[end] = 0;  // left and right edges cancel there, up to rounding
  }
}

void smooth(AreaFraction& fraction, std::vector<double>& scratch) {
  const int width = fraction.width, height = fraction.height;
  if (width == 0) return;
  scratch.assign(fraction.value.size(), 0.0);
  for (int r = 0; r < height; ++r) {
    const double* from = fraction.row(r);
    double* to = scratch.data() + static_cast<std::size_t>(r) * width;
    for (int c = 1; c < width - 1; ++c) to[c] = 0.25 * (from[c - 1] + from[c + 1]) + 0.5 * from[c];
  }
  for (int r = 1; r < height - 1; ++r) {
    const double *below = scratch.data() + static_cast<std::size_t>(r - 1) * width, *here = below + width,
                 *above = here + width;
    double* to = fraction.row(r);
    for (int c = 0; c < width; ++c) to[c] = 0.25 * (below[c] + above[c]) + 0.5 * here[c];
  }
  // Rows and columns that are not zero grow by one on every side.
  const std::vector<int>& old_begin = fraction.begin;
  const std::vector<int>& old_end = fraction.end;
  int begin_before = 0, end_before = 0;  // of row r - 1, before it was changed
  for (int r = 0; r < height; ++r) {
    int begin = width, end = 0;
    const auto include = [&](int b, int e) {
      if (b >= e) return;
      begin = std::min(begin, b - 1);
      end = std::max(end, e + 1);
    };
    const auto at = static_cast<std::size_t>(r);
    include(begin_before, end_before);
    include(old_begin[at], old_end[at]);
    if (r + 1 < height) include(old_begin[at + 1], old_end[at + 1]);
    begin_before = old_begin[at];
    end_before = old_end[at];
    fraction.begin[at] = begin < end ? begin : 0;
    fraction.end[at] = begin < end ? end : 0;
  }
}

}  // namespace rouleau::core
