#include "cell_fraction.hpp"

#include "core/membrane/rounding.hpp"

namespace rouleau::core {

template <int D>
bool clear_around(const BoundingBox<D>& box, CellFraction<D>& fraction) {
  constexpr int border = 2;  // nodes on every side
  constexpr double most = 1e8;
  double count = box.usable() ? 1 : 0;
  for (int k = 0; k < D && count > 0; ++k) {
    // What belongs to node n is [n - 1/2, n + 1/2].
    fraction.first[k] = floor_int(box.least[k] + 0.5) - border;
    fraction.size[k] = floor_int(box.most[k] + 0.5) + border + 1 - fraction.first[k];
    count *= fraction.size[k];
  }
  const bool covers = count > 0 && count <= most;
  if (!covers) fraction.size.fill(0), count = 0;
  const std::size_t rows = covers ? static_cast<std::size_t>(count) / static_cast<std::size_t>(fraction.size[0]) : 0;
  fraction.value.assign(static_cast<std::size_t>(count), 0.0);
  fraction.begin.assign(rows, fraction.size[0]);
  fraction.end.assign(rows, 0);
  return covers;
}

template <int D>
void smooth(CellFraction<D>& fraction, std::vector<double>& scratch) {
  const std::size_t count = fraction.value.size();
  scratch.assign(count, 0.0);
  std::size_t stride = 1;
  for (int k = 0; k < D; ++k) {
    // The ends of rows are zero, so that neighbouring ones do not mix.
    const double* from = fraction.value.data();
    double* to = scratch.data();
    for (std::size_t i = stride; i + stride < count; ++i)
      to[i] = 0.25 * (from[i - stride] + from[i + stride]) + 0.5 * from[i];
    fraction.value.swap(scratch);
    stride *= static_cast<std::size_t>(fraction.size[k]);
  }
  for (int r = 0; r < fraction.row_count(); ++r) {
    const double* row = fraction.row(r);
    int begin = 0, end = fraction.size[0];
    while (begin < end && row[begin] == 0) ++begin;
    while (end > begin && row[end - 1] == 0) --end;
    fraction.begin[r] = begin, fraction.end[r] = end;
  }
}

template bool clear_around(const BoundingBox<2>&, CellFraction<2>&);
template bool clear_around(const BoundingBox<3>&, CellFraction<3>&);
template void smooth(CellFraction<2>&, std::vector<double>&);
template void smooth(CellFraction<3>&, std::vector<double>&);

}  // namespace rouleau::core
