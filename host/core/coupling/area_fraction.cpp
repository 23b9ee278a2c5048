#include <algorithm>

#include "cell_fraction.hpp"
#include "core/membrane/rounding.hpp"

namespace rouleau::core {

namespace {

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

void cover(const Membranes& membranes, int cell_number, CellFraction<2>& fraction) {
  if (!clear_around(box_of<2>(membranes, cell_number), fraction)) return;
  const CellRange& cell = membranes.cells[cell_number];
  // Half a spacing later, a node's unit square is the one between two integers.
  const double shift_x = 0.5 - fraction.first[0], shift_y = 0.5 - fraction.first[1];
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
  for (int r = 0; r < fraction.row_count(); ++r) {
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

}  // namespace rouleau::core
