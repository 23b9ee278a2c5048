// What models remember of the membranes' elements from step to step, under names that last as long as the run.
#pragma once

#include <string>
#include <vector>

#include "periodic_box.hpp"
#include "plugin/manifest.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::membrane {

/// One state variable of one law of a cell type; without a law: of the method itself. Values are in lattice units, one
/// for each node of all membranes (segment i belongs to node i, a whole cell to its first node); those of cells of
/// other types are never used.
struct ElementState {
  int cell_type;
  int law;            ///< place among the active laws of the type; -1: kept by the method
  std::string model;  ///< id of the law; empty: the method
  std::string name;
  std::string unit;
  units::Dimension dimension;
  std::vector<double> value;
};

/// One state variable of one interaction.
struct ContactVariable {
  int potential;      ///< place among the active interactions
  std::string model;  ///< id of the interaction
  std::string name;
  std::string unit;
  units::Dimension dimension;
  double initial;  ///< lattice units: of a node that has just come within the cutoff
};

/// Values of one variable for the nodes of one cell against another cell moved by `shift` periods, in lattice units;
/// initial where a node is not within the cutoff.
struct ContactState {
  std::size_t variable;  ///< in ContactMemory::variables
  int other;
  ImageShift shift;
  std::vector<double> value;  ///< of the cell's nodes, from its first on
};

/// What interactions remember. Pairs of cells come and go with their contacts.
struct ContactMemory {
  std::vector<ContactVariable> variables;
  std::vector<std::vector<ContactState>> of_cell;  ///< empty where no interaction remembers anything
};

/// Index of the variable with this owner and name; adds it, all at `initial`, where there is none yet.
std::size_t keep_state(std::vector<ElementState>& states, ElementState variable, double initial, std::size_t count);

/// The variable of this name and type; null: none. For tests and outputs.
const ElementState* find_state(const std::vector<ElementState>& states, int cell_type, const std::string& name);

/// Expresses all values in other units: a stage with another time step goes on with the same state.
void change_units(std::vector<ElementState>& states, const units::LatticeUnits& from, const units::LatticeUnits& to);
void change_units(ContactMemory& memory, const units::LatticeUnits& from, const units::LatticeUnits& to);

}  // namespace rouleau::membrane
