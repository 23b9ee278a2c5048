// What a plan tells of its models in SI units, found with the models' own functions.
#pragma once

#include "plan.hpp"

namespace rouleau::plan {

/// Makes every active model once, so that a plan never promises a run that cannot start. Throws Error(bad_input) with
/// the model's place in the scene when it refuses its parameters, Error(plugin_refused) when its library is refused.
void try_models(const Plan& plan);

/// One entry for each active interaction: place, depth and width of its well (null where it attracts nowhere), and,
/// where the manifest says what the potential stands for, those of that potential and by how much the well was widened.
nlohmann::json describe_wells(const Plan& plan);

/// Depth of the deepest well in plan.wells, J/m2; 0 where the interactions attract nowhere, NaN without cells and where
/// there is no interaction or all that there are have a state, on which the well depends.
double deepest_well(const Plan& plan);

/// Sum of the shear moduli of the first cell's laws, N/m; NaN where no parameter has that role. A flow in a plane never
/// shears a membrane in its own plane, so this is no property that could be measured on the law.
double shear_modulus(const Plan& plan);

/// d tension / d stretch at rest, N/m: of all laws together, of the cell type that has least; NaN where there is none.
double stretching_modulus(const Plan& plan);

}  // namespace rouleau::plan
