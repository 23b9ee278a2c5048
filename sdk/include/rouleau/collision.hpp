// Collision operators: a functor over the populations of one node, of D2Q9 or D3Q19, becomes a plugin.
//
// Moments and equilibrium follow He and Luo (J. Stat. Phys. 88, 1997) with reference density 1, forcing follows Guo,
// Zheng and Shi (Phys. Rev. E 65, 2002); without inertia the quadratic terms of both are left out (Stokes flow).
#pragma once

#include <algorithm>

#include "d2q9.hpp"
#include "d3q19.hpp"
#include "dispatch.hpp"
#include "model.hpp"

namespace rouleau {

/// One lattice node before collision. Populations are deviations from rest, f_q - w_q.
/// Forced and Inertia are compile-time facts, so that a formula pays only for what its node has.
template <class Set, class S, bool Forced, bool Inertia>
struct Node {
  static constexpr bool forced = Forced;
  static constexpr bool inertia = Inertia;

  /// D2Q9 or D3Q19: `velocity`, `weight`, `opposite` of each q.
  using VelocitySet = Set;
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  static constexpr const auto& weight = Set::weight;
  static constexpr const auto& opposite = Set::opposite;

  S f[velocity_count];
  S force[dimension];  ///< force density; not to be read unless forced

  S density;              ///< deviation from 1
  S momentum[dimension];  ///< sum f c, before the force has acted
  S velocity[dimension];  ///< momentum + force / 2

  /// Calls function(q) with every q, or with one of each pair of opposites, as a compile-time constant.
  template <class Function>
  ROULEAU_ALWAYS_INLINE static void for_each_velocity(Function&& function) {
    Set::for_each_velocity(std::forward<Function>(function));
  }
  template <class Function>
  ROULEAU_ALWAYS_INLINE static void for_each_pair(Function&& function) {
    Set::for_each_pair(std::forward<Function>(function));
  }

  /// Sets density, momentum and velocity from populations and force.
  ROULEAU_ALWAYS_INLINE void compute_moments() {
    // Sums and differences of opposite pairs: what operators that relax even and odd parts compute as well.
    if constexpr (dimension == 2) {
      const S rising = f[5] - f[7], falling = f[6] - f[8];
      density = f[0] + ((f[1] + f[3]) + (f[2] + f[4])) + ((f[5] + f[7]) + (f[6] + f[8]));
      momentum[0] = (f[1] - f[3]) + (rising - falling);
      momentum[1] = (f[2] - f[4]) + (rising + falling);
    } else {
      density = f[0];
      for (int k = 0; k < dimension; ++k) momentum[k] = S(0);
      for_each_pair([&](auto q) {
        density += f[q] + f[opposite[q]];
        const S difference = f[q] - f[opposite[q]];
        for (int k = 0; k < dimension; ++k) {
          if (Set::velocity[q][k] > 0) momentum[k] += difference;
          if (Set::velocity[q][k] < 0) momentum[k] -= difference;
        }
      });
    }
    for (int k = 0; k < dimension; ++k) {
      velocity[k] = momentum[k];
      if constexpr (Forced) velocity[k] += 0.5 * force[k];
    }
  }

  /// c_q . a for a vector a.
  ROULEAU_ALWAYS_INLINE static S project(int q, const S (&a)[dimension]) {
    S sum = S(0);
    bool first = true;
    for (int k = 0; k < dimension; ++k) {
      const int c = Set::velocity[q][k];
      if (c == 0) continue;
      if (first) {
        sum = c > 0 ? a[k] : -a[k];
      } else {
        sum = c > 0 ? sum + a[k] : sum - a[k];
      }
      first = false;
    }
    return sum;
  }
  /// a . b for vectors a and b.
  ROULEAU_ALWAYS_INLINE static S dot(const S (&a)[dimension], const S (&b)[dimension]) {
    if constexpr (dimension == 2) {
      return a[0] * b[0] + a[1] * b[1];
    } else {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
  }

  /// What relaxation at a rate adds to the part of f_q that is even under reversal of the velocity (the same for q and
  /// its opposite): rate f_eq + (1 - rate/2) S, with the even parts of equilibrium and of Guo's source.
  ROULEAU_ALWAYS_INLINE S even_gain(int q, const S& rate) const {
    S gain = rate * weight[q] * density;
    if constexpr (Inertia) {
      const S along = project(q, velocity);
      gain += rate * weight[q] * (4.5 * along * along - 1.5 * dot(velocity, velocity));
      if constexpr (Forced) {
        gain += (1.0 - 0.5 * rate) * weight[q] * (9.0 * along * project(q, force) - 3.0 * dot(velocity, force));
      }
    }
    return gain;
  }
  /// The same for the part that changes its sign with the velocity: 3 w_q c_q . (rate u + (1 - rate/2) F), in which the
  /// half force in u and that in Guo's factor cancel.
  ROULEAU_ALWAYS_INLINE S odd_gain(int q, const S& rate) const {
    if constexpr (Forced) {
      S gained[dimension];
      for (int k = 0; k < dimension; ++k) gained[k] = rate * momentum[k] + force[k];
      return odd_weight(q) * project(q, gained);
    } else {
      return odd_weight(q, rate) * project(q, momentum);
    }
  }

 private:
  /// 3 w_q as S holds it, and rate times that. The momentum that all q take up is rate u, exactly: in single precision
  /// the velocities of one length have 2/3 of it, rounded, and those of the other what is left. With 1/3 and 1/12
  /// rounded on their own a fluid gains 3e-8 to 6e-8 of its momentum in each step, and the stress on the walls of a
  /// channel that is 128 nodes high sinks by 3e-4 to 5e-4.
  static constexpr bool exact = sizeof(typename S::Number) == 4;
  static constexpr int major = dimension == 2 ? 1 : 5;  ///< a velocity that has more of it: along an axis, between two
  static constexpr double majors = dimension == 2 ? 2 : 8,
                          minors = dimension == 2 ? 4 : 2;  ///< velocities with c_x != 0
  static constexpr double odd_weight(int q) {
    if (!exact) return 3.0 * weight[q];
    const auto of_major = static_cast<float>(3.0 * weight[major]);
    return weight[q] == weight[major] ? of_major : (1 - majors * of_major) / minors;
  }
  ROULEAU_ALWAYS_INLINE static S odd_weight(int q, const S& rate) {
    const S of_major = rate * (3.0 * weight[exact ? major : q]);
    return !exact || weight[q] == weight[major] ? of_major : (rate - majors * of_major) * (1 / minors);
  }
};

namespace detail {

/// What an operator makes of the relaxation rate before it sees a node: its rates(), or the rate itself.
template <class Model, class S>
ROULEAU_ALWAYS_INLINE auto derived_rates(const Model& model, const S& relaxation_rate, int)
    -> decltype(model.rates(relaxation_rate)) {
  return model.rates(relaxation_rate);
}
template <class Model, class S>
ROULEAU_ALWAYS_INLINE S derived_rates(const Model&, const S& relaxation_rate, long) {
  return relaxation_rate;
}

/// C block of either precision.
template <class T>
using CollisionBlock = std::conditional_t<sizeof(T) == 8, rouleau_collision_block_f64, rouleau_collision_block_f32>;

/// Whether an operator is written for a velocity set: `S (&after)[9]` in its signature says D2Q9 alone, `S
/// (&after)[Node::velocity_count]` any.
template <class Model, class Set>
constexpr bool knows() {
  using S = Pack<double, 1>;
  using Rates = decltype(derived_rates(std::declval<const Model&>(), std::declval<const S&>(), 0));
  return std::is_invocable_v<const Model&, const Node<Set, S, false, false>&, const Rates&, S(&)[Set::velocity_count]>;
}

/// What a collision instance holds: the author's operator and what the loop needs of the setup.
template <class Model>
struct CollisionInstance {
  explicit CollisionInstance(const Parameters& parameters)
      : dimension(known_dimension(parameters.setup())),
        model(parameters),
        relaxation_rate(parameters.setup().relaxation_rate),
        inertia(parameters.setup().inertia != 0) {}
  int dimension;
  Model model;
  double relaxation_rate;
  bool inertia;

 private:
  template <class Set>
  static bool is(const rouleau_setup& setup) {
    return knows<Model, Set>() && setup.dimension == Set::dimension && setup.velocity_count == Set::velocity_count;
  }
  static int known_dimension(const rouleau_setup& setup) {
    if (is<D2Q9>(setup) || is<D3Q19>(setup)) return static_cast<int>(setup.dimension);
    throw std::invalid_argument(knows<Model, D3Q19>() ? "this operator is written for D2Q9 and D3Q19"
                                                      : "this operator is written for D2Q9");
  }
};

/// The number itself, of which the compiler is to know nothing.
ROULEAU_ALWAYS_INLINE std::size_t unknown(std::size_t number) {
  asm("" : "+r"(number));  // NOLINT(hicpp-no-assembler)
  return number;
}

/// What a sweep does besides colliding: each is compiled, so that a node pays only for what its block has.
enum class Force { none, acts, acts_and_velocity };

/// The whole packs of a block. A function of its own for each: in one large function there are too few registers for
/// the loop that runs.
template <class Set, class Model, class T, Force force, bool Varying, bool Inertia>
struct CollisionSweep {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const CollisionInstance<Model>* of, const CollisionBlock<T>* nodes) {
    const auto& instance = *of;
    const auto& block = *nodes;
    constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
    constexpr bool forced = force != Force::none, velocity = force == Force::acts_and_velocity;
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    using S = Pack<T, width>;
    const Model model = instance.model;
    const std::uint32_t count = block.count / width * width;
    // Copies: what is stored below could be these pointers, for all the compiler knows.
    T* at[velocity_count];  // of q before, and of its opposite after the collision
    const T* from[dimension];
    T* to[dimension];
    Set::for_each_velocity([&](auto q) { at[Set::opposite[q]] = block.out[q]; });
    // What a block lacks, in the one sweep of three dimensions that serves all.
    constexpr bool whole = dimension == 2 || !Varying;
    T none[width] = {}, uniform_rate[width], unread[width];
    S(instance.relaxation_rate).store(uniform_rate);
    const bool has_force = whole || block.force != nullptr;
    const bool has_velocity = whole || block.velocity != nullptr;
    const bool has_rate = whole || block.relaxation_rate != nullptr;
    for (int k = 0; k < dimension; ++k) {
      from[k] = !forced ? nullptr : (has_force ? block.force[k] : none);
      to[k] = !velocity ? nullptr : (has_velocity ? block.velocity[k] : unread);
    }
    const T* const rate = !Varying ? nullptr : (has_rate ? block.relaxation_rate : uniform_rate);
    const auto uniform = derived_rates(model, S(instance.relaxation_rate), 0);
    for (std::size_t x = 0; x < count; x += width) {
      Node<Set, S, forced, Inertia> node;
      Set::for_each_velocity([&](auto q) { node.f[q] = S::load(at[q] + x); });
      if constexpr (forced) {
#pragma GCC unroll 3
        for (int k = 0; k < dimension; ++k) node.force[k] = S::load(from[k] + (has_force ? x : 0));
      }
      node.compute_moments();
      if constexpr (velocity) {
#pragma GCC unroll 3
        for (int k = 0; k < dimension; ++k) node.velocity[k].store(to[k] + (has_velocity ? x : 0));
        // Here and not among the populations, which leaves more registers to the rest, of which three dimensions have
        // few.
        if constexpr (dimension == 3) asm volatile("" ::: "memory");  // NOLINT(hicpp-no-assembler)
      }
      S after[velocity_count];
      if constexpr (Varying) {
        model(node, derived_rates(model, S::load(rate + (has_rate ? x : 0)), 0), after);
      } else {
        model(node, uniform, after);
      }
      // As if another number: sums of pointer and x would be kept from above, for which there are no registers.
      const std::size_t there = unknown(x);
      Set::for_each_velocity([&](auto q) { after[q].store(at[Set::opposite[q]] + there); });
    }
  }
};

template <class Model, class T>
struct CollisionLoop;

/// The loop on one velocity set.
template <class Set, class Model, class T>
struct CollisionLoopOn {
  using Block = CollisionBlock<T>;
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;

  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const Block* block) {
    const auto& instance = *static_cast<const CollisionInstance<Model>*>(self);
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    const std::uint32_t whole = in_place(*block) ? block->count / width * width : 0;
    if (whole != 0) choose<register_bytes>(instance, *block);
    if (whole != block->count) collide_padded<register_bytes>(instance, *block, whole);
  }

 private:
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void choose(const CollisionInstance<Model>& instance, const Block& block) {
    if (instance.inertia)
      choose<register_bytes, true>(instance, block);
    else
      choose<register_bytes, false>(instance, block);
  }
  template <int register_bytes, bool Inertia>
  ROULEAU_ALWAYS_INLINE static void choose(const CollisionInstance<Model>& instance, const Block& block) {
    if constexpr (dimension == 3) return choose_of_three<register_bytes, Inertia>(instance, block);
    if (block.force == nullptr) {
      if (block.velocity != nullptr) write_velocity<register_bytes>(block);
      choose<register_bytes, Inertia, Force::none>(instance, block);
    } else if (block.velocity == nullptr) {
      choose<register_bytes, Inertia, Force::acts>(instance, block);
    } else {
      choose<register_bytes, Inertia, Force::acts_and_velocity>(instance, block);
    }
  }
  template <int register_bytes, bool Inertia, Force force>
  ROULEAU_ALWAYS_INLINE static void choose(const CollisionInstance<Model>& instance, const Block& block) {
    if (block.relaxation_rate != nullptr) {
      sweep<register_bytes, force, true, Inertia>(instance, block);
    } else {
      sweep<register_bytes, force, false, Inertia>(instance, block);
    }
  }

  /// Three dimensions have four sweeps and not six, since a compiler needs long for each: those with one viscosity, and
  /// one with a relaxation rate for each node, where what a block lacks is read from, and written to, a pack of the
  /// sweep's own. The baseline has the last one only.
  template <int register_bytes, bool Inertia>
  ROULEAU_ALWAYS_INLINE static void choose_of_three(const CollisionInstance<Model>& instance, const Block& block) {
    if constexpr (register_bytes != static_cast<int>(InstructionSet::baseline)) {
      if (block.relaxation_rate == nullptr && (block.force != nullptr || block.velocity == nullptr)) {
        if (block.force == nullptr) return sweep<register_bytes, Force::none, false, Inertia>(instance, block);
        if (block.velocity == nullptr) return sweep<register_bytes, Force::acts, false, Inertia>(instance, block);
        return sweep<register_bytes, Force::acts_and_velocity, false, Inertia>(instance, block);
      }
    }
    sweep<register_bytes, Force::acts_and_velocity, true, Inertia>(instance, block);
  }

  template <int register_bytes, Force force, bool Varying, bool Inertia>
  ROULEAU_ALWAYS_INLINE static void sweep(const CollisionInstance<Model>& instance, const Block& block) {
    using Sweep = CollisionSweep<Set, Model, T, force, Varying, Inertia>;
    Dispatch<Sweep, const CollisionInstance<Model>*, const Block*>::template variant<register_bytes>()(&instance,
                                                                                                       &block);
  }

  /// Velocity of nodes without a force, before their populations are overwritten: a host seldom asks for it.
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void write_velocity(const Block& block) {
    for (std::uint32_t x = 0; x < block.count; ++x) {
      Node<Set, Pack<T, 1>, false, false> node;
      Set::for_each_velocity([&](auto q) { node.f[q] = Pack<T, 1>::load(block.in[q] + x); });
      node.compute_moments();
      for (int k = 0; k < dimension; ++k) node.velocity[k].store(block.velocity[k] + x);
    }
  }

  /// Whether what leaves a node lies where its opposite came from, as where a lattice streams in place: then half as
  /// many pointers are read.
  ROULEAU_ALWAYS_INLINE static bool in_place(const Block& block) {
    std::uintptr_t apart = 0;
    Set::for_each_velocity([&](auto q) {
      apart |=
          reinterpret_cast<std::uintptr_t>(block.out[q]) ^ reinterpret_cast<std::uintptr_t>(block.in[Set::opposite[q]]);
    });
    return apart == 0;
  }

  /// Nodes from the first one on, pack by pack, by way of copies that lie in place. The last pack is padded: all nodes
  /// run through the same code, so that a node's bits do not depend on its place.
  template <int register_bytes>
  __attribute__((noinline)) static void collide_padded(const CollisionInstance<Model>& instance, const Block& block,
                                                       std::uint32_t first) {
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    T values[velocity_count + 2 * dimension + 1][width];
    const T *in[velocity_count], *force[dimension];
    T *out[velocity_count], *velocity[dimension];
    T(&rates)[width] = values[velocity_count + 2 * dimension];
    Block padded{};  // not a copy: an older host's block may be smaller than this struct
    padded.struct_size = sizeof padded;
    padded.count = width;
    padded.in = in, padded.out = out;
    for (int q = 0; q < velocity_count; ++q) in[q] = values[q], out[q] = values[Set::opposite[q]];
    for (int k = 0; k < dimension; ++k)
      force[k] = values[velocity_count + k], velocity[k] = values[velocity_count + dimension + k];
    if (block.force != nullptr) padded.force = force;
    if (block.velocity != nullptr) padded.velocity = velocity;
    if (block.relaxation_rate != nullptr) padded.relaxation_rate = rates;
    for (; first < block.count; first += width) {
      const std::uint32_t count = std::min(width, block.count - first);
      const auto copy = [&](const T* from, T(&to)[width]) {
        for (std::uint32_t i = 0; i < width; ++i) to[i] = from[first + (i < count ? i : 0)];
      };
      for (int q = 0; q < velocity_count; ++q) copy(block.in[q], values[q]);
      for (int k = 0; k < dimension && block.force != nullptr; ++k) copy(block.force[k], values[velocity_count + k]);
      if (block.relaxation_rate != nullptr) copy(block.relaxation_rate, rates);
      choose<register_bytes>(instance, padded);
      for (int q = 0; q < velocity_count; ++q) std::copy_n(out[q], count, block.out[q] + first);
      for (int k = 0; k < dimension && block.velocity != nullptr; ++k)
        std::copy_n(velocity[k], count, block.velocity[k] + first);
    }
  }
};

/// The loop of an operator, on the velocity set of its setup.
template <class Model, class T>
struct CollisionLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const CollisionBlock<T>* block) {
    if constexpr (knows<Model, D3Q19>()) {
      if (static_cast<const CollisionInstance<Model>*>(self)->dimension == 3) {
        return CollisionLoopOn<D3Q19, Model, T>::template run<register_bytes>(self, block);
      }
    }
    if constexpr (knows<Model, D2Q9>()) CollisionLoopOn<D2Q9, Model, T>::template run<register_bytes>(self, block);
  }
};

}  // namespace detail

/// Model made of a type with a constructor from Parameters and
/// `template <class Node, class S, class Rates> void operator()(const Node& before, const Rates& rates, S
/// (&after)[Node::velocity_count]) const`: then it works on D2Q9 and D3Q19, with `S (&after)[9]` on D2Q9 alone; the
/// manifest's "lattices" has to say so. The rates are what the member `template <class S> Rates<S> rates(const S&
/// relaxation_rate) const` makes of 1/tau of the shear stress, or 1/tau itself if there is no such member: once for a
/// block where the viscosity is the same everywhere.
template <class Model>
rouleau_model collision(const char* id, const char* version) {
  static const rouleau_collision table = {
      sizeof(rouleau_collision),
      Dispatch<detail::CollisionLoop<Model, double>, const void*, const rouleau_collision_block_f64*>::pick(),
      Dispatch<detail::CollisionLoop<Model, float>, const void*, const rouleau_collision_block_f32*>::pick()};
  rouleau_model model = detail::base_model<detail::CollisionInstance<Model>>(ROULEAU_COLLISION_KIND, id, version);
  model.collision = &table;
  return model;
}

}  // namespace rouleau

#define ROULEAU_COLLISION(Type, id, version) ROULEAU_MODELS(rouleau::collision<Type>(id, version))
