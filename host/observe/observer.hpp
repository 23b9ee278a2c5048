// Turns the state between two steps into a Snapshot in SI units, and follows what drifts.
#pragma once

#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "aggregates.hpp"
#include "cell_free_layer.hpp"
#include "cell_measures.hpp"
#include "core/membrane/geometry.hpp"
#include "core/solver/any_solver.hpp"
#include "json/json.hpp"
#include "rotation.hpp"
#include "scene/stage_scales.hpp"
#include "snapshot.hpp"

namespace rouleau::core {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StretchRange, least, most)
}  // namespace rouleau::core

namespace rouleau::observe {

/// Follows angles over turns, and remembers what drifts are measured against; lives for the whole run.
class Observer {
 public:
  /// `attracting`: pairs of cell types for which bonds are looked for.
  explicit Observer(const scene::Scene& scene, scene::Attractions attracting = {});
  /// Of all cells as they are placed.
  template <class Cells>
  Observer(const scene::Scene& scene, const Cells& cells) : Observer(scene) {
    begin_with(cells);
  }
  /// The next cells, as they are placed; in their order. Of those that are not known nothing is read.
  template <class Cells>
  void begin_with(const Cells& cells);
  /// A cell that comes: cell k of these, `number` in the scene. All ranks, and all get the same.
  template <class Cells>
  void begin_with(const Cells& cells, int k, int number);

  /// Mass is compared within a stage: a new density factor rescales the populations.
  void start_stage();

  /// Settles a fluid whose next step's force has been spread, and measures it in one sweep: mass and speed, and for an
  /// output all that observe() wants to know. All ranks together.
  template <int D>
  core::FluidMeasures<D> measure_fluid(core::AnyFluid<D>& fluid, const scene::StageSetting& setting,
                                       bool for_output) const;
  /// State before the next step of `solver`, whose forces must have been computed, and of whose fluid this has been
  /// measured for an output. `with_fields`: fields are due. All ranks together; what is about cells comes to the first,
  /// and fields give what they have to it.
  template <int D>
  Snapshot observe(core::AnySolver<D>& solver, const core::FluidMeasures<D>& measured,
                   const scene::StageSetting& setting, bool with_fields);
  template <int D>
  Snapshot observe(core::AnySolver<D>& solver, const scene::StageSetting& setting, bool with_fields) {
    return observe(solver, measure_fluid(solver.fluid(), setting, true), setting, with_fields);
  }

  /// Follows mass and Mach number; returns the latter, which is NaN if the fluid holds a value that is no number.
  template <int D>
  double follow_fluid(const core::AnyFluid<D>& fluid, const core::FluidMeasures<D>& measured);
  /// Follows the areas that outlines enclose, the volumes of surfaces; returns the largest relative change since the
  /// start. `cell`: whose. All ranks together, of all cells.
  template <class Cells, int D>
  double follow_area(const Cells& cells, const core::Ranks<D>& ranks, int* cell = nullptr);
  /// Largest area that the area correction has kept from leaking out of (or into) a cell within a strain of about one,
  /// over its rest area; `cell`: whose. NaN without that correction. All ranks together, of all cells.
  template <int D>
  static double area_leakage(const core::CellNodes& cells, const core::Ranks<D>& ranks, int* cell = nullptr);
  /// Sum of nodal forces, less what walls do to the cells, over the sum of their magnitudes: rounding only,
  /// or an internal force is unbalanced. All ranks together, of all cells.
  template <int D = 2>
  static double momentum_residual(const core::CellNodes& cells, const std::array<double, 3>& from_walls = {},
                                  const core::Ranks<D>& ranks = {});

  [[nodiscard]] const core::Domain<2>& domain() const { return domain_; }
  [[nodiscard]] double mach_max() const { return mach_max_; }
  [[nodiscard]] double area_drift_max() const { return area_drift_max_; }
  [[nodiscard]] double mass_drift() const { return mass_drift_; }
  /// Of any segment at any output so far.
  [[nodiscard]] const core::StretchRange& stretch() const { return stretch_; }
  /// Whether what it remembers is about these cells: all that are known.
  [[nodiscard]] bool fits(const core::CellNodes& nodes) const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Observer, initial_area_, marker_, angle_, tank_treading_angle_, rotation_, mach_max_,
                                 area_drift_max_, mass_drift_, initial_mass_, stretch_)

 private:
  void make_room_for(int cell);
  template <int D>
  void observe_cells(core::Surroundings<D>& around, const units::LatticeUnits& units, Snapshot& snapshot);
  void follow_angles(const CellMeasures& measures, CellSnapshot& snapshot);
  template <int D>
  void observe_layers(const core::Cells<D>& cells, const core::Ranks<D>& ranks, double length, Snapshot& snapshot);
  void follow_stretch(const core::StretchRange& stretch, CellSnapshot& snapshot);

  const scene::Scene* scene_;
  scene::Attractions attracting_;
  core::Domain<2> domain_;
  /// Of walls of any shape, made when first asked for.
  std::tuple<std::vector<WallPoint<2>>, std::vector<WallPoint<3>>> wall_points_;
  // Of each cell that is or was there.
  std::vector<double> initial_area_;                 ///< or volumes
  std::vector<int> marker_;                          ///< the node that tells its tank treading
  std::vector<double> angle_, tank_treading_angle_;  ///< last values, continuous; NaN: none yet
  Rotation rotation_;
  double mach_max_ = 0, area_drift_max_ = 0, mass_drift_ = 0;
  double initial_mass_ = std::numeric_limits<double>::quiet_NaN();  ///< none yet
  core::StretchRange stretch_;
};

}  // namespace rouleau::observe
