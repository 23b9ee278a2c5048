#include "lattice.hpp"

namespace rouleau::core {

template <class T>
Lattice<T>::Lattice(const Domain<2>& domain)
    : domain_(domain),
      nx_(domain.block.size(0)),
      ny_(domain.block.size(1)),
      wall_below_(domain.wall_below(1)),
      wall_above_(domain.wall_above(1)),
      wraps_{domain.wraps(0), domain.wraps(1)} {
  constexpr int line = 64 / sizeof(T);
  // Rows begin on a cache line; the halo of a row's right end and of the next row's left end share what lies between.
  stride_ = (nx_ + 2 + line - 1) / line * line;
  // Planes start a few cache lines apart modulo 4096 bytes, so that nine streams do not fall into one cache set.
  const std::size_t plane = static_cast<std::size_t>(stride_) * (ny_ + 2) + line;
  constexpr std::size_t page = 4096 / sizeof(T), stagger = 7 * line;
  const std::size_t spacing = (plane + page - 1) / page * page + stagger;
  storage_ = Storage<T>(spacing * 9);
  for (int q = 0; q < 9; ++q) origin_[q] = storage_.data() + spacing * q + stride_ + line;
}

template class Lattice<float>;
template class Lattice<double>;

}  // namespace rouleau::core
