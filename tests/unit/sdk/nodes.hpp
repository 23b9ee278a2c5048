// Lattice nodes with random populations, and a collision applied to them in blocks of any size.
#pragma once

#include <rouleau/collision.hpp>

#include <array>
#include <cstring>
#include <random>
#include <vector>

namespace rouleau::test {

/// Arrays that begin one element after an allocation, so that no vector load of them is aligned.
template <class T>
class Unaligned {
 public:
  explicit Unaligned(std::size_t size = 0) : values_(size + 1) {}
  T* data() { return values_.data() + 1; }
  const T* data() const { return values_.data() + 1; }
  T& operator[](std::size_t i) { return values_[i + 1]; }
  const T& operator[](std::size_t i) const { return values_[i + 1]; }
  friend bool operator==(const Unaligned& a, const Unaligned& b) {
    // Bit for bit: two zeros of different sign are different here.
    return std::memcmp(a.data(), b.data(), (a.values_.size() - 1) * sizeof(T)) == 0;
  }

 private:
  std::vector<T> values_;
};

template <class T>
struct Nodes {
  explicit Nodes(std::size_t n) : count(n), rate(n) {
    f.fill(Unaligned<T>(n));
    force.fill(Unaligned<T>(n));
    velocity.fill(Unaligned<T>(n));
  }
  /// Deviations and forces as a flow at Mach numbers below 0.1 has them; rates from 0.3 to 1.9.
  static Nodes random(std::size_t n, unsigned seed) {
    Nodes nodes(n);
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> deviation(-0.01, 0.01), force(-1e-3, 1e-3), rate(0.3, 1.9);
    for (std::size_t x = 0; x < n; ++x) {
      for (auto& population : nodes.f) population[x] = static_cast<T>(deviation(engine));
      for (auto& component : nodes.force) component[x] = static_cast<T>(force(engine));
      nodes.rate[x] = static_cast<T>(rate(engine));
    }
    return nodes;
  }
  template <class U>
  Nodes<U> as() const {
    Nodes<U> other(count);
    for (std::size_t x = 0; x < count; ++x) {
      for (std::size_t q = 0; q < 9; ++q) other.f[q][x] = static_cast<U>(f[q][x]);
      for (std::size_t k = 0; k < 2; ++k) other.force[k][x] = static_cast<U>(force[k][x]);
      other.rate[x] = static_cast<U>(rate[x]);
    }
    return other;
  }

  std::size_t count;
  std::array<Unaligned<T>, 9> f;
  std::array<Unaligned<T>, 2> force, velocity;
  Unaligned<T> rate;
};

/// Where populations are put: into arrays of their own, over themselves, or over their opposites, as a lattice that
/// streams in place has it.
enum class Place { apart, same, opposite };

struct Collide {
  bool forced = true;
  bool own_rates = true;
  Place place = Place::apart;
  bool velocity_over_force = false;
  std::size_t block = 1 << 20;  ///< largest number of nodes in one call
};

/// The nodes after a collision; the velocity is that of the collision.
template <class T, class Function>
Nodes<T> collide(Function function, const void* self, Nodes<T> before, const Collide& how = {}) {
  const bool apart = how.place == Place::apart;
  const auto target_of = [&](std::size_t q) {
    return how.place == Place::opposite ? static_cast<std::size_t>(d2q9::opposite[q]) : q;
  };
  Nodes<T> after = apart ? before : Nodes<T>(0);
  Nodes<T>& target = apart ? after : before;
  for (std::size_t first = 0; first < before.count; first += how.block) {
    const T* in[9];
    T* out[9];
    const T* force[2];
    T* velocity[2];
    for (std::size_t q = 0; q < 9; ++q) {
      in[q] = before.f[q].data() + first;
      out[q] = target.f[target_of(q)].data() + first;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      force[k] = before.force[k].data() + first;
      velocity[k] = (how.velocity_over_force ? before.force[k].data() : target.velocity[k].data()) + first;
    }
    detail::CollisionBlock<T> block{};
    block.struct_size = sizeof block;
    block.count = static_cast<std::uint32_t>(std::min(how.block, before.count - first));
    block.in = in;
    block.out = out;
    block.force = how.forced ? force : nullptr;
    block.relaxation_rate = how.own_rates ? before.rate.data() + first : nullptr;
    block.velocity = velocity;
    function(self, &block);
  }
  if (how.velocity_over_force) target.velocity = before.force;
  if (apart) return after;
  auto populations = before.f;
  for (std::size_t q = 0; q < 9; ++q) before.f[q] = populations[target_of(q)];
  return before;
}

}  // namespace rouleau::test
