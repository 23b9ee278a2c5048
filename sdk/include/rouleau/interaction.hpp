// Interaction potentials: a functor from distance to energy and force becomes a plugin.
#pragma once

#include "block.hpp"
#include "dispatch.hpp"
#include "model.hpp"
#include "state.hpp"

namespace rouleau {

/// What a potential returns for one distance.
template <class S>
struct Pair {
  S energy;                    ///< phi, per area
  S force;                     ///< -d phi / d distance, per area: positive repels
  S force_by_distance = S(0);  ///< d force / d distance, for steps that are implicit
};

namespace detail {

template <class Model>
struct InteractionLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const rouleau_interaction_block* block) {
    using S = Pack<double, register_bytes / 8>;
    const Model model = *static_cast<const Model*>(self);
    const std::uint32_t count = block->count;
    for (std::uint32_t first = 0; first < count; first += S::size) {
      const std::uint32_t valid = count - first < S::size ? count - first : S::size;
      static_assert(takes<Model, S, S>(),
                    "a potential takes a distance, and if it has state a rouleau::State<S, state_count>& and the time "
                    "step");
      const Pair<S> pair = evaluate<S>(model, *block, first, valid, take<S>(block->distance, first, valid));
      give(pair.energy, block->energy, first, valid);
      give(pair.force, block->force, first, valid);
      give(pair.force_by_distance, block->force_by_distance, first, valid);
    }
  }
};

}  // namespace detail

/// Model made of a type with a constructor from Parameters, `double cutoff() const`, and
/// `template <class S> Pair<S> operator()(S distance) const`; potentials that remember, such as bonds: see state.hpp.
template <class Model>
rouleau_model interaction(const char* id, const char* version) {
  static const rouleau_interaction table = {
      sizeof(rouleau_interaction), [](const void* self) { return static_cast<const Model*>(self)->cutoff(); },
      Dispatch<detail::InteractionLoop<Model>, const void*, const rouleau_interaction_block*>::pick()};
  rouleau_model model = detail::base_model<Model>(ROULEAU_INTERACTION_KIND, id, version);
  model.interaction = &table;
  return model;
}

}  // namespace rouleau

#define ROULEAU_INTERACTION(Type, id, version) ROULEAU_MODELS(rouleau::interaction<Type>(id, version))
