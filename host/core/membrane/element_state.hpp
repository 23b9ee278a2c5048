// What models remember of the membranes' elements from step to step, under names that last as long as the run.
#pragma once

#include <string>
#include <vector>

#include "core/domain/images.hpp"

namespace rouleau::core {

/// One state variable of one law of a cell type; without a law: of the method itself. Values are in lattice units, one
/// for each node of all membranes (segment i belongs to node i, a whole cell to its first node); those of cells of
/// other types are never used.
struct ElementState {
  int cell_type;
  /// Place among the active laws of the type; -1: kept by the method.
  int law;
  /// Id of the law; empty: the method.
  std::string model;
  std::string name;
  /// SI size of the lattice unit that the values are in.
  double unit;
  std::vector<double> value;
  /// Lattice units: of a cell that has just come.
  double initial = 0;
};

/// One state variable of one interaction.
struct ContactVariable {
  /// Place among the active interactions.
  int potential;
  /// Id of the interaction.
  std::string model;
  std::string name;
  /// SI size of the lattice unit that the values are in.
  double unit;
  /// Lattice units: of a node that has just come within the cutoff.
  double initial;
};

/// Values of one variable for the nodes of one cell against another cell moved by `shift` periods, or against a wall,
/// in lattice units; initial where a node is not within the cutoff.
struct ContactState {
  std::size_t variable;  ///< in ContactMemory::variables
  int other;             ///< a cell; of contacts with walls 0: the lower, 1: the upper, in three dimensions also 2, 3:
                         ///< those across z; a tube is 0
  ImageShift shift;
  std::vector<double> value;  ///< of the cell's nodes, from its first on
};

/// What interactions remember. Pairs of cells, or of a cell and a wall, come and go with their contacts.
struct ContactMemory {
  std::vector<ContactVariable> variables;
  std::vector<std::vector<ContactState>> of_cell;  ///< empty where no interaction remembers anything

  /// Index of the variable with this potential and name, in lattice units of this size from now on; adds it where there
  /// is none yet.
  std::size_t keep(const ContactVariable& wanted);
  /// Expresses all values of a variable in lattice units of another size: a stage with another time step goes on with
  /// the same state.
  void change_unit(std::size_t variable, double unit);
};

/// Index of the variable with this owner and name, in lattice units of this size from now on; adds it, all at
/// `initial`, where there is none yet. `variable.value` is not used.
std::size_t keep_state(std::vector<ElementState>& states, ElementState variable, double initial, std::size_t count);

}  // namespace rouleau::core
