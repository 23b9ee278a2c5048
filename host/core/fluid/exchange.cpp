#include "exchange.hpp"

#include <algorithm>

namespace rouleau::core {

namespace d2q9 = rouleau::d2q9;

namespace {

constexpr int halo = Field<double>::halo;

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
  return lattice.periodic_y() || (from >= 0 && from < lattice.ny());
}

/// Copies a row, halo included, of the slots whose velocity has this sign along y.
template <class T>
void copy_row(Lattice<T>& lattice, int sign, int from, int to) {
  for_slots(1, sign, [&](int q) {
    for (int x = -1; x <= lattice.nx(); ++x) lattice.slot(q, to)[x] = lattice.slot(q, from)[x];
  });
}

}  // namespace

template <class T>
void add_wall_momentum(Lattice<T>& lattice, int y, const WallVelocity& walls) {
  if (lattice.periodic_y()) return;
  const auto add = [&](int normal, double speed) {
    if (speed == 0) return;
    for_slots(1, normal, [&](int q) {
      const T momentum = static_cast<T>(6 * d2q9::weight[q] * d2q9::velocity[q][0] * speed);
      T* slot = lattice.slot(q, y);
      if (d2q9::velocity[q][0] != 0) {
        for (int x = 0; x < lattice.nx(); ++x) slot[x] += momentum;
      }
    });
  };
  if (y == 0) add(+1, walls.lower);
  if (y == lattice.ny() - 1) add(-1, walls.upper);
}

template <class T>
void send_row(Lattice<T>& lattice, int y) {
  const int nx = lattice.nx(), ny = lattice.ny();
  for_slots(0, +1, [&](int q) { lattice.slot(q, y)[nx] = lattice.slot(q, y)[0]; });
  for_slots(0, -1, [&](int q) { lattice.slot(q, y)[-1] = lattice.slot(q, y)[nx - 1]; });
  if (!lattice.periodic_y()) return;
  if (y == 0) copy_row(lattice, +1, 0, ny);
  if (y == ny - 1) copy_row(lattice, -1, ny - 1, -1);
}

template <class T>
void begin_exchange(Lattice<T>& lattice) {
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
  if (lattice.periodic_y()) {
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

/// Calls function(image) for every halo row that belongs to row y: its periodic images, or its mirror image in a wall.
template <class Function>
void for_halo_rows(int y, int ny, bool periodic_y, Function function) {
  if (y < halo) function(periodic_y ? ny + y : -1 - y);
  if (y >= ny - halo) function(periodic_y ? y - ny : 2 * ny - 1 - y);
}

template <class T>
void clear_component(Field<T>& field, int y, bool periodic_y) {
  const auto clear = [&](int row, int begin, int end) {
    std::fill(field.row(row) + begin, field.row(row) + end, T(0));
  };
  const int nx = field.nx();
  clear(y, -halo, 0);
  clear(y, nx, nx + halo);
  for_halo_rows(y, field.ny(), periodic_y, [&](int image) { clear(image, -halo, nx + halo); });
}

/// Adds the side halo of a row (a halo row too) to its periodic images.
template <class T>
void fold_sides(Field<T>& field, int y) {
  const int nx = field.nx();
  T* row = field.row(y);
  for (int k = 0; k < halo; ++k) {
    row[k] += row[nx + k];
    row[nx - 1 - k] += row[-1 - k];
  }
}

template <class T>
void fold_component(Field<T>& field, int y, bool periodic_y) {
  fold_sides(field, y);
  for_halo_rows(y, field.ny(), periodic_y, [&](int image) {
    fold_sides(field, image);
    T* target = field.row(y);
    const T* source = field.row(image);
    const T sign = periodic_y ? T(1) : T(-1);
    for (int x = 0; x < field.nx(); ++x) target[x] += sign * source[x];
  });
}

template <class T>
void fill_component(Field<T>& field, int y, bool periodic_y, double lower, double upper) {
  const int nx = field.nx(), ny = field.ny();
  T* row = field.row(y);
  for (int k = 0; k < halo; ++k) {
    row[nx + k] = row[k];
    row[-1 - k] = row[nx - 1 - k];
  }
  for_halo_rows(y, ny, periodic_y, [&](int image) {
    const T offset = periodic_y ? T(0) : static_cast<T>(2 * (image < 0 ? lower : upper));
    const T sign = periodic_y ? T(1) : T(-1);
    T* target = field.row(image);
    for (int x = -halo; x < nx + halo; ++x) target[x] = offset + sign * row[x];
  });
}

}  // namespace

template <class T>
void clear_force_halo(VectorField<T>& force, int y, bool periodic_y) {
  clear_component(force.x, y, periodic_y);
  clear_component(force.y, y, periodic_y);
}

template <class T>
void fold_force_row(VectorField<T>& force, int y, bool periodic_y) {
  fold_component(force.x, y, periodic_y);
  fold_component(force.y, y, periodic_y);
}

template <class T>
void fill_velocity_halo(VectorField<T>& velocity, int y, bool periodic_y, const WallVelocity& walls) {
  fill_component(velocity.x, y, periodic_y, walls.lower, walls.upper);
  fill_component(velocity.y, y, periodic_y, 0.0, 0.0);
}

#define ROULEAU_INSTANTIATE(T)                                               \
  template void add_wall_momentum<T>(Lattice<T>&, int, const WallVelocity&); \
  template void begin_exchange<T>(Lattice<T>&);                              \
  template void send_row<T>(Lattice<T>&, int);                               \
  template void receive_row<T>(Lattice<T>&, int);                            \
  template void clear_force_halo<T>(VectorField<T>&, int, bool);             \
  template void fold_force_row<T>(VectorField<T>&, int, bool);               \
  template void fill_velocity_halo<T>(VectorField<T>&, int, bool, const WallVelocity&);
ROULEAU_INSTANTIATE(float)
ROULEAU_INSTANTIATE(double)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
