#include "lattice.hpp"

#include <utility>

namespace rouleau::core {

template <class T, class Set>
Lattice<T, Set>::Lattice(const Domain<dimension>& domain, RowPieces<dimension> pieces)
    : domain_(domain), pieces_(std::move(pieces)) {
  for (int k = 0; k < dimension; ++k) {
    size_[k] = domain.block.size(k);
    wall_below_[k] = domain.wall_below(k), wall_above_[k] = domain.wall_above(k);
    wraps_[k] = domain.wraps(k);
  }
  constexpr int line = 64 / sizeof(T);
  // Rows begin on a cache line; the halo of a row's right end and of the next row's left end share what lies between.
  stride_[0] = 1;
  stride_[1] = (size_[0] + 2 + line - 1) / line * line;
  for (int k = 2; k < dimension; ++k) stride_[k] = stride_[k - 1] * (size_[k - 1] + 2);
  // The arrays of the slots start a few cache lines apart modulo 4096 bytes, so that their streams do not fall into one
  // cache set.
  const std::ptrdiff_t all = stride_[dimension - 1] * (size_[dimension - 1] + 2);
  const auto slot = static_cast<std::size_t>((pieces_.all() ? all : pieces_.count()) + line);
  constexpr std::size_t page = 4096 / sizeof(T), stagger = 7 * line;
  const std::size_t spacing = (slot + page - 1) / page * page + stagger;
  storage_ = Storage<T>(spacing * velocity_count);
  Row first;
  first.fill(1);
  const std::ptrdiff_t before = pieces_.all() ? offset(line, first) : 0;
  for (int q = 0; q < velocity_count; ++q) origin_[q] = storage_.data() + spacing * q + before;
}

template class Lattice<float, D2Q9>;
template class Lattice<double, D2Q9>;
template class Lattice<float, D3Q19>;
template class Lattice<double, D3Q19>;

}  // namespace rouleau::core
