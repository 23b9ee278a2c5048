#include "viscosity_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/fluid/developed_flow.hpp"
#include "core/membrane/rounding.hpp"

namespace rouleau::core {

namespace {

/// Adds an interval {begin, end} to others that do not touch each other; those that it touches become one with it.
template <class Interval>
void add_disjoint(std::vector<Interval>& row, Interval added) {
  for (std::size_t k = 0; k < row.size();) {
    if (row[k].end < added.begin || added.end < row[k].begin) {
      ++k;
      continue;
    }
    added = {std::min(added.begin, row[k].begin), std::max(added.end, row[k].end)};
    row[k] = row.back();
    row.pop_back();
  }
  row.push_back(added);
}

/// Nodes may move this far before the next update; the marks allow for a whole spacing.
constexpr double displacement_limit = 0.1;

template <class Interval>
void include(Interval& to, int begin, int end) {
  to = {std::min(to.begin, begin), std::max(to.end, end)};
}

}  // namespace

template <class T, int D>
ViscosityField<T, D>::ViscosityField(const Cells<D>& cells, std::vector<double> viscosity_ratio, ViscosityMean mean,
                                     double reach_beyond, double relaxation_rate, const Domain<D>& domain,
                                     std::vector<double> viscosity_of_rows, bool smoothed)
    : ratio_(std::move(viscosity_ratio)),
      mean_(mean),
      smoothed_(smoothed),
      margin_(static_cast<int>(std::ceil(reach_beyond))),
      plain_rate_(relaxation_rate),
      viscosity_of_rows_(std::move(viscosity_of_rows)),
      domain_(domain),
      watch_(cells),
      reach_(cells.cells.size()),
      changed_(static_cast<std::size_t>(row_count(domain.block))) {
  for (const CellRange& cell : cells.cells) varies_ |= differs(cell.type);
}

template <class T, int D>
template <class Function>
void ViscosityField<T, D>::for_rows(const Rows& rows, Range own, Function function) const {
  const Box<D>& block = domain_.block;
  const int count = static_cast<int>(rows.columns.size());
  for (int place = 0; place < count;) {
    // A line of rows along y, whose place along z is one.
    const int length = rows.size[0];
    int before = 0;  // rows of the block below the line
    if constexpr (D == 3) {
      const int z = domain_.wrapped(2, rows.first[1] + place / length) - block.begin[2];
      if (z < 0 || z >= block.size(2)) {
        place += length;
        continue;
      }
      before = block.size(1) * z;
    }
    for (int j = 0; j < length; ++j, ++place) {
      const int y = domain_.wrapped(1, rows.first[0] + j) - block.begin[1], row = before + y;
      if (y >= 0 && y < block.size(1) && row >= own.begin && row < own.end) function(row, rows.columns[place], place);
    }
  }
}

template <class T, int D>
template <class Function>
void ViscosityField<T, D>::for_pieces(Interval columns, Function function) const {
  for (int begin = columns.begin; begin < columns.end;) {
    const int x = domain_.wrapped(0, begin);
    const int end = std::min(columns.end, begin + domain_.size[0] - x);
    const int first = std::max(x, domain_.block.begin[0]), last = std::min(x + end - begin, domain_.block.end[0]);
    if (first < last) function(first - domain_.block.begin[0], begin + first - x, begin + last - x);
    begin = end;
  }
}

template <class T, int D>
void ViscosityField<T, D>::cover(Worker worker, const Cells<D>& cells) {
  std::vector<double> scratch;
  for (const int c : cells.known_cells(worker)) {
    if (!watch_.moved(c)) continue;
    Reach& reach = reach_[c];
    std::swap(reach.covered, reach.covered_before);
    reach.covered.columns.clear();
    if (differs(cells.cells[c].type)) {
      core::cover(cells, c, reach.fraction);
      if (smoothed_) smooth(reach.fraction, scratch);
      find_covered(reach.fraction, reach.covered);
    }
    find_reached(cells, c, reach);
    watch_.remember(c, cells, displacement_limit);
  }
}

template <class T, int D>
void ViscosityField<T, D>::find_covered(const CellFraction<D>& fraction, Rows& covered) const {
  for (int k = 1; k < D; ++k) covered.first[k - 1] = fraction.first[k], covered.size[k - 1] = fraction.size[k];
  for (int r = 0; r < fraction.row_count(); ++r)
    covered.columns.push_back({fraction.first[0] + fraction.begin[r], fraction.first[0] + fraction.end[r]});
}

// A node at (X, Y) reaches columns floor(X) - 1 ... floor(X) + 2 and the same rows, along z, too; one more each for its
// motion, and the margin.
template <class T, int D>
void ViscosityField<T, D>::find_reached(const Cells<D>& cells, int cell, Reach& reach) const {
  Rows& reached = reach.reached;
  reached.columns.clear();
  const BoundingBox<D> box = box_of<D>(cells, cell);
  if (!box.usable()) return;
  std::size_t count = 1;
  for (int k = 1; k < D; ++k) {
    reached.first[k - 1] = floor_int(box.least[k]) - 2 - margin_;
    reached.size[k - 1] = floor_int(box.most[k]) + 4 + margin_ - reached.first[k - 1];
    count *= static_cast<std::size_t>(reached.size[k - 1]);
  }
  const Interval none{1 << 30, -(1 << 30)};
  reached.columns.assign(count, none);
  const CellRange& range = cells.cells[cell];
  for (int i = range.first; i < range.end(); ++i) {
    const int x = floor_int(cells.position[0][i]);
    int place = 0;
    for (int k = D - 1; k > 0; --k)
      place = place * reached.size[k - 1] + floor_int(cells.position[k][i]) - reached.first[k - 1];
    include(reached.columns[place], x - 2 - margin_, x + 4 + margin_);
  }
  // From the row below a node to the rows that its stencil reaches, along one axis and then the other.
  int stride = 1;
  for (int k = 0; k < D - 1; ++k) {
    const std::vector<Interval> before = reached.columns;
    const int size = reached.size[k];
    for (int r = 0; r < static_cast<int>(count); ++r) {
      const int at = r / stride % size;
      for (int from = std::max(0, at - 3 - margin_); from <= std::min(size - 1, at + 2 + margin_); ++from) {
        const Interval& columns = before[r + (from - at) * stride];
        include(reached.columns[r], columns.begin, columns.end);
      }
    }
    stride *= size;
  }
  const Rows& covered = reach.covered;
  for (int r = 0; r < static_cast<int>(covered.columns.size()); ++r) {
    const Interval& added = covered.columns[r];
    if (added.begin >= added.end) continue;
    int place = covered.first[0] - reached.first[0] + r % covered.size[0];
    if constexpr (D == 3) place += (covered.first[1] - reached.first[1] + r / covered.size[0]) * reached.size[0];
    include(reached.columns[place], added.begin, added.end);
  }
}

template <class T, int D>
void ViscosityField<T, D>::update(Worker worker, const Cells<D>& cells, Field<T, D>& relaxation_rate, NodeMask& mask) {
  const Range own = worker.share(row_count(domain_.block));
  if (varies_) {
    collect_changes(cells, own);
    set_rates(cells, own, relaxation_rate);
  }
  mask.renew(own.begin, own.end, [&](auto mark) {
    for (const int c : cells.known_cells())
      if (cells.reaches(c))
        for_rows(reach_[c].reached, own,
                 [&](int row, Interval columns, int) { mark(row, columns.begin, columns.end); });
  });
}

template <class T, int D>
void ViscosityField<T, D>::restore(DisplacementWatch::Memory memory, Cells<D>& cells, Field<T, D>& relaxation_rate,
                                   NodeMask& mask) {
  watch_.recall(std::move(memory), cells, [&] {
    cover(Worker{}, cells);
    update(Worker{}, cells, relaxation_rate, mask);
  });
}

template <class T, int D>
void ViscosityField<T, D>::collect_changes(const Cells<D>& cells, Range own) {
  for (int row = own.begin; row < own.end; ++row) changed_[row].clear();
  const auto include_columns = [&](int row, Interval columns, int) {
    columns.end = std::min(columns.end, columns.begin + domain_.size[0]);
    for_pieces(columns, [&](int x, int begin, int end) {
      // Intervals of a row stay disjoint, since what is done to them is not to be done twice.
      add_disjoint(changed_[row], {x, x + end - begin});
    });
  };
  for (const int c : cells.known_cells()) {
    if (!watch_.moved(c)) continue;
    for_rows(reach_[c].covered_before, own, include_columns);
    for_rows(reach_[c].covered, own, include_columns);
  }
}

template <class T, int D>
void ViscosityField<T, D>::set_rates(const Cells<D>& cells, Range own, Field<T, D>& rate) {
  const bool harmonic = mean_ == ViscosityMean::harmonic;
  const auto averaged = [=](double viscosity) { return harmonic ? 1 / viscosity : viscosity; };
  const auto row_at = [&](int row) { return rate.row(row_of(domain_.block, row)); };
  // The field holds the sum over cells of (mu_inside - mu_row) I, or that of 1/mu, until every cell has been added.
  for (int row = own.begin; row < own.end; ++row)
    for (const Interval& interval : changed_[row])
      std::fill(row_at(row) + interval.begin, row_at(row) + interval.end, T(0));
  for (const int c : cells.known_cells()) {
    const int type = cells.cells[c].type;
    if (!differs(type) || !cells.reaches(c)) continue;
    const double inside = averaged(ratio_[type]);
    const CellFraction<D>& fraction = reach_[c].fraction;
    for_rows(reach_[c].covered, own, [&](int row, Interval columns, int place) {
      if (changed_[row].empty()) return;
      const double excess = inside - averaged(viscosity_of_row(row));
      const double* from = fraction.row(place);
      T* to = row_at(row);
      for_pieces(columns, [&](int x, int begin, int end) {
        for (const Interval& interval : changed_[row]) {
          const int first = std::max(x, interval.begin), last = std::min(x + end - begin, interval.end);
          const double* value = from + (begin - fraction.first[0]) - x;
          for (int k = first; k < last; ++k) to[k] += static_cast<T>(excess * value[k]);
        }
      });
    });
  }
  const T suspending = static_cast<T>(1 / plain_rate_ - 0.5);
  for (int row = own.begin; row < own.end; ++row) {
    if (changed_[row].empty()) continue;
    const double viscosity = viscosity_of_row(row);
    const T plain = static_cast<T>(rate_of_layer(plain_rate_, viscosity)), of_row = static_cast<T>(averaged(viscosity));
    T* to = row_at(row);
    for (const Interval& interval : changed_[row]) {
      for (int x = interval.begin; x < interval.end; ++x)
        if (to[x] == T(0))
          to[x] = plain;
        else
          to[x] = T(1) / (T(0.5) + (harmonic ? suspending / (of_row + to[x]) : suspending * (of_row + to[x])));
    }
  }
}

template class ViscosityField<float, 2>;
template class ViscosityField<double, 2>;
template class ViscosityField<float, 3>;
template class ViscosityField<double, 3>;

}  // namespace rouleau::core
