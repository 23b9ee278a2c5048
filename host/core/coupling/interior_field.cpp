#include "interior_field.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/layers.hpp"
#include "core/membrane/rounding.hpp"
#include "disjoint.hpp"

namespace rouleau::core {

template <class T>
InteriorField<T>::InteriorField(const Surfaces& surfaces, std::vector<double> viscosity_ratio, double relaxation_rate,
                                const Domain<3>& domain, std::vector<double> viscosity_of_rows, ViscosityMean mean,
                                double reach_beyond, bool smoothed)
    : ratio_(std::move(viscosity_ratio)),
      mean_(mean),
      smoothed_(smoothed),
      margin_(static_cast<int>(std::ceil(reach_beyond))),
      plain_rate_(relaxation_rate),
      viscosity_of_rows_(std::move(viscosity_of_rows)),
      domain_(domain),
      watch_(surfaces),
      fraction_(surfaces.cells.size()),
      reach_(surfaces.cells.size()),
      changed_(static_cast<std::size_t>(row_count(domain.block))) {
  for (const CellRange& cell : surfaces.cells) varies_ |= differs(cell.type);
}

template <class T>
void InteriorField<T>::cover(Worker worker, const Surfaces& surfaces) {
  const CellNumbers cells = surfaces.known_cells(worker);
  std::vector<double> scratch;
  for (const int c : cells) {
    if (!watch_.moved(c)) continue;
    if (differs(surfaces.cells[c].type)) {
      core::cover(surfaces.type_of(c).mesh, surfaces.nodes(c), fraction_[c]);
      if (smoothed_) smooth(fraction_[c], scratch);
    }
    find_reach(surfaces, c);
    watch_.remember(c, surfaces, displacement_limit);
  }
}

// A node at (X, Y, Z) reaches columns floor(X) - 1 ... floor(X) + 2 of the same rows along y and z; one more each for its
// motion.
template <class T>
void InteriorField<T>::find_reach(const Surfaces& surfaces, int cell) {
  Rows& reach = reach_[cell];
  reach.columns.clear();
  reach.size[0] = reach.size[1] = 0;
  const CellRange& range = surfaces.cells[cell];
  const double* const along[2] = {surfaces.position[1].data(), surfaces.position[2].data()};
  const VolumeFraction& fraction = fraction_[cell];
  for (int axis = 0; axis < 2; ++axis) {
    const auto [least, most] = std::minmax_element(along[axis] + range.first, along[axis] + range.end());
    if (!(std::abs(*least) < 1e9 && std::abs(*most) < 1e9)) return;  // the run is about to end
    reach.first[axis] = floor_int(*least) - 2 - margin_;
    reach.size[axis] = floor_int(*most) + 4 + margin_ - reach.first[axis];
  }
  const Interval none{1 << 30, -(1 << 30)};
  reach.columns.assign(static_cast<std::size_t>(reach.size[0]) * reach.size[1], none);
  const auto include = [](Interval& to, const Interval& added) {
    to = {std::min(to.begin, added.begin), std::max(to.end, added.end)};
  };
  for (int i = range.first; i < range.end(); ++i) {
    if (!(std::abs(surfaces.position[0][i]) < 1e9)) continue;
    const int x = floor_int(surfaces.position[0][i]);
    include(reach.at(floor_int(surfaces.position[1][i]) - reach.first[0],
                     floor_int(surfaces.position[2][i]) - reach.first[1]),
            {x - 2 - margin_, x + 4 + margin_});
  }
  // From the row below a node to the rows that its stencil reaches, along one axis and then the other.
  for (int axis = 0; axis < 2; ++axis) {
    const std::vector<Interval> before = reach.columns;
    for (int k = 0; k < reach.size[1]; ++k) {
      for (int j = 0; j < reach.size[0]; ++j) {
        const int at = axis == 0 ? j : k;
        for (int from = std::max(0, at - 3 - margin_); from <= std::min(reach.size[axis] - 1, at + 2 + margin_); ++from)
          include(reach.at(j, k),
                  before[static_cast<std::size_t>(reach.size[0] * (axis == 0 ? k : from) + (axis == 0 ? from : j))]);
      }
    }
  }
  for (int k = 0; k < fraction.size[2]; ++k) {
    for (int j = 0; j < fraction.size[1]; ++j) {
      const double* row = fraction.row(j, k);
      int begin = 0, end = fraction.size[0];
      while (begin < end && row[begin] == 0) ++begin;
      while (end > begin && row[end - 1] == 0) --end;
      if (begin == end) continue;
      include(reach.at(fraction.first[1] + j - reach.first[0], fraction.first[2] + k - reach.first[1]),
              {fraction.first[0] + begin, fraction.first[0] + end});
    }
  }
}

template <class T>
template <class Function>
void InteriorField<T>::for_rows(const int (&first)[2], const int (&size)[2], Range own, Function function) const {
  for (int k = 0; k < size[1]; ++k) {
    const int z = domain_.wrapped(2, first[1] + k) - domain_.block.begin[2];  // of the block
    if (z < 0 || z >= domain_.block.size(2)) continue;
    for (int j = 0; j < size[0]; ++j) {
      const int y = domain_.wrapped(1, first[0] + j) - domain_.block.begin[1], row = y + domain_.block.size(1) * z;
      if (y >= 0 && y < domain_.block.size(1) && row >= own.begin && row < own.end) function(row, j, k);
    }
  }
}

template <class T>
void InteriorField<T>::update(Worker worker, const Surfaces& surfaces, Field<T, 3>& relaxation_rate, NodeMask& mask) {
  const Range own = worker.share(row_count(domain_.block));
  if (varies_) set_rates(surfaces, own, relaxation_rate);
  mask.clear(own.begin, own.end);
  for (const int c : surfaces.known_cells()) {
    if (!surfaces.reaches(c)) continue;
    const Rows& reach = reach_[c];
    for_rows(reach.first, reach.size, own, [&](int row, int j, int k) {
      const Interval& columns = reach.at(j, k);
      if (columns.begin < columns.end) mask.mark(row, columns.begin, columns.end);
    });
  }
}

template <class T>
void InteriorField<T>::set_rates(const Surfaces& surfaces, Range own, Field<T, 3>& rate) {
  const bool harmonic = mean_ == ViscosityMean::harmonic;
  const auto averaged = [=](double viscosity) { return harmonic ? 1 / viscosity : viscosity; };
  // The field holds the sum over cells of (ratio - r) I until every cell has been added. Cells that do not overlap may
  // share the columns between them, which are made plain again first and count once.
  const int width = domain_.size[0];
  const Box<3>& block = domain_.block;
  const auto row_of = [&](int row) { return rate.row(row % block.size(1), row / block.size(1)); };
  const auto plain_rate = [&](int row) { return static_cast<T>(rate_of_layer(plain_rate_, viscosity_of_row(row))); };
  for (int row = own.begin; row < own.end; ++row) {
    for (const Interval& columns : changed_[row])
      std::fill(row_of(row) + columns.begin, row_of(row) + columns.end, plain_rate(row));
    changed_[row].clear();
  }
  const auto for_pieces = [&](const auto& function) {
    for (const int c : surfaces.known_cells()) {
      if (!surfaces.reaches(c)) continue;
      const VolumeFraction& fraction = fraction_[c];
      const int first[2] = {fraction.first[1], fraction.first[2]}, size[2] = {fraction.size[1], fraction.size[2]};
      const double inside = averaged(ratio_[surfaces.cells[c].type]);
      for_rows(first, size, own, [&](int row, int j, int k) {
        const double excess = inside - averaged(viscosity_of_row(row));
        for (int begin = 0; begin < fraction.size[0];) {
          const int x = domain_.wrapped(0, fraction.first[0] + begin);
          const int end = std::min(fraction.size[0], begin + width - x);
          const int from = std::max(x, block.begin[0]), to = std::min(x + end - begin, block.end[0]);
          if (from < to)
            function(row, from - block.begin[0], fraction.row(j, k) + begin + (from - x), to - from, excess);
          begin = end;
        }
      });
    }
  };
  for_pieces([&](int row, int x, const double*, int count, double) { add_disjoint(changed_[row], {x, x + count}); });
  for (int row = own.begin; row < own.end; ++row) {
    for (const Interval& columns : changed_[row])
      std::fill(row_of(row) + columns.begin, row_of(row) + columns.end, T(0));
  }
  for_pieces([&](int row, int x, const double* value, int count, double excess) {
    T* to = row_of(row) + x;
    for (int i = 0; i < count; ++i) to[i] += static_cast<T>(excess * value[i]);
  });
  const T outside = static_cast<T>(1 / plain_rate_ - 0.5);
  for (int row = own.begin; row < own.end; ++row) {
    if (changed_[row].empty()) continue;
    const T plain = plain_rate(row), around = static_cast<T>(averaged(viscosity_of_row(row)));
    T* to = row_of(row);
    for (const Interval& columns : changed_[row]) {
      for (int x = columns.begin; x < columns.end; ++x)
        to[x] = to[x] == T(0) ? plain
                              : T(1) / (T(0.5) + (harmonic ? outside / (around + to[x]) : outside * (around + to[x])));
    }
  }
}

template <class T>
void InteriorField<T>::restore(DisplacementWatch::Memory memory, Surfaces& surfaces, Field<T, 3>& relaxation_rate,
                               NodeMask& mask) {
  watch_.recall(std::move(memory), surfaces, [&] {
    cover(Worker{}, surfaces);
    update(Worker{}, surfaces, relaxation_rate, mask);
  });
}

template class InteriorField<float>;
template class InteriorField<double>;

}  // namespace rouleau::core
