#include "halo.hpp"

namespace rouleau::core {

namespace d2q9 = rouleau::d2q9;

namespace {

constexpr int width = Field<double>::halo;

/// Slots whose velocity component k has the given sign.
template <class Function>
inline void for_slots(int k, int sign, Function function) {
  d2q9::for_each_velocity([&](auto q) {
    if (d2q9::velocity[q][k] == sign) function(q);
  });
}

/// True if slot q of row y is touched from across the left or right border: its row neighbour y - c_y must exist.
template <class T>
bool crosses_side(const Lattice<T>& lattice, int q, int y) {
  const int from = y - d2q9::velocity[q][1];
  return lattice.domain().wraps(1) || (from >= 0 && from < lattice.ny());
}

/// Copies a row, with the halo at its ends, of the slots whose velocity has this sign along y.
template <class T>
void copy_row(Lattice<T>& lattice, int sign, int from, int to) {
  for_slots(1, sign, [&](int q) {
    for (int x = -1; x <= lattice.nx(); ++x) lattice.slot(q, to)[x] = lattice.slot(q, from)[x];
  });
}

}  // namespace

template <class T>
void send_row(Lattice<T>& lattice, int y) {
  const int nx = lattice.nx(), ny = lattice.ny();
  for_slots(0, +1, [&](int q) { lattice.slot(q, y)[nx] = lattice.slot(q, y)[0]; });
  for_slots(0, -1, [&](int q) { lattice.slot(q, y)[-1] = lattice.slot(q, y)[nx - 1]; });
  if (!lattice.domain().wraps(1)) return;
  if (y == 0) copy_row(lattice, +1, 0, ny);
  if (y == ny - 1) copy_row(lattice, -1, ny - 1, -1);
}

template <class T>
void begin_halo(Lattice<T>& lattice) {
  const int nx = lattice.nx(), ny = lattice.ny();
  for (int q = 1; q < 9; ++q) {
    for (int y = 0; y < ny; ++y) {
      lattice.slot(q, y)[nx] = lattice.slot(q, y)[0];
      lattice.slot(q, y)[-1] = lattice.slot(q, y)[nx - 1];
    }
    for (int x = -1; x <= nx; ++x) {
      lattice.slot(q, ny)[x] = lattice.slot(q, 0)[x];
      lattice.slot(q, -1)[x] = lattice.slot(q, ny - 1)[x];
    }
  }
}

template <class T>
void receive_row(Lattice<T>& lattice, int y) {
  const int nx = lattice.nx(), ny = lattice.ny();
  if (lattice.domain().wraps(1)) {
    if (y == 0) copy_row(lattice, +1, ny, 0);
    if (y == ny - 1) copy_row(lattice, -1, -1, ny - 1);
  }
  for_slots(0, +1, [&](int q) {
    if (crosses_side(lattice, q, y)) lattice.slot(q, y)[0] = lattice.slot(q, y)[nx];
  });
  for_slots(0, -1, [&](int q) {
    if (crosses_side(lattice, q, y)) lattice.slot(q, y)[nx - 1] = lattice.slot(q, y)[-1];
  });
}

namespace {

template <class T>
void fill_component(Field<T>& field, int y, const Domain<2>& domain, double lower, double upper) {
  const int nx = field.nx(), ny = field.ny();
  T* row = field.row(y);
  for (int k = 0; k < width; ++k) {
    row[nx + k] = row[k];
    row[-1 - k] = row[nx - 1 - k];
  }
  const auto fill = [&](int halo_row, bool wall, double speed) {
    const T offset = wall ? static_cast<T>(2 * speed) : T(0), sign = wall ? T(-1) : T(1);
    T* target = field.row(halo_row);
    for (int x = -width; x < nx + width; ++x) target[x] = offset + sign * row[x];
  };
  if (y < width) domain.wraps(1) ? fill(ny + y, false, 0) : fill(mirrored(y, 0), true, lower);
  if (y >= ny - width) domain.wraps(1) ? fill(y - ny, false, 0) : fill(mirrored(y, ny), true, upper);
}

}  // namespace

template <class T>
void fill_velocity_halo(VectorField<T>& velocity, int y, const Domain<2>& domain, const WallVelocity& walls) {
  fill_component(velocity.x, y, domain, walls.lower, walls.upper);
  fill_component(velocity.y, y, domain, 0.0, 0.0);
}

#define ROULEAU_INSTANTIATE(T)                 \
  template void begin_halo<T>(Lattice<T>&);    \
  template void send_row<T>(Lattice<T>&, int); \
  template void receive_row<T>(Lattice<T>&, int); \
  template void fill_velocity_halo<T>(VectorField<T>&, int, const Domain<2>&, const WallVelocity&);
ROULEAU_INSTANTIATE(float)
ROULEAU_INSTANTIATE(double)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
