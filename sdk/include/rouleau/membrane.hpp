// Membrane laws: a functor of one segment, one vertex or one whole cell, or its energy alone, becomes a plugin.
#pragma once

#include "block.hpp"
#include "dispatch.hpp"
#include "dual.hpp"
#include "model.hpp"
#include "state.hpp"

namespace rouleau {

/// One segment between two neighbouring nodes.
template <class S>
struct Segment {
  S stretch;       ///< length / rest length
  S stretch_rate;  ///< d stretch / dt
};
/// What a law of segments returns. One whose energy costs more than its force may leave it zero here and have a member
/// `energy(segment)` beside operator(), which is asked only when the host wants energies.
template <class S>
struct Tension {
  S energy;                     ///< per rest length
  S tension;                    ///< force along the segment, positive when it pulls its ends together
  S tension_by_stretch = S(0);  ///< for steps that are implicit
  /// Never negative. If the manifest's "gives" names it, the host takes this part of the tension implicitly: the law is
  /// stable at any viscosity and writes nothing but T(stretch, rate) and this derivative.
  S tension_by_rate = S(0);
};

/// One node with the half segments on both sides.
template <class S>
struct Vertex {
  S curvature;       ///< turning angle over rest length
  S rest_curvature;  ///< of the shape the cell was created with
};
/// What a law of vertices returns.
template <class S>
struct Moment {
  S energy;                      ///< per rest length
  S moment;                      ///< d energy / d curvature
  S moment_by_curvature = S(0);  ///< for steps that are implicit
};

/// One whole cell.
template <class S>
struct Cell {
  S area, rest_area;
  S perimeter, rest_perimeter;
};
/// What a law of cells returns.
template <class S>
struct CellForces {
  S energy;             ///< per cell
  S pressure;           ///< - d energy / d area: positive pushes outward
  S perimeter_tension;  ///< d energy / d perimeter
};

namespace detail {

template <class Model>
struct MembraneLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const rouleau_membrane_block* block) {
    using S = Pack<double, register_bytes / 8>;
    const Model model = *static_cast<const Model*>(self);
    for (std::uint32_t first = 0; first < block->count; first += S::size) {
      const std::uint32_t valid = block->count - first < S::size ? block->count - first : S::size;
      element<S>(model, *block, first, valid);
    }
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void element(const Model& model, const rouleau_membrane_block& block,
                                            std::uint32_t first, std::uint32_t valid) {
    if constexpr (takes<Model, S, Segment<S>>()) {
      const Segment<S> segment{take<S>(block.stretch, first, valid), take<S>(block.stretch_rate, first, valid)};
      const Tension<S> result = evaluate<S>(model, block, first, valid, segment);
      if constexpr (GivesEnergy<Model, Segment<S>>::value) {
        if (block.energy != nullptr) give(model.energy(segment), block.energy, first, valid);
      } else {
        give(result.energy, block.energy, first, valid);
      }
      give(result.tension, block.tension, first, valid);
      give(result.tension_by_stretch, block.tension_by_stretch, first, valid);
      give(result.tension_by_rate, block.tension_by_rate, first, valid);
    } else if constexpr (takes<Model, S, Vertex<S>>()) {
      const Moment<S> result =
          evaluate<S>(model, block, first, valid,
                      Vertex<S>{take<S>(block.curvature, first, valid), take<S>(block.rest_curvature, first, valid)});
      give(result.energy, block.energy, first, valid);
      give(result.moment, block.moment, first, valid);
      give(result.moment_by_curvature, block.moment_by_curvature, first, valid);
    } else if constexpr (takes<Model, S, Cell<S>>()) {
      const CellForces<S> result =
          evaluate<S>(model, block, first, valid,
                      Cell<S>{take<S>(block.area, first, valid), take<S>(block.rest_area, first, valid),
                              take<S>(block.perimeter, first, valid), take<S>(block.rest_perimeter, first, valid)});
      give(result.energy, block.energy, first, valid);
      give(result.pressure, block.pressure, first, valid);
      give(result.perimeter_tension, block.perimeter_tension, first, valid);
    } else {
      derived<S>(model, block, first, valid);
    }
  }

  /// A law of which only the energy is known.
  template <class S>
  ROULEAU_ALWAYS_INLINE static void derived(const Model& model, const rouleau_membrane_block& block,
                                            std::uint32_t first, std::uint32_t valid) {
    using D = Dual<S>;
    const auto constant = [&](const double* from) __attribute__((always_inline)) {
      return D::constant(take<S>(from, first, valid));
    };
    const auto argument = [&](const double* from) __attribute__((always_inline)) {
      return D::argument(take<S>(from, first, valid));
    };
    if constexpr (GivesEnergy<Model, Segment<D>>::value) {
      const D energy = model.energy(Segment<D>{argument(block.stretch), constant(block.stretch_rate)});
      give(energy.value, block.energy, first, valid);
      give(energy.first, block.tension, first, valid);
      give(energy.second, block.tension_by_stretch, first, valid);
    } else if constexpr (GivesEnergy<Model, Vertex<D>>::value) {
      const D energy = model.energy(Vertex<D>{argument(block.curvature), constant(block.rest_curvature)});
      give(energy.value, block.energy, first, valid);
      give(energy.first, block.moment, first, valid);
      give(energy.second, block.moment_by_curvature, first, valid);
    } else {
      static_assert(GivesEnergy<Model, Cell<D>>::value,
                    "a membrane law takes a rouleau::Segment<S>, a rouleau::Vertex<S> or a rouleau::Cell<S>, and if it "
                    "has state a rouleau::State<S, state_count>& and the time step; or it has energy() of one of them");
      const D rest_area = constant(block.rest_area), rest_perimeter = constant(block.rest_perimeter);
      const D by_area =
          model.energy(Cell<D>{argument(block.area), rest_area, constant(block.perimeter), rest_perimeter});
      const D by_perimeter =
          model.energy(Cell<D>{constant(block.area), rest_area, argument(block.perimeter), rest_perimeter});
      give(by_area.value, block.energy, first, valid);
      give(-by_area.first, block.pressure, first, valid);
      give(by_perimeter.first, block.perimeter_tension, first, valid);
    }
  }
};

}  // namespace detail

/// Model made of a type with a constructor from Parameters and a template operator() over the element it describes, or
/// `template <class S> S energy(const Segment<S>&) const` (or Vertex, or Cell) in its place, from which forces and
/// stiffness are derived (dual.hpp); laws that remember: see state.hpp.
template <class Model>
rouleau_model membrane(const char* id, const char* version) {
  static const rouleau_membrane table = {
      sizeof(rouleau_membrane),
      Dispatch<detail::MembraneLoop<Model>, const void*, const rouleau_membrane_block*>::pick()};
  rouleau_model model = detail::base_model<Model>(ROULEAU_MEMBRANE_KIND, id, version);
  model.membrane = &table;
  return model;
}

}  // namespace rouleau

#define ROULEAU_MEMBRANE(Type, id, version) ROULEAU_MODELS(rouleau::membrane<Type>(id, version))
