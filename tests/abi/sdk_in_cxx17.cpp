// The header-only layer compiles in C++17, which is all that authors of plugins need.
#include <rouleau/collision.hpp>
#include <rouleau/interaction.hpp>
#include <rouleau/membrane.hpp>

#if __cplusplus >= 202002L
#error "this file is to be compiled as C++17"
#endif

struct Relaxation {
  explicit Relaxation(const rouleau::Parameters&) {}
  template <class Node, class S>
  void operator()(const Node& node, const S& /*relaxation_rate*/, S (&after)[9]) const {
    rouleau::d2q9::for_each_velocity([&](auto q) { after[q] = node.f[q]; });
  }
};

struct Repulsion {
  double strength;
  explicit Repulsion(const rouleau::Parameters& p) : strength{p["strength"]} {}
  double cutoff() const { return 1; }
  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    return {strength * exp(-r), strength * exp(-r)};
  }
};

struct Tether {
  double strength;
  explicit Tether(const rouleau::Parameters& p) : strength{p["strength"]} {}
  template <class S>
  rouleau::CellForces<S> operator()(const rouleau::Cell<S>& cell) const {
    const S change = cell.area - cell.rest_area;
    return {0.5 * strength * change * change, -strength * change, S(0)};
  }
};

struct Fatigue {
  static constexpr int state_count = 2;
  explicit Fatigue(const rouleau::Parameters&) {}
  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment, rouleau::State<S, 2>& state, double dt) const {
    state[0] = state[0] + dt * segment.stretch;
    return {S(0), state[0] - state[1]};
  }
};

ROULEAU_MODELS(rouleau::collision<Relaxation>("relaxation", "1.0.0"),
               rouleau::interaction<Repulsion>("repulsion", "1.0.0"), rouleau::membrane<Tether>("tether", "1.0.0"),
               rouleau::membrane<Fatigue>("fatigue", "1.0.0"))
