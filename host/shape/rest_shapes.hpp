// Cells of a type as they begin and as they rest.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/surface/surfaces.hpp"
#include "json/json.hpp"
#include "scene/scene.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::shape {

/// Adds a cell type of a scene to cells on a lattice of this spacing, m.
void add_type(core::Membranes& cells, const scene::CellType& type, double spacing);
void add_type(core::Surfaces& cells, const scene::CellType& type, double spacing);

/// How a cell begins whose membrane rests in another shape.
struct FirstStretch {
  std::string type;
  double least, most;  ///< principal stretches; of an outline those of its segments
  double energy;       ///< J/m2, of the laws in the plane, mean over the membrane at rest; NaN: a law does not tell it
  double tension;      ///< N/m, mean size
  friend void to_json(nlohmann::json& to, const FirstStretch& of) {
    to = {{"type", of.type},
          {"least", of.least},
          {"most", of.most},
          {"energy_J_per_m2", of.energy},
          {"tension_N_per_m", of.tension}};
  }
};
FirstStretch first_stretch(const scene::CellType& type, const std::vector<core::MembraneLaw>& laws,
                           const units::LatticeUnits& units, int dimension);

/// What is doubtful about the shape at rest of a type in three dimensions; empty: nothing, or it is no deflated cell.
std::string doubt_of_rest(const scene::CellType& type);

}  // namespace rouleau::shape
