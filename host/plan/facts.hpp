// What the models and stages of a plan amount to, computed once: stiffness, wells, cutoffs, spacings, speeds.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "constants.hpp"
#include "core/membrane/stiffness.hpp"
#include "error_model.hpp"
#include "flow.hpp"
#include "json/json.hpp"
#include "models.hpp"
#include "potential_shape.hpp"
#include "shape/rest_shapes.hpp"

namespace rouleau::plan {

/// A stiffness as the fluid feels it, and its limit with explicit coupling.
struct Bounded {
  double value = 0, limit = 1;
  [[nodiscard]] double margin() const { return limit / value; }
  /// Becomes the other, unless that is further from its limit.
  void narrow(const Bounded& other) {
    if (!(margin() < other.margin())) *this = other;
  }
};

/// Of one cell type. Lattice units where nothing else is said.
struct MembraneFacts {
  core::Stiffness stiffness;   ///< largest near rest
  double elastic_modulus = 0;  ///< d tension / d stretch at rest, of laws that give it
  double recovery_rate = 0;    ///< Es/(mu a), 1/s: Es a third of the stretching stiffness, as of a neo-Hookean membrane
  double tension = 0;          ///< of a circle or sphere at its prestretch, or of the first state
  std::optional<shape::FirstStretch> first = {};  ///< with a stress-free shape
};

/// What the models of a stage amount to. Lattice units.
struct ModelFacts {
  std::vector<MembraneFacts> membranes;                   ///< of each cell type; nothing without cells
  std::vector<std::optional<PotentialShape>> potentials;  ///< of each interaction; none: inactive, or it remembers
  double cutoff = 0;                                      ///< largest, between cells and within them
  Bounded stretching, bending;                            ///< of the cell type that is nearest to its limit
  double viscous_lag = 0;    ///< steps by which the stress of viscous membranes lags in a motion that changes
  double steps_of_mean = 0;  ///< over which a semi-implicit step holds forces; in three dimensions
  /// Variance over which slip is spread along a membrane, over the radius squared; in two dimensions, of cells that are
  /// not round. By the stretching stiffness alone; the bending of a red cell would add less than 2 %.
  double slip_smoothing = 0;
  /// Relative change of the content of a cell whose membrane is stretched from the start: the tension T over the radius
  /// a is a pressure (twice that of a sphere), and density deviates by three times the pressure.
  double prestress_compression = 0;
};

struct StageFacts {
  std::shared_ptr<const ModelFacts> models;  ///< shared by stages with the same units
  double shear_rate = 0;                     ///< scene::mean_shear_rate, 1/s
  double strain = 0;                         ///< of all of the stage at that rate
  FlowStart start;
  CellTravel travel;
  bool follows_cells = false;
};

/// Where the force changes its sign (m), energy per area (J/m2), depth over strongest attraction (m); NaN without a
/// well.
struct WellInSi {
  double distance = std::numeric_limits<double>::quiet_NaN(), depth = distance, width = distance;
  [[nodiscard]] bool attracts() const { return !std::isnan(depth); }
};
struct InteractionWell {
  std::string model;
  std::array<std::string, 2> between;  ///< cell types, or one and the walls
  WellInSi well;
  std::optional<WellInSi> stands_for;  ///< of the potential that this one stands for, where the manifest says which
  std::optional<double> widened;       ///< width over that of the other
  std::string doubt;                   ///< why it attracts nowhere in spite of its depth; empty: it does, or has none
};
void to_json(nlohmann::json& json, const InteractionWell& described);

/// Lengths of a cell type, m.
struct TypeFacts {
  double radius, node_spacing;
};

struct Facts {
  std::vector<TypeFacts> types;  ///< of each cell type
  std::vector<StageFacts> stages;
  std::vector<InteractionWell> wells;  ///< of each active interaction that remembers nothing
};
/// Of models that have been made.
Facts find_facts(const Models& models);

/// Limit over value, the smallest over stages, of the stretching and bending stiffness that explicit coupling bears.
/// Infinite without membrane laws.
double explicit_margin(const Facts& facts);

/// Of all cell types; nothing without cells.
std::optional<RecoveryRates> recovery_rates(const Models& models, const Facts& facts);

/// Pairs of cell types between which an interaction has a well, or remembers, as bonds do, which pull without one: only
/// these can be joined.
scene::Attractions attracting_types(const Models& models, const std::vector<InteractionWell>& wells);

/// Depth of the deepest well, J/m2; 0 where the interactions attract nowhere, NaN without cells and where
/// there is no interaction or all that there are have a state.
double deepest_well(const Models& models, const std::vector<InteractionWell>& wells);

/// Depth of a well (lattice units) over bending modulus / radius^2 in a stage, the largest of the two types that it
/// holds together and that have no potential within their membranes. 0 where there is nothing to say.
double depth_over_bending(const Models& models, const Facts& facts, const scene::StageSetting& stage,
                          const scene::Interaction& interaction, double depth);

/// Sum of the shear moduli of the first cell's laws, N/m; NaN where no parameter has that role. A flow in a plane never
/// shears a membrane in its own plane, so this is no property that could be measured on the law.
double shear_modulus(const Models& models);

/// d tension / d stretch at rest, N/m: of all laws together, of the cell type that has least; NaN where there is none.
double stretching_modulus(const Models& models, const Facts& facts);

/// Value at tau, linear in log tau' with tau' = tau - 1/2, constant beyond the ends of the table.
double interpolate(std::span<const AtTau> table, double tau);

/// Relaxation time of a fluid with this viscosity, Pa s.
double relaxation_time_of(double viscosity, const scene::Scene& scene);

}  // namespace rouleau::plan
