// The simulator as a library: find_package(Rouleau COMPONENTS core), target Rouleau::core, #include <rouleau/core.hpp>.
//
// A SolverSetup of plain values in lattice units and Membranes make a Solver, which takes steps and shows its state. No
// file is read, none is written, nothing is printed. examples/core.cpp is a whole program.
#pragma once

#include "core/membrane/geometry.hpp"
#include "core/model/compiled_in.hpp"
#include "core/solver/solver.hpp"

namespace rouleau {

using core::CellType;
using core::Interaction;
using core::Membranes;
using core::RestShape;
using core::SelfInteraction;
using core::Solver;
using core::SolverSetup;
using core::WallInteraction;

}  // namespace rouleau
