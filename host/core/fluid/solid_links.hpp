// Bounce-back at solid nodes inside a block.
#pragma once

#include <cstddef>
#include <span>
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
/// node on the other side of x, k is 0. A wall that moves with velocity u there gives 6 w_q (1 + k) c_q . u more.
///
/// Solid nodes are not collided, so the slots that would stream between them and x are free: before a step of a
/// row each of its links puts what comes back into the slot that the collision reads. No link touches what another one,
/// or a collision, does.
template <class T, class Set>
class SolidLinks {
 public:
  static constexpr int dimension = Set::dimension;
  using Out = typename Lattice<T, Set>::Out;
  /// Of a fluid at rest. `time`: of a step, in the unit of the walls' velocities; 0: they rest.
  SolidLinks(const Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid, double time);

  /// `plane`: it leads out of the domain, over a wall that lies before the domain's own, not to a solid node.
  struct Link {
    T factor;      ///< k
    T left, away;  ///< what the last step made of the populations: f'_w, which has left, and f'_q
    int x;
    signed char q, w;
    bool plane;
  };
  /// Those of a piece of the lattice's, by its number.
  [[nodiscard]] std::span<Link> of_piece(std::size_t number) {
    return {links_.data() + first_[number], links_.data() + first_[number + 1]};
  }
  /// What the next step takes for the last one's. `out`: as a collision of the piece gets them; what it reads as f_q it
  /// writes as f'_w.
  void after_step(std::size_t piece, const Out& out) {
    for (Link& link : of_piece(piece)) link.left = out[link.w][link.x], link.away = out[link.q][link.x];
  }
  /// The same when the populations of an even step have been set, with what comes back among them.
  void restart(std::size_t piece, const Out& out) {
    after_step(piece, out);
    for (Link& link : of_piece(piece)) link.left -= given(link);
  }
  /// Of a fluid that has been set to rest while walls move: they have brought in half of what they bring in a step.
  /// Momentum of alternating sign along the lattice is conserved but for its sign. What a wall brings of it in a step
  /// would alternate between nothing and all of it for ever; it begins at its mean.
  void start_walls() {
    for (std::size_t i = 0; i < given_.size(); ++i) links_[i].left += given_[i] / 2;
  }
  /// Before the piece is collided: after receive_row() in an even step. May be repeated.
  void before_step(std::size_t piece, const Out& out) {
    for (const Link& link : of_piece(piece))
      out[link.w][link.x] = link.left + link.factor * (out[link.q][link.x] - link.away);
    if (given_.empty()) return;
    for (const Link& link : of_piece(piece)) out[link.w][link.x] += given(link);
  }
  /// Of the wall along a link, c_q . u, less what keeps the mass.
  [[nodiscard]] double wall_velocity(const Link& link) const {
    return static_cast<double>(given(link)) / (6 * Set::weight[link.q] * (1 + static_cast<double>(link.factor)));
  }
  [[nodiscard]] std::size_t bytes() const { return links_.size() * sizeof(Link) + given_.size() * sizeof(T); }

 private:
  [[nodiscard]] T given(const Link& link) const {
    return given_.empty() ? T{0} : given_[static_cast<std::size_t>(&link - links_.data())];
  }

  std::vector<Link> links_;
  std::vector<T> given_;            ///< to what comes back, by a wall that moves; empty where all rest
  std::vector<std::size_t> first_;  ///< of each piece, and the end
};

extern template class SolidLinks<float, D2Q9>;
extern template class SolidLinks<double, D2Q9>;
extern template class SolidLinks<float, D3Q19>;
extern template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
