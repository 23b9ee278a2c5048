// What a plan amounts to, for who prints or stores it: passes, what is left out, limits, numbers, costs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "conversions.hpp"
#include "estimate.hpp"
#include "json/json.hpp"
#include "limits.hpp"
#include "plan.hpp"

namespace rouleau::plan {

struct PlannedPass {
  std::string name, why;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PlannedPass, name, why)
};

/// What is not computed, and why.
struct Omission {
  std::string what, why;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Omission, what, why)
};

/// What became of an entry with "random".
struct PackedCells {
  std::string pointer, type;
  std::array<int, 2> cells;  ///< numbers of the first and the last
  int count;
  double hematocrit_asked;  ///< NaN: a count was
  double hematocrit;
  std::uint32_t seed;
  double gap_m;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PackedCells, pointer, type, cells, count, hematocrit_asked, hematocrit, seed, gap_m)
};

/// A stage whose fluid starts from rest and, being simulated denser than it is, makes what happens there come late.
struct LateStart {
  std::string stage;
  double strain;        ///< by so much
  double stage_strain;  ///< of this much
  bool avoidable;       ///< the developed flow is known
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(LateStart, stage, strain, stage_strain, avoidable)
};

/// What walls and periodic images add to the deformation of a cell that is sheared in three dimensions, over that in a
/// fluid without end. No error bar has it.
struct BoxShare {
  double radii;        ///< of the narrowest side
  double deformation;  ///< relative: 0.012 at 8 radii, and by the cube of them (docs/three-dimensions.md)
  bool at_least;       ///< it was not measured in so small a box, and is more
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(BoxShare, radii, deformation, at_least)
};

struct PlanReport {
  std::vector<PlannedPass> passes;
  std::vector<Omission> left_out;
  std::vector<Limit> limits;
  std::vector<std::string> warnings;
  std::map<std::string, double> dimensionless;  ///< NaN: undefined
  std::vector<Conversion> conversions;
  std::vector<InteractionWell> wells;
  scene::Attractions attracting;  ///< attracting_types()
  double close_gap = 0;           ///< m; cells are close below it: output.aggregate_gap
  std::vector<PackedCells> packings;
  std::vector<shape::FirstStretch> first_stretches;  ///< of types with a stress-free shape
  std::vector<LateStart> late_starts;                ///< by more than 1 % of the stage's strain
  std::optional<BoxShare> box_share;                 ///< of one cell or two; of more the box is what is computed
  Estimate estimate;
};

PlanReport make_report(const Plan& plan);

/// "in stage shear everything comes late by a strain of 1.31 (of 15)"
std::string in_words(const LateStart& late);
/// For people, as `rouleau plan` prints it.
std::string to_text(const Plan& plan, const PlanReport& report);
/// For programs, the same.
nlohmann::json to_json(const Plan& plan, const PlanReport& report);
/// The sections of it that summary.json has, too.
nlohmann::json shared_sections(const PlanReport& report);

}  // namespace rouleau::plan
