// Bounce-back at solid nodes inside a block.
#pragma once

#include <cstddef>
#include <vector>

#include "lattice.hpp"
#include "solid_nodes.hpp"

namespace rouleau::core {

/// The links of a block that lead from a fluid node to a solid one. With velocity q away from the wall, w = -q towards
/// it, and a wall at the share s of the link, what comes back to node x is
///
///     f_q(x, t + 1) = f'_w(x, t) + k (f_w(x, t + 1) - f'_q(x, t)),   k = (1 - 2 s)/(1 + 2 s),
///
/// f' after collision: half-way bounce-back for s = 1/2, and of second order for any s, from numbers of node x alone
/// (central linear interpolation: Ginzburg, Verhaeghe, d'Humieres, Commun. Comput. Phys. 3, 427, 2008). Without a fluid
/// node on the other side of x, k is 0.
///
/// Solid nodes are not collided, so the slots that would stream between them and x are free: before an odd step of a
/// row each of its links puts what comes back into the slot that the collision reads. No link touches what another one,
/// or a collision, does.
template <class T, class Set>
class SolidLinks {
 public:
  static constexpr int dimension = Set::dimension;
  SolidLinks(Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid);

  /// The populations of an even step have been set, with what comes back among them.
  void restart() {
    for (Link& link : links_) link.left = *link.own, link.away = *link.toward;
  }
  /// Before row i is collided: after receive_row() in an even step. May be repeated.
  void before_step(Parity parity, int i) {
    const bool even = parity == Parity::even;
    for_row(i, [&](Link& link) {
      if (even) {
        *link.own = link.left + link.factor * (*link.toward - link.away);
      } else {
        *link.back = link.left + link.factor * (*link.toward_streamed - link.away);
      }
    });
  }
  void after_step(Parity parity, int i) {
    const bool even = parity == Parity::even;
    for_row(i, [&](Link& link) {
      link.left = even ? *link.own : *link.back;
      link.away = even ? *link.toward : *link.toward_streamed;
    });
  }

  /// What the collisions of the last step made of the populations along a link: f'_w, which has left, and f'_q.
  struct Last {
    double left, away;
  };
  /// Calls function(x, q, last, plane) for the links of row i; `plane`: it leads out of the domain, over a wall that
  /// lies before the domain's own, not to a solid node.
  template <class Function>
  void for_links(int i, Function function) const {
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      const Link& link = links_[k];
      function(link.x, link.q, last_of(link), link.plane);
    }
  }
  /// Calls function(x, q, last) for the links of row i, whose last step is what that says from now on.
  template <class Function>
  void recall(int i, Function function) {
    for_row(i, [&](Link& link) {
      Last last = last_of(link);
      function(link.x, link.q, last);
      link.left = static_cast<T>(last.left), link.away = static_cast<T>(last.away);
    });
  }
  [[nodiscard]] std::size_t bytes() const { return links_.size() * sizeof(Link); }

 private:
  struct Link {
    T* own;                ///< slot q of x: f_q before an even step, f'_w after it
    T* toward;             ///< slot w of x: f_w before an even step, f'_q after it
    T* back;               ///< what an odd step reads as f_q and writes as f'_w
    T* toward_streamed;    ///< what it reads as f_w and writes as f'_q
    T factor, left, away;  ///< k; f'_w and f'_q of the last step
    int x;
    signed char q;
    bool plane;
  };
  static Last last_of(const Link& link) { return {static_cast<double>(link.left), static_cast<double>(link.away)}; }
  template <class Function>
  void for_row(int i, Function function) {
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) function(links_[k]);
  }

  std::vector<Link> links_;
  std::vector<std::size_t> first_;  ///< of each row, and the end
};

extern template class SolidLinks<float, D2Q9>;
extern template class SolidLinks<double, D2Q9>;
extern template class SolidLinks<float, D3Q19>;
extern template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
