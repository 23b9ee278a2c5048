// Membrane laws: a functor of one segment, triangle, vertex or whole cell, or its energy alone, becomes a plugin.
// In three dimensions membranes are surfaces of triangles; a law of both dimensions has a functor for each.
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

/// One triangle against its rest shape, in three dimensions. With the stretches l1 and l2 along the principal axes:
template <class S>
struct Triangle {
  S invariant_1;                         ///< I1 = l1^2 + l2^2 - 2
  S invariant_2;                         ///< I2 = l1^2 l2^2 - 1: (area / rest area)^2 - 1
  S invariant_1_rate, invariant_2_rate;  ///< d/dt
};
/// What a law of triangles returns.
template <class S>
struct Stress {
  S energy;                                                            ///< per rest area
  S stress_1, stress_2;                                                ///< d energy / d I1, d energy / d I2
  S stress_1_by_1 = S(0), stress_1_by_2 = S(0), stress_2_by_2 = S(0);  ///< for steps that are implicit
  /// Of the surface, never negative. If the manifest's "gives" names them the host adds the stress 2 m (D - tr D/2) + k
  /// tr D of the rate of strain D, by a step that is stable at any viscosity.
  S shear_viscosity = S(0), area_viscosity = S(0);
};

/// One node: in two dimensions with the half segments on both sides, in three with the area that belongs to it.
template <class S>
struct Vertex {
  S curvature;       ///< turning angle over rest length; in three dimensions the sum of both principal curvatures
  S rest_curvature;  ///< of the shape the cell was created with
};
/// What a law of vertices returns.
template <class S>
struct Moment {
  S energy;                      ///< per rest length; in three dimensions per rest area
  S moment;                      ///< d energy / d curvature
  S moment_by_curvature = S(0);  ///< for steps that are implicit
};

/// One node's surface, in three dimensions.
template <class S>
struct Patch {
  S area_ratio;  ///< area / rest area
};
/// What a law of patches returns.
template <class S>
struct PatchTension {
  S energy;                        ///< per rest area
  S area_tension;                  ///< d energy / d area_ratio
  S area_tension_by_ratio = S(0);  ///< for steps that are implicit
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

/// One whole cell in three dimensions.
template <class S>
struct Body {
  S volume, rest_volume;
  S surface_area, rest_surface_area;
};
/// What a law of bodies returns.
template <class S>
struct BodyForces {
  S energy;           ///< per cell
  S pressure;         ///< - d energy / d volume: positive pushes outward
  S surface_tension;  ///< d energy / d surface_area
};

namespace detail {

/// Whether a block is of a surface in three dimensions. A host of interface 1.0 has none.
inline bool is_of_surface(const rouleau_membrane_block& block) {
  constexpr std::size_t end = offsetof(rouleau_membrane_block, surface_area) + sizeof(block.surface_area);
  if (!has_field(block.struct_size, end)) return false;
  for (const double* input : {block.invariant_1, block.invariant_2, block.invariant_1_rate, block.invariant_2_rate,
                              block.area_ratio, block.volume, block.surface_area}) {
    if (input != nullptr) return true;
  }
  constexpr std::size_t last = offsetof(rouleau_membrane_block, area_viscosity) + sizeof(block.area_viscosity);
  return has_field(block.struct_size, last) && (block.shear_viscosity != nullptr || block.area_viscosity != nullptr);
}

template <class Model>
struct MembraneLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const void* self, const rouleau_membrane_block* block) {
    using S = Pack<double, register_bytes / 8>;
    const Model model = *static_cast<const Model*>(self);
    if constexpr (in_3d<S>()) {
      if (!in_2d<S>() || is_of_surface(*block)) {
        for (std::uint32_t first = 0; first < block->count; first += S::size) {
          of_surface<S>(model, *block, first, valid<S>(*block, first));
        }
        return;
      }
    }
    if constexpr (in_2d<S>() || !in_3d<S>()) {
      for (std::uint32_t first = 0; first < block->count; first += S::size) {
        of_outline<S>(model, *block, first, valid<S>(*block, first));
      }
    }
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static std::uint32_t valid(const rouleau_membrane_block& block, std::uint32_t first) {
    return block.count - first < S::size ? block.count - first : S::size;
  }

  /// Whether the model has a functor, or an energy, of an element that only one dimension has. Vertices have no
  /// dimension.
  template <class S>
  static constexpr bool in_3d() {
    using D = Dual<S>;
    return takes<Model, S, Triangle<S>>() || takes<Model, S, Patch<S>>() || takes<Model, S, Body<S>>() ||
           GivesEnergy<Model, Triangle<D>>::value || GivesEnergy<Model, Patch<D>>::value ||
           GivesEnergy<Model, Body<D>>::value;
  }
  template <class S>
  static constexpr bool in_2d() {
    using D = Dual<S>;
    return takes<Model, S, Segment<S>>() || takes<Model, S, Cell<S>>() || GivesEnergy<Model, Segment<D>>::value ||
           GivesEnergy<Model, Cell<D>>::value;
  }

  template <class S>
  ROULEAU_ALWAYS_INLINE static void of_surface(const Model& model, const rouleau_membrane_block& block,
                                               std::uint32_t first, std::uint32_t valid) {
    if constexpr (takes<Model, S, Triangle<S>>()) {
      const Stress<S> result = evaluate<S>(
          model, block, first, valid,
          Triangle<S>{take<S>(block.invariant_1, first, valid), take<S>(block.invariant_2, first, valid),
                      take<S>(block.invariant_1_rate, first, valid), take<S>(block.invariant_2_rate, first, valid)});
      give(result.energy, block.energy, first, valid);
      give(result.stress_1, block.stress_1, first, valid);
      give(result.stress_2, block.stress_2, first, valid);
      give(result.stress_1_by_1, block.stress_1_by_1, first, valid);
      give(result.stress_1_by_2, block.stress_1_by_2, first, valid);
      give(result.stress_2_by_2, block.stress_2_by_2, first, valid);
      give(result.shear_viscosity, block.shear_viscosity, first, valid);
      give(result.area_viscosity, block.area_viscosity, first, valid);
    } else if constexpr (takes<Model, S, Patch<S>>()) {
      const PatchTension<S> result =
          evaluate<S>(model, block, first, valid, Patch<S>{take<S>(block.area_ratio, first, valid)});
      give(result.energy, block.energy, first, valid);
      give(result.area_tension, block.area_tension, first, valid);
      give(result.area_tension_by_ratio, block.area_tension_by_ratio, first, valid);
    } else if constexpr (takes<Model, S, Body<S>>()) {
      const BodyForces<S> result = evaluate<S>(
          model, block, first, valid,
          Body<S>{take<S>(block.volume, first, valid), take<S>(block.rest_volume, first, valid),
                  take<S>(block.surface_area, first, valid), take<S>(block.rest_surface_area, first, valid)});
      give(result.energy, block.energy, first, valid);
      give(result.pressure, block.pressure, first, valid);
      give(result.surface_tension, block.surface_tension, first, valid);
    } else {
      derived_of_surface<S>(model, block, first, valid);
    }
  }

  template <class S>
  ROULEAU_ALWAYS_INLINE static void of_outline(const Model& model, const rouleau_membrane_block& block,
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
                    "a membrane law takes a rouleau::Segment<S>, Triangle<S>, Vertex<S>, Patch<S>, Cell<S> or Body<S>, "
                    "and if it has state a rouleau::State<S, state_count>& and the time step; or it has energy() of "
                    "one of them");
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

  template <class S>
  ROULEAU_ALWAYS_INLINE static void derived_of_surface(const Model& model, const rouleau_membrane_block& block,
                                                       std::uint32_t first, std::uint32_t valid) {
    using D = Dual<S>;
    // What the energy is derived by, or not.
    const auto value = [&](const double* from, bool varies) __attribute__((always_inline)) {
      return D{take<S>(from, first, valid), S(varies ? 1.0 : 0.0), S(0.0)};
    };
    if constexpr (GivesEnergy<Model, Triangle<D>>::value) {
      const auto along = [&](bool one, bool two) __attribute__((always_inline)) {
        return model.energy(Triangle<D>{value(block.invariant_1, one), value(block.invariant_2, two),
                                        value(block.invariant_1_rate, false), value(block.invariant_2_rate, false)});
      };
      const D by_1 = along(true, false), by_2 = along(false, true), by_both = along(true, true);
      give(by_1.value, block.energy, first, valid);
      give(by_1.first, block.stress_1, first, valid);
      give(by_2.first, block.stress_2, first, valid);
      give(by_1.second, block.stress_1_by_1, first, valid);
      give(0.5 * (by_both.second - by_1.second - by_2.second), block.stress_1_by_2, first, valid);
      give(by_2.second, block.stress_2_by_2, first, valid);
    } else if constexpr (GivesEnergy<Model, Patch<D>>::value) {
      const D energy = model.energy(Patch<D>{value(block.area_ratio, true)});
      give(energy.value, block.energy, first, valid);
      give(energy.first, block.area_tension, first, valid);
      give(energy.second, block.area_tension_by_ratio, first, valid);
    } else {
      const auto along = [&](bool volume, bool area) __attribute__((always_inline)) {
        return model.energy(Body<D>{value(block.volume, volume), value(block.rest_volume, false),
                                    value(block.surface_area, area), value(block.rest_surface_area, false)});
      };
      const D by_volume = along(true, false), by_area = along(false, true);
      give(by_volume.value, block.energy, first, valid);
      give(-by_volume.first, block.pressure, first, valid);
      give(by_area.first, block.surface_tension, first, valid);
    }
  }
};

}  // namespace detail

/// Model made of a type with a constructor from Parameters and a template operator() over the element it describes, or
/// `template <class S> S energy(const Segment<S>&) const` (or of another element) in its place, from which forces and
/// stiffness are derived (dual.hpp); laws that remember: see state.hpp. A law of segments may have a second functor, of
/// a Triangle, and one of a Cell a second one of a Body: those are what it does in three dimensions.
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
