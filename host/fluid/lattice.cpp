#include "lattice.hpp"

namespace rouleau::host {

namespace d2q9 = rouleau::d2q9;

template <class T>
Lattice<T>::Lattice(int nx, int ny, bool periodic_y) : nx_(nx), ny_(ny), periodic_y_(periodic_y) {
  constexpr int line = 64 / sizeof(T);
  stride_ = (nx + 1 + line - 1) / line * line + line;
  // Planes start a few cache lines apart modulo 4096 bytes, so that nine streams do not fall into one cache set.
  const std::size_t plane = static_cast<std::size_t>(stride_) * (ny + 2);
  constexpr std::size_t page = 4096 / sizeof(T), stagger = 7 * line;
  const std::size_t spacing = (plane + page - 1) / page * page + stagger;
  count_ = spacing * 9;
  storage_.reset(new (std::align_val_t{4096}) T[count_]{});
  for (int q = 0; q < 9; ++q) origin_[q] = storage_.get() + spacing * q + stride_ + line;
}

template <class T>
void Lattice<T>::row_pointers(Parity parity, int y, const T* (&in)[9]) const {
  for (int q = 0; q < 9; ++q) {
    const int opposite = d2q9::opposite[q];
    const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
    if (parity == Parity::even || outside(y - cy)) {
      in[q] = slot(q, y);
    } else {
      in[q] = slot(opposite, y - cy) - cx;
    }
  }
}

template <class T>
void Lattice<T>::row_pointers(Parity parity, int y, const T* (&in)[9], T* (&out)[9]) {
  row_pointers(parity, y, in);
  for (int q = 0; q < 9; ++q) {
    const int opposite = d2q9::opposite[q];
    const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
    if (parity == Parity::even || outside(y + cy)) {
      out[q] = slot(opposite, y);
    } else {
      out[q] = slot(q, y + cy) + cx;
    }
  }
}

template class Lattice<float>;
template class Lattice<double>;

}  // namespace rouleau::host
