// Collision operators: a functor over the nine populations of one node becomes a plugin.
//
// Moments and equilibrium follow He and Luo (J. Stat. Phys. 88, 1997) with reference density 1, forcing follows Guo,
// Zheng and Shi (Phys. Rev. E 65, 2002); without inertia the quadratic terms of both are left out (Stokes flow).
#pragma once

#include "d2q9.hpp"
#include "dispatch.hpp"
#include "model.hpp"

namespace rouleau {

/// One lattice node before collision. Populations are deviations from rest, f_q - w_q.
/// Forced and Inertia are compile-time facts, so that a formula pays only for what its node has.
template <class S, bool Forced, bool Inertia>
struct Node {
  static constexpr bool forced = Forced;
  static constexpr bool inertia = Inertia;

  S f[9];
  S force[2];  ///< force density; not to be read unless forced

  S density;      ///< deviation from 1
  S momentum[2];  ///< sum f c, before the force has acted
  S velocity[2];  ///< momentum + force / 2

  /// Sets density, momentum and velocity from populations and force.
  ROULEAU_ALWAYS_INLINE void compute_moments() {
    // Sums and differences of opposite pairs: what operators that relax even and odd parts compute as well.
    const S rising = f[5] - f[7], falling = f[6] - f[8];
    density = f[0] + ((f[1] + f[3]) + (f[2] + f[4])) + ((f[5] + f[7]) + (f[6] + f[8]));
    momentum[0] = (f[1] - f[3]) + (rising - falling);
    momentum[1] = (f[2] - f[4]) + (rising + falling);
    for (int k = 0; k < 2; ++k) {
      velocity[k] = momentum[k];
      if constexpr (Forced) velocity[k] += 0.5 * force[k];
    }
  }

  /// c_q . a for a vector a.
  ROULEAU_ALWAYS_INLINE static S project(int q, const S (&a)[2]) {
    switch (q) {
      case 1:
        return a[0];
      case 2:
        return a[1];
      case 3:
        return -a[0];
      case 4:
        return -a[1];
      case 5:
        return a[0] + a[1];
      case 6:
        return a[1] - a[0];
      case 7:
        return -(a[0] + a[1]);
      case 8:
        return a[0] - a[1];
      default:
        return S(0);
    }
  }

  /// What relaxation at a rate adds to the part of f_q that is even under reversal of the velocity (the same for q and
  /// its opposite): rate f_eq + (1 - rate/2) S, with the even parts of equilibrium and of Guo's source.
  ROULEAU_ALWAYS_INLINE S even_gain(int q, const S& rate) const {
    S gain = rate * d2q9::weight[q] * density;
    if constexpr (Inertia) {
      const S along = project(q, velocity);
      gain += rate * d2q9::weight[q] *
              (4.5 * along * along - 1.5 * (velocity[0] * velocity[0] + velocity[1] * velocity[1]));
      if constexpr (Forced) {
        gain += (1.0 - 0.5 * rate) * d2q9::weight[q] *
                (9.0 * along * project(q, force) - 3.0 * (velocity[0] * force[0] + velocity[1] * force[1]));
      }
    }
    return gain;
  }
  /// The same for the part that changes its sign with the velocity: 3 w_q c_q . (rate u + (1 - rate/2) F), in which the
  /// half force in u and that in Guo's factor cancel.
  ROULEAU_ALWAYS_INLINE S odd_gain(int q, const S& rate) const {
    if constexpr (Forced) {
      const S gained[2] = {rate * momentum[0] + force[0], rate * momentum[1] + force[1]};
      return 3.0 * d2q9::weight[q] * project(q, gained);
    } else {
      return rate * (3.0 * d2q9::weight[q]) * project(q, momentum);
    }
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

/// What a collision instance holds: the author's operator and what the loop needs of the setup.
template <class Model>
struct CollisionInstance {
  explicit CollisionInstance(const Parameters& parameters)
      : model(parameters),
        relaxation_rate(parameters.setup().relaxation_rate),
        inertia(parameters.setup().inertia != 0) {
    if (parameters.setup().dimension != 2 || parameters.setup().velocity_count != 9) {
      throw std::invalid_argument("this operator is written for D2Q9");
    }
  }
  Model model;
  double relaxation_rate;
  bool inertia;
};

template <class Model, class T>
struct CollisionLoop {
  using Block = CollisionBlock<T>;

  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const Block* block) {
    const auto& instance = *static_cast<const CollisionInstance<Model>*>(self);
    if (instance.inertia)
      choose<register_bytes, true>(instance, *block);
    else
      choose<register_bytes, false>(instance, *block);
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    if (block->count % width != 0) collide_rest<register_bytes>(self, *block, block->count % width);
  }

 private:
  /// What a sweep does besides colliding: each is compiled, so that a node pays only for what its block has.
  enum class Force { none, acts, acts_and_velocity };

  template <int register_bytes, bool Inertia>
  ROULEAU_ALWAYS_INLINE static void choose(const CollisionInstance<Model>& instance, const Block& block) {
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

  /// Velocity of nodes without a force, before their populations are overwritten: a host seldom asks for it.
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void write_velocity(const Block& block) {
    for (std::uint32_t x = 0; x < block.count; ++x) {
      Node<Pack<T, 1>, false, false> node;
      d2q9::for_each_velocity([&](auto q) { node.f[q] = Pack<T, 1>::load(block.in[q] + x); });
      node.compute_moments();
      for (int k = 0; k < 2; ++k) node.velocity[k].store(block.velocity[k] + x);
    }
  }

  /// The whole packs of a block.
  template <int register_bytes, Force force, bool Varying, bool Inertia>
  ROULEAU_ALWAYS_INLINE static void sweep(const CollisionInstance<Model>& instance, const Block& block) {
    constexpr bool forced = force != Force::none, velocity = force == Force::acts_and_velocity;
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    using S = Pack<T, width>;
    const Model model = instance.model;
    const std::uint32_t count = block.count / width * width;
    // Copies: what is stored below could be these pointers, for all the compiler knows.
    const T *in[9], *from[2];
    T *out[9], *to[2];
    d2q9::for_each_velocity([&](auto q) { in[q] = block.in[q], out[q] = block.out[q]; });
    for (int k = 0; k < 2; ++k) {
      from[k] = forced ? block.force[k] : nullptr;
      to[k] = velocity ? block.velocity[k] : nullptr;
    }
    const T* const rate = Varying ? block.relaxation_rate : nullptr;
    const auto uniform = derived_rates(model, S(instance.relaxation_rate), 0);
    for (std::uint32_t x = 0; x < count; x += width) {
      Node<S, forced, Inertia> node;
      d2q9::for_each_velocity([&](auto q) { node.f[q] = S::load(in[q] + x); });
      if constexpr (forced) {
        node.force[0] = S::load(from[0] + x);
        node.force[1] = S::load(from[1] + x);
      }
      node.compute_moments();
      if constexpr (velocity) {
        node.velocity[0].store(to[0] + x);
        node.velocity[1].store(to[1] + x);
      }
      S after[9];
      if constexpr (Varying) {
        model(node, derived_rates(model, S::load(rate + x), 0), after);
      } else {
        model(node, uniform, after);
      }
      d2q9::for_each_velocity([&](auto q) { after[q].store(out[q] + x); });
    }
  }

  /// The last nodes of a block that do not fill a pack: padded to one, they run through the same code, so that a node's
  /// bits do not depend on its place.
  template <int register_bytes>
  __attribute__((noinline)) static void collide_rest(const void* self, const Block& block, std::uint32_t rest) {
    constexpr std::uint32_t width = register_bytes / sizeof(T);
    const std::uint32_t first = block.count - rest;
    T values[14][width];
    const T *in[9], *force[2];
    T *out[9], *velocity[2];
    const auto copy = [&](const T* from, T(&to)[width]) {
      for (std::uint32_t i = 0; i < width; ++i) to[i] = from[first + (i < rest ? i : 0)];
      return to;
    };
    Block padded{};  // not a copy: an older host's block may be smaller than this struct
    padded.struct_size = sizeof padded;
    padded.count = width;
    for (int q = 0; q < 9; ++q) in[q] = out[q] = copy(block.in[q], values[q]);
    padded.in = in;
    padded.out = out;
    for (int k = 0; k < 2; ++k) {
      if (block.force != nullptr) force[k] = copy(block.force[k], values[9 + k]);
      velocity[k] = values[11 + k];
    }
    if (block.force != nullptr) padded.force = force;
    if (block.relaxation_rate != nullptr) padded.relaxation_rate = copy(block.relaxation_rate, values[13]);
    if (block.velocity != nullptr) padded.velocity = velocity;
    Dispatch<CollisionLoop, const void*, const Block*>::template variant<register_bytes>()(self, &padded);
    for (std::uint32_t i = 0; i < rest; ++i) {
      for (int q = 0; q < 9; ++q) block.out[q][first + i] = values[q][i];
      for (int k = 0; k < 2 && block.velocity != nullptr; ++k) block.velocity[k][first + i] = velocity[k][i];
    }
  }
};

}  // namespace detail

/// Model made of a type with a constructor from Parameters and
/// `template <class Node, class S, class Rates> void operator()(const Node& before, const Rates& rates, S (&after)[9])
/// const`. The rates are what the member `template <class S> Rates<S> rates(const S& relaxation_rate) const` makes of
/// 1/tau of the shear stress, or 1/tau itself if there is no such member: once for a block where the viscosity is the
/// same everywhere.
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
