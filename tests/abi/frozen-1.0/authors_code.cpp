// Interface 1.0, kept as it was released: an author's source that uses all of the SDK's C++ layer. Never to be changed
// (README.md); it must compile with the SDK's headers of today, as C++17.
#include <rouleau/collision.hpp>
#include <rouleau/interaction.hpp>
#include <rouleau/membrane.hpp>
#include <stdexcept>

#if __cplusplus >= 202002L
#error "this file is to be compiled as C++17"
#endif

// An operator that derives its rates once for a block, and uses all that a node has.
struct Operator {
  double other;
  explicit Operator(const rouleau::Parameters& p) : other{p["other_rate"]} {
    if (p.setup().relaxation_rate <= 0) throw std::invalid_argument("the relaxation rate must be positive");
  }
  template <class S>
  struct Rates {
    S even, odd;
  };
  template <class S>
  Rates<S> rates(const S& relaxation_rate) const {
    return {relaxation_rate, S(other)};
  }
  template <class Node, class S>
  void operator()(const Node& node, const Rates<S>& rate, S (&after)[9]) const {
    after[0] = (1.0 - rate.even) * node.f[0] + node.even_gain(0, rate.even);
    rouleau::d2q9::for_each_pair([&](auto q) {
      constexpr int opposite = rouleau::d2q9::opposite[q];
      const S even = 0.5 * (1.0 - rate.even) * (node.f[q] + node.f[opposite]) + node.even_gain(q, rate.even);
      const S odd = 0.5 * (1.0 - rate.odd) * (node.f[q] - node.f[opposite]) + node.odd_gain(q, rate.odd);
      after[q] = even + odd;
      after[opposite] = even - odd;
    });
    if constexpr (Node::forced) after[0] = after[0] + 0.0 * (node.force[0] + node.force[1]);
    if constexpr (Node::inertia) after[0] = after[0] + 0.0 * node.density * (node.velocity[0] + node.velocity[1]);
  }
};

// One that relaxes all populations alike and takes the rate as it is.
struct PlainOperator {
  explicit PlainOperator(const rouleau::Parameters&) {}
  template <class Node, class S>
  void operator()(const Node& node, const S& relaxation_rate, S (&after)[9]) const {
    static_assert(rouleau::d2q9::velocity_count == 9 && rouleau::d2q9::sound_speed_squared > 0, "D2Q9");
    rouleau::d2q9::for_each_velocity([&](auto q) {
      after[q] = (1.0 - relaxation_rate) * node.f[q] + node.even_gain(q, relaxation_rate) +
                 node.odd_gain(q, relaxation_rate) + 0.0 * rouleau::d2q9::weight[q] * node.project(q, node.velocity);
    });
  }
};

struct Potential {
  double strength, range;
  explicit Potential(const rouleau::Parameters& p) : strength{p["strength"]}, range{p["range"]} {}
  double cutoff() const { return 10 * range; }
  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    const S near = select(r < S(range), range - r, S(0)), e = exp(-abs(r) / range);
    const S root = sqrt(max(near, S(0.0)) * min(near, S(1.0)));
    return {strength * e + 0.0 * root, strength / range * e, -strength / (range * range) * e};
  }
};

// Remembers; leaves the derivative out.
struct Bond {
  static constexpr int state_count = 2;
  double rate;
  explicit Bond(const rouleau::Parameters& p) : rate{p["rate"]} {}
  double cutoff() const { return 1; }
  template <class S>
  rouleau::Pair<S> operator()(const S& r, rouleau::State<S, 2>& state, double time_step) const {
    state[0] = state[0] + time_step * rate * (1.0 - state[0]);
    state[1] = state[1] + time_step;
    return {0.5 * state[0] * r * r, -state[0] * r};
  }
};

struct SegmentLaw {
  double modulus, viscosity;
  explicit SegmentLaw(const rouleau::Parameters& p) : modulus{p["modulus"]}, viscosity{p["viscosity"]} {}
  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    return {S(0.0), modulus * (segment.stretch - 1.0) + viscosity * segment.stretch_rate, S(modulus), S(viscosity)};
  }
  template <class S>
  S energy(const rouleau::Segment<S>& segment) const {
    return 0.5 * modulus * (segment.stretch - 1.0) * (segment.stretch - 1.0);
  }
};

struct Dashpot {
  static constexpr int state_count = 1;
  explicit Dashpot(const rouleau::Parameters&) {}
  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment, rouleau::State<S, 1>& state, double dt) const {
    state[0] = state[0] + dt * (segment.stretch - state[0]);
    return {S(0.0), segment.stretch - state[0]};
  }
};

struct VertexLaw {
  double modulus;
  explicit VertexLaw(const rouleau::Parameters& p) : modulus{p["modulus"]} {}
  template <class S>
  rouleau::Moment<S> operator()(const rouleau::Vertex<S>& vertex) const {
    const S change = vertex.curvature - vertex.rest_curvature;
    return {0.5 * modulus * change * change, modulus * change, S(modulus)};
  }
};

struct CellLaw {
  double modulus;
  explicit CellLaw(const rouleau::Parameters& p) : modulus{p["modulus"]} {}
  template <class S>
  rouleau::CellForces<S> operator()(const rouleau::Cell<S>& cell) const {
    const S excess = cell.area - cell.rest_area;
    return {0.5 * modulus * excess * excess, -modulus * excess, 0.0 * (cell.perimeter - cell.rest_perimeter)};
  }
};

ROULEAU_MODELS(rouleau::collision<Operator>("org.example.operator", "1.0.0"),
               rouleau::collision<PlainOperator>("org.example.plain-operator", "1.0.0"),
               rouleau::interaction<Potential>("org.example.potential", "1.0.0"),
               rouleau::interaction<Bond>("org.example.bond", "1.0.0"),
               rouleau::membrane<SegmentLaw>("org.example.segment", "1.0.0"),
               rouleau::membrane<Dashpot>("org.example.dashpot", "1.0.0"),
               rouleau::membrane<VertexLaw>("org.example.vertex", "1.0.0"),
               rouleau::membrane<CellLaw>("org.example.cell", "1.0.0"))
