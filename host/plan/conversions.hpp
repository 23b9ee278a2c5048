// The quantities of a scene in SI and in lattice units.
#pragma once

#include <string>
#include <vector>

#include "json/json.hpp"
#include "models.hpp"

namespace rouleau::plan {

/// A quantity in a stage, in SI and in lattice units; `of`: a cell type or two, empty for the fluid.
struct Conversion {
  std::string stage, quantity, of;
  double si;
  std::string unit;
  double lattice;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Conversion, stage, quantity, of, si, unit, lattice)
};

/// Of each stage.
std::vector<Conversion> conversion_table(const Models& models);

}  // namespace rouleau::plan
