#include "periodic.hpp"

#include <algorithm>

namespace rouleau::core {

namespace d2q9 = rouleau::d2q9;

namespace {

constexpr int width = Field<double, 2>::halo;

/// Slots whose velocity component k has the given sign.
template <class Function>
inline void for_slots(int k, int sign, Function function) {
  d2q9::for_each_velocity([&](auto q) {
    if (d2q9::velocity[q][k] == sign) function(q);
  });
}

/// True if slot q of row y is touched from across the left or right border: its row neighbour y - c_y must exist.
template <class T>
bool crosses_side(const Lattice<T, D2Q9>& lattice, int q, int y) {
  const int from = y - d2q9::velocity[q][1];
  return lattice.wraps(1) || (from >= 0 && from < lattice.size(1));
}

/// Copies a row, with the halo at its ends if it is the block's own, of the slots whose velocity has this sign along y.
/// What comes from beyond a side that is another block's is not there to be copied.
template <class T>
void copy_row(Lattice<T, D2Q9>& lattice, int sign, int from, int to) {
  const bool wraps = lattice.wraps(0);
  for_slots(1, sign, [&](int q) {
    const int along = d2q9::velocity[q][0];
    const int begin = wraps ? -1 : (along > 0 ? 1 : 0), end = lattice.size(0) + (wraps ? 1 : (along < 0 ? -1 : 0));
    for (int x = begin; x < end; ++x) lattice.slot(q, {to})[x] = lattice.slot(q, {from})[x];
  });
}

}  // namespace

template <class T>
void send_row(Lattice<T, D2Q9>& lattice, int y) {
  const int nx = lattice.size(0), ny = lattice.size(1);
  if (lattice.wraps(0)) {
    for_slots(0, +1, [&](int q) { lattice.slot(q, {y})[nx] = lattice.slot(q, {y})[0]; });
    for_slots(0, -1, [&](int q) { lattice.slot(q, {y})[-1] = lattice.slot(q, {y})[nx - 1]; });
  }
  if (!lattice.wraps(1)) return;
  if (y == 0) copy_row(lattice, +1, 0, ny);
  if (y == ny - 1) copy_row(lattice, -1, ny - 1, -1);
}

template <class T>
void fill_population_halo(Lattice<T, D2Q9>& lattice) {
  const int nx = lattice.size(0), ny = lattice.size(1);
  for (int q = 1; q < 9; ++q) {
    for (int y = 0; y < ny; ++y) {
      lattice.slot(q, {y})[nx] = lattice.slot(q, {y})[0];
      lattice.slot(q, {y})[-1] = lattice.slot(q, {y})[nx - 1];
    }
    for (int x = -1; x <= nx; ++x) {
      lattice.slot(q, {ny})[x] = lattice.slot(q, {0})[x];
      lattice.slot(q, {-1})[x] = lattice.slot(q, {ny - 1})[x];
    }
  }
}

template <class T>
void receive_row(Lattice<T, D2Q9>& lattice, int y) {
  const int nx = lattice.size(0), ny = lattice.size(1);
  if (lattice.wraps(1)) {
    if (y == 0) copy_row(lattice, +1, ny, 0);
    if (y == ny - 1) copy_row(lattice, -1, -1, ny - 1);
  }
  if (!lattice.wraps(0)) return;
  for_slots(0, +1, [&](int q) {
    if (crosses_side(lattice, q, y)) lattice.slot(q, {y})[0] = lattice.slot(q, {y})[nx];
  });
  for_slots(0, -1, [&](int q) {
    if (crosses_side(lattice, q, y)) lattice.slot(q, {y})[nx - 1] = lattice.slot(q, {y})[-1];
  });
}

namespace {

/// Row `to` beyond a wall from the row that it mirrors.
template <class T>
void mirror(Field<T, 2>& field, int from, int to, double wall) {
  const T* source = field.row(from);
  T* target = field.row(to);
  for (int x = -width; x < field.size(0) + width; ++x) target[x] = static_cast<T>(2 * wall) - source[x];
}

template <class T>
void fill_component(Field<T, 2>& field, int y, const Domain<2>& domain, double lower, double upper) {
  const int nx = field.size(0), ny = field.size(1);
  T* row = field.row(y);
  for (int k = 0; k < width && domain.wraps(0); ++k) {
    row[nx + k] = row[k];
    row[-1 - k] = row[nx - 1 - k];
  }
  if (domain.wraps(1)) {
    if (y < width) std::copy(row - width, row + nx + width, field.row(ny + y) - width);
    if (y >= ny - width) std::copy(row - width, row + nx + width, field.row(y - ny) - width);
  }
  if (y < width && domain.wall_below(1)) mirror(field, y, mirrored(y, 0), lower);
  if (y >= ny - width && domain.wall_above(1)) mirror(field, y, mirrored(y, ny), upper);
}

}  // namespace

template <class T>
void fill_velocity_halo(VectorField<T, 2>& velocity, int y, const Domain<2>& domain, const WallVelocity& walls) {
  fill_component(velocity[0], y, domain, walls.lower, walls.upper);
  fill_component(velocity[1], y, domain, 0.0, 0.0);
}

template <class T>
void mirror_velocity(VectorField<T, 2>& velocity, const Domain<2>& domain, const WallVelocity& walls) {
  const int ny = velocity[0].size(1);
  for (int k = 0; k < width; ++k) {
    if (domain.wall_below(1))
      mirror(velocity[0], k, mirrored(k, 0), walls.lower), mirror(velocity[1], k, mirrored(k, 0), 0.0);
    const int y = ny - 1 - k;
    if (domain.wall_above(1))
      mirror(velocity[0], y, mirrored(y, ny), walls.upper), mirror(velocity[1], y, mirrored(y, ny), 0.0);
  }
}

#define ROULEAU_INSTANTIATE(T)                                                                         \
  template void fill_population_halo<T>(Lattice<T, D2Q9>&);                                            \
  template void send_row<T>(Lattice<T, D2Q9>&, int);                                                   \
  template void receive_row<T>(Lattice<T, D2Q9>&, int);                                                \
  template void fill_velocity_halo<T>(VectorField<T, 2>&, int, const Domain<2>&, const WallVelocity&); \
  template void mirror_velocity<T>(VectorField<T, 2>&, const Domain<2>&, const WallVelocity&);
ROULEAU_INSTANTIATE(float)
ROULEAU_INSTANTIATE(double)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
