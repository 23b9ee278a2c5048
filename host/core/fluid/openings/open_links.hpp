// What comes in through openings: the links of a block that cross the planes of its lattice's open ends.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/fluid/lattice.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"
#include "opening.hpp"

namespace rouleau::core {

/// With velocity q into the fluid, w = -q out of it, f' after collision, what comes in at node x is
///
///     velocity:  f_q(x, t + 1) = f'_w + 6 w_q c_q . u,
///     pressure:  f_q(x, t + 1) = -f'_w + 2 E_q(p, u) + (f_q + f_w + f'_q + f'_w)/2 - 2 E_q(x),
///
/// u where the link crosses the plane (Ladd, J. Fluid Mech. 271, 1994), E the even part of the equilibrium there and
/// in the node, so that 2 E_q(p, u) - 2 E_q(x) = 2 w_q (3 p - rho), and with inertia 6 w_q (u^2 - u(x)^2) more; there,
/// u is u(x) times what the developed flow (Section) is at the crossing over what it is in the node. What is added to
/// anti-bounce-back is (2 - s) times the non-equilibrium of a relaxation with rate s, from numbers of the node alone
/// and for any collision: with it a developed flow crosses the plane undisturbed (Ginzburg, Verhaeghe, d'Humieres,
/// Commun. Comput. Phys. 3, 519, 2008). What comes in balances the momentum of the node in steady flow only if the
/// pressure is p in the node. The plane is half a spacing away, so p here is that of the plane and what the developed
/// flow with the node's velocity loses on this way. Links that end in a wall, or in the solid that goes on beyond the
/// plane, are the wall's.
///
/// Nothing else touches what comes in: before a collision it is put where that reads it.
template <class T, class Set>
class OpenLinks {
 public:
  static constexpr int dimension = Set::dimension;
  using In = typename Lattice<T, Set>::In;
  using Out = typename Lattice<T, Set>::Out;
  struct FlowThere {
    double viscosity, body_force;  ///< along the axis
    bool inertia;
  };
  struct Link {
    T *own, *back;  ///< where an even and an odd step read f_q
    T known;        ///< 6 w_q c_q . u, or 6 w_q p without velocity
    T resistance;   ///< what a velocity takes from 6 w_q p
    T convection;   ///< 6 w_q with inertia, else 0
    T rise, drag;   ///< where the link crosses the plane, the velocity is u(x) rise + drag
    T next;         ///< f_q of the next step
    T held;         ///< what f_q(x, t + 1) has of this step before collision
    double passed;  ///< what has come in by it, less what has left
    int x;
    signed char q;
    bool pressure;
  };
  OpenLinks(Lattice<T, Set>& lattice, const std::array<Opening, 2>& openings, const SolidNodes<dimension>* solid,
            const WallVelocity& walls, const FlowThere& flow);

  /// The populations of an even step have been set, with what comes in among them.
  void restart() {
    for (Link& link : links_) link.next = *link.own;
  }
  [[nodiscard]] std::span<Link> of_row(int i) { return {links_.data() + first_[i], first_[i + 1] - first_[i]}; }
  /// Before row i is collided, and before its links to solid nodes look at it. May be repeated.
  void before_step(Parity parity, int i) {
    for (Link& link : of_row(i)) *(parity == Parity::even ? link.own : link.back) = link.next;
  }
  /// When all that comes to row i is there; `in`, `out`: as the collision gets them.
  void before_collision(int i, const In& in);
  void after_step(int i, const Out& out) {
    for (Link& link : of_row(i)) {
      const T left = out[Set::opposite[link.q]][link.x];
      link.next = link.known + (link.pressure ? link.held + (out[link.q][link.x] - left) / 2 : left);
      link.passed += static_cast<double>(link.next) - static_cast<double>(left);
    }
  }
  [[nodiscard]] std::size_t bytes() const { return links_.size() * sizeof(Link); }

 private:
  template <class End>
  void add(Lattice<T, Set>& lattice, const End& end, const std::array<int, dimension>& node, bool inertia);

  int axis_;
  T half_force_;
  std::vector<Link> links_;
  std::vector<std::size_t> first_;  ///< of each row, and the end
};

extern template class OpenLinks<float, D2Q9>;
extern template class OpenLinks<double, D2Q9>;
extern template class OpenLinks<float, D3Q19>;
extern template class OpenLinks<double, D3Q19>;

}  // namespace rouleau::core
