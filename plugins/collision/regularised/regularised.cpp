// Regularised collision: f' = w (rho + 3 c.(u + F/2) + 9/2 (cc - I/3):A), A = omega uu + (1 - omega/2)(uF + Fu) +
// (1 - omega)(sum f cc - rho I/3): all that is neither density, momentum nor stress is projected out before relaxation.
// Latt and Chopard (Math. Comput. Simul. 72:165, 2006); u holds F/2, and (uF + Fu)/2 is no part of the stress that
// stays.
#include <rouleau/collision.hpp>

struct Regularised {
  explicit Regularised(const rouleau::Parameters&) {}

  template <class Node, class S>
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const S& omega, S (&after)[Node::velocity_count]) const {
    constexpr int d = Node::dimension;
    constexpr const auto& c = Node::VelocitySet::velocity;
    const auto& f = node.f;
    const S keep = 1.0 - omega, pressure = node.density * (1.0 / 3.0);
    S stress[d][d], axis[d];
    for (auto& row : stress) {
      for (S& component : row) component = S(0);
    }
    Node::for_each_pair([&](auto q) {
      const S pair = f[q] + f[Node::opposite[q]];
      for (int i = 0; i < d; ++i) {
        if (q == axes<Node>[i]) axis[i] = pair;
        for (int j = i; j < d && q != axes<Node>[i]; ++j) {
          if (c[q][i] * c[q][j] > 0) stress[i][j] += pair;
          if (c[q][i] * c[q][j] < 0) stress[i][j] -= pair;
        }
      }
    });
    S momentum[d], half[d];
    for (int i = 0; i < d; ++i) {
      stress[i][i] = axis[i] + stress[i][i] - pressure;
      for (int j = i; j < d; ++j) stress[i][j] *= keep;
      momentum[i] = node.momentum[i];
      if constexpr (Node::forced) momentum[i] += node.force[i];
    }
    if constexpr (Node::inertia) {
      // omega uu + (1 - omega/2)(uF + Fu) = (h u)v + (v h)u with h = omega u/2 + (1 - omega/2) F and v = u.
      for (int i = 0; i < d; ++i) {
        half[i] = 0.5 * omega * node.velocity[i];
        if constexpr (Node::forced) half[i] += (1.0 - 0.5 * omega) * node.force[i];
      }
      for (int i = 0; i < d; ++i) {
        stress[i][i] += 2.0 * half[i] * node.velocity[i];
        for (int j = i + 1; j < d; ++j) stress[i][j] += half[i] * node.velocity[j] + half[j] * node.velocity[i];
      }
    }
    S trace = stress[0][0];
    for (int i = 1; i < d; ++i) trace += stress[i][i];
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < i; ++j) stress[i][j] = stress[j][i];
    }
    const S even = node.density - 1.5 * trace;
    after[0] = Node::weight[0] * even;
    Node::for_each_pair([&](auto q) {
      S along[d];
      for (int i = 0; i < d; ++i) along[i] = Node::project(q, stress[i]);
      const S sum = even + 4.5 * Node::project(q, along), difference = 3.0 * Node::project(q, momentum);
      after[q] = Node::weight[q] * (sum + difference);
      after[Node::opposite[q]] = Node::weight[q] * (sum - difference);
    });
  }

 private:
  /// The velocities along the axes.
  template <class Node>
  static constexpr int axes[3] = {1, 2, Node::dimension == 3 ? 9 : 0};
};
ROULEAU_COLLISION(Regularised, "regularised", "1.0.0")
