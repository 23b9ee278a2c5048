#include "periodic.hpp"

#include <algorithm>

namespace rouleau::core {

namespace {

constexpr int width = Field<double, 2>::halo;

/// Slots whose velocity along x has the given sign.
template <class Set, class Function>
inline void for_slots(int sign, Function function) {
  Set::for_each_velocity([&](auto q) {
    if (Set::velocity[q][0] == sign) function(q);
  });
}

/// Whether a row lies at an end of an axis across x that slot q is streamed in from, which must be the block's own
/// other end: `across` becomes the row of the halo that stands for it there. False: nothing comes to this slot, or it
/// does not come across such an end.
template <class T, class Set>
bool comes_across(const Lattice<T, Set>& lattice, int q, const typename Lattice<T, Set>::Row& row,
                  typename Lattice<T, Set>::Row& across) {
  across = row;
  bool comes = false;
  for (int k = 1; k < Set::dimension; ++k) {
    const int c = Set::velocity[q][k], from = row[k - 1] - c, size = lattice.size(k);
    if (from >= 0 && from < size) continue;
    if (!lattice.wraps(k)) return false;
    across[k - 1] += c * size;
    comes = true;
  }
  return comes;
}

/// The same slots, in the row itself or there: from a row beyond a wall, or one of another block, nothing comes.
template <class T, class Set>
bool comes_along(const Lattice<T, Set>& lattice, int q, const typename Lattice<T, Set>::Row& row) {
  for (int k = 1; k < Set::dimension; ++k) {
    const int from = row[k - 1] - Set::velocity[q][k];
    if (!lattice.wraps(k) && (from < 0 || from >= lattice.size(k))) return false;
  }
  return true;
}

/// Whether a row has images in the block's own halo.
template <class T, class Set>
bool at_border(const Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row) {
  for (int k = 1; k < Set::dimension; ++k)
    if (lattice.wraps(k) && (row[k - 1] == 0 || row[k - 1] == lattice.size(k) - 1)) return true;
  return false;
}

/// Copies between a row and the rows of the halo that stand for it, with the halo at their ends if it is the block's
/// own. What comes from beyond a side that is another block's is not there to be copied.
template <class T, class Set>
void copy_across(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row, bool out) {
  if (!at_border(lattice, row)) return;
  const bool wraps = lattice.wraps(0);
  Set::for_each_velocity([&](auto q) {
    typename Lattice<T, Set>::Row across;
    if (!comes_across(lattice, q, row, across)) return;
    const int along = Set::velocity[q][0];
    const int begin = wraps ? -1 : (along > 0 ? 1 : 0), end = lattice.size(0) + (wraps ? 1 : (along < 0 ? -1 : 0));
    const auto copy = [&](int first, int last) {
      const T* const from = lattice.slot(q, out ? row : across, first);
      std::copy(from + first, from + last, lattice.slot(q, out ? across : row, first) + first);
    };
    if (lattice.pieces().all()) return copy(begin, end);
    for (int x = begin; x < end; ++x)
      if (lattice.holds(x, row) && lattice.holds(x, across)) copy(x, x + 1);
  });
}

/// From node to node of a row, if both are there: the slots with this sign along x that are wanted.
template <class T, class Set, class Wanted>
void copy_node(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row, int sign, int from, int to,
               Wanted wanted) {
  if (!lattice.holds(from, row) || !lattice.holds(to, row)) return;
  const std::ptrdiff_t source = lattice.offset(from, row), target = lattice.offset(to, row);
  for_slots<Set>(sign, [&](int q) {
    if (wanted(q)) lattice.origin(q)[target] = lattice.origin(q)[source];
  });
}

/// A row of the halo that is made of a row of the block: sum - u if it lies beyond a wall (with another one, sum + u).
template <int D>
struct Image {
  std::array<int, D - 1> row;
  double sum = 0;
  bool reversed = false;
};

/// Writes an image of a row, with the halo at its ends.
template <class T, int D>
void write_image(Field<T, D>& field, const std::array<int, D - 1>& row, const Image<D>& image) {
  const T* const source = field.row(row);
  T* const target = field.row(image.row);
  const T sum = static_cast<T>(image.sum);
  const int begin = -width, end = field.size(0) + width;
  if (image.reversed)
    for (int x = begin; x < end; ++x) target[x] = sum - source[x];
  else if (sum != T(0))
    for (int x = begin; x < end; ++x) target[x] = sum + source[x];
  else
    std::copy(source + begin, source + end, target + begin);
}

/// Of a component with these speeds of the walls across y.
template <class T, int D>
void fill_images(Field<T, D>& field, const std::array<int, D - 1>& row, const Domain<D>& domain, int axis,
                 const Image<D>& image, const WallVelocity& walls) {
  if (axis == D) {
    if (image.row != row) write_image(field, row, image);
    return;
  }
  const int place = row[axis - 1], size = field.size(axis);
  const auto next = [&](int to, double speed, bool mirrored) {
    Image<D> further = image;
    further.row[axis - 1] = to;
    if (mirrored) further.sum = 2 * speed - image.sum, further.reversed = !image.reversed;
    fill_images(field, row, domain, axis + 1, further, walls);
  };
  next(place, 0, false);
  const bool low = place < width, high = place >= size - width;
  if (domain.wraps(axis) && low) next(size + place, 0, false);
  if (domain.wraps(axis) && high) next(place - size, 0, false);
  if (domain.wall_below(axis) && low) next(mirrored(place, 0), axis == 1 ? walls.lower : 0, true);
  if (domain.wall_above(axis) && high) next(mirrored(place, size), axis == 1 ? walls.upper : 0, true);
}

}  // namespace

template <class T, class Set>
void send_row(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row) {
  const int nx = lattice.size(0);
  if (lattice.wraps(0)) {
    const auto all = [](int) { return true; };
    copy_node(lattice, row, +1, 0, nx, all);
    copy_node(lattice, row, -1, nx - 1, -1, all);
  }
  copy_across(lattice, row, true);
}

template <class T, class Set>
void receive_row(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row) {
  const int nx = lattice.size(0);
  copy_across(lattice, row, false);
  if (!lattice.wraps(0)) return;
  const auto comes = [&](int q) { return comes_along(lattice, q, row); };
  copy_node(lattice, row, +1, nx, 0, comes);
  copy_node(lattice, row, -1, -1, nx - 1, comes);
}

template <class T, int D>
void fill_velocity_halo(VectorField<T, D>& velocity, const std::array<int, D - 1>& row, const Domain<D>& domain,
                        const WallVelocity& walls) {
  for (int component = 0; component < D; ++component) {
    Field<T, D>& field = velocity[component];
    const int nx = field.size(0);
    T* const own = field.row(row);
    for (int k = 0; k < width && domain.wraps(0); ++k) {
      own[nx + k] = own[k];
      own[-1 - k] = own[nx - 1 - k];
    }
    fill_images(field, row, domain, 1, {row}, component == 0 ? walls : WallVelocity{});
  }
}

template <class T, int D>
void mirror_velocity(VectorField<T, D>& velocity, const Domain<D>& domain, const WallVelocity& walls) {
  for (int axis = 1; axis < D; ++axis) {
    if (!domain.walled(axis)) continue;
    const int begin = domain.block.begin[axis], lattice = domain.size[axis], size = domain.block.size(axis);
    const auto mirror = [&](std::array<int, D - 1> row, int from, int to, int component, double speed) {
      row[axis - 1] = from;
      Image<D> image{.row = row, .sum = 2 * speed, .reversed = true};
      image.row[axis - 1] = to;
      write_image(velocity[component], row, image);
    };
    // Of each of the rows beside each other across the other axis, its halo included. A wall may lie in the halo of a
    // block that does not touch it.
    Box<D> columns = domain.block;
    for (int k = 1; k < D; ++k) columns.end[k] = columns.begin[k] + (k == axis ? 1 : velocity[0].size(k) + 2 * width);
    for (int i = 0; i < row_count(columns); ++i) {
      std::array<int, D - 1> row = row_of(columns, i);
      for (int& place : row) place -= width;
      for (int k = 0; k < width; ++k) {
        for (int component = 0; component < D; ++component) {
          const WallVelocity speed = component == 0 && axis == 1 ? walls : WallVelocity{};
          const int below = -begin - 1 - k, above = lattice - begin + k;
          if (below >= -width) mirror(row, k - begin, below, component, speed.lower);
          if (above < size + width) mirror(row, above - 1 - 2 * k, above, component, speed.upper);
        }
      }
    }
  }
}

#define ROULEAU_INSTANTIATE(T, Set, D)                                                                      \
  template void send_row(Lattice<T, Set>&, const Lattice<T, Set>::Row&);                                    \
  template void receive_row(Lattice<T, Set>&, const Lattice<T, Set>::Row&);                                 \
  template void fill_velocity_halo<T, D>(VectorField<T, D>&, const Lattice<T, Set>::Row&, const Domain<D>&, \
                                         const WallVelocity&);                                              \
  template void mirror_velocity<T, D>(VectorField<T, D>&, const Domain<D>&, const WallVelocity&);
ROULEAU_INSTANTIATE(float, D2Q9, 2)
ROULEAU_INSTANTIATE(double, D2Q9, 2)
ROULEAU_INSTANTIATE(float, D3Q19, 3)
ROULEAU_INSTANTIATE(double, D3Q19, 3)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
