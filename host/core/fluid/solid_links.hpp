// Half-way bounce-back at solid nodes inside a block.
#pragma once

#include <cstddef>
#include <vector>

#include "lattice.hpp"
#include "solid_nodes.hpp"

namespace rouleau::core {

/// The links of a block that lead from a fluid node to a solid one. Solid nodes are not collided, so the slots that would
/// stream between the two are free: before an odd step of a row each of its links puts what comes back into the slot that
/// the collision reads, and after it what has left into the slot that the next even step reads. No link touches what
/// another one, or a collision, does.
template <class T, class Set>
class SolidLinks {
 public:
  static constexpr int dimension = Set::dimension;
  SolidLinks(Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid);

  /// Around an odd step of row i. The first may be repeated: observers want it, too.
  void before_odd_step(int i) const {
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) *links_[k].beyond = *links_[k].own;
  }
  void after_odd_step(int i) const {
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) *links_[k].back = *links_[k].beyond;
  }

  /// Calls function(x, q) for the links of row i, q the velocity that comes from the solid node.
  template <class Function>
  void for_links(int i, Function function) const {
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) function(links_[k].x, links_[k].q);
  }
  [[nodiscard]] std::size_t bytes() const { return links_.size() * sizeof(Link); }

 private:
  struct Link {
    T* own;     ///< slot q of the fluid node
    T* beyond;  ///< the opposite slot of the solid node, or of its image in the halo
    T* back;  ///< as `own`, but of the image from which it comes home if the link crosses a periodic border of the block
    int x, q;
  };
  std::vector<Link> links_;
  std::vector<std::size_t> first_;  ///< of each row, and the end
};

extern template class SolidLinks<float, D3Q19>;
extern template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
