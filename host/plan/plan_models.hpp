// What the models of a plan amount to in SI units, found with the models' own functions.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// Where the force changes its sign (m), energy per area (J/m2), depth over strongest attraction (m); NaN without a well.
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

/// One entry for each active interaction without a state, on which a well would depend.
std::vector<InteractionWell> describe_wells(const Plan& plan);

/// Pairs of cell types between which an interaction has a well, or remembers, as bonds do, which pull without one: only
/// these are joined where they are close.
std::vector<std::array<std::string, 2>> attracting_types(const Plan& plan, const std::vector<InteractionWell>& wells);

/// Depth of the deepest of the plan's wells, J/m2; 0 where the interactions attract nowhere, NaN without cells and where
/// there is no interaction or all that there are have a state.
double deepest_well(const Plan& plan, const std::vector<InteractionWell>& wells);

/// Sum of the shear moduli of the first cell's laws, N/m; NaN where no parameter has that role. A flow in a plane never
/// shears a membrane in its own plane, so this is no property that could be measured on the law.
double shear_modulus(const Plan& plan);

/// d tension / d stretch at rest, N/m: of all laws together, of the cell type that has least; NaN where there is none.
double stretching_modulus(const Plan& plan);

}  // namespace rouleau::plan
