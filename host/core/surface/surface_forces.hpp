// Forces of the membrane laws on the nodes of surfaces: minus the gradient of the laws' energies.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "base/worker.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "core/model/model.hpp"
#include "padded_triangles.hpp"
#include "surface_filter.hpp"
#include "surface_kernels.hpp"
#include "surface_viscosity.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

/// Turns stresses, moments, pressures and surface tensions into nodal forces whose sum and torque vanish. Only what
/// some law of a type needs is computed. What a node gets is summed in the order of its triangles: bits do not depend
/// on the workers.
class SurfaceForces {
 public:
  /// `laws`: of each cell type, as they are in three dimensions. Throws std::invalid_argument for a law that remembers,
  /// which surfaces do not have yet.
  SurfaceForces(const Surfaces& surfaces, const std::vector<MembraneLaws>& laws);

  /// From now on the forces are those of the semi-implicit step (SurfaceFilter), with the laws' own stiffness. What it
  /// holds is in surfaces.state. `viscosity`: kinematic, of the suspending fluid; lattice units. `tension_unit`: SI
  /// size of the lattice unit of tension, for what is kept from one stage to the next. `responses`: of each cell type.
  void take_semi_implicit_steps(Surfaces& surfaces, double viscosity, double tension_unit,
                                const std::vector<KernelResponse>& responses);

  /// Viscosities that laws give are part of the forces from now on (SurfaceViscosity), with the motion of
  /// surfaces.velocity. `moduli`: the stiffness that steps bear, of each cell type; `tension_unit` as above.
  void take_viscosity(Surfaces& surfaces, const std::vector<double>& moduli, double tension_unit);

  /// Pass over cells: sets the forces.
  void run(Worker worker, Surfaces& surfaces);

  /// Energies at the present positions, of all ranks' cells. Not a pass: one thread, no other in run().
  [[nodiscard]] MembraneEnergy energies(const Surfaces& surfaces, const Ranks<3>& ranks = {});
  [[nodiscard]] double energy(const Surfaces& surfaces) { return energies(surfaces).total(); }

  /// Sum of both principal curvatures at each node of a cell, over the area at rest.
  [[nodiscard]] std::vector<double> curvatures(const Surfaces& surfaces, int cell);
  /// Mean tension of each triangle of a cell, all laws of triangles and cells together: half of the sum of both
  /// principal tensions, force per present length.
  [[nodiscard]] std::vector<double> tensions(const Surfaces& surfaces, int cell);

 private:
  /// A law with its element, and what its table is asked for.
  struct Law {
    MembraneLaw model;
    enum class Element { triangle, curvature, area, cell } element;
    bool energy, viscous;
  };
  /// What all cells of a type share, in the order and with the padding that the loops want.
  struct Type {
    explicit Type(const Mesh& of) : mesh(of) {}
    PaddedTriangles mesh;
    std::vector<Law> laws;
    bool triangle = false, curvature = false, area = false, cell = false;  // elements of the laws
    int edges;
    std::vector<int> triangle_edge[3];
    std::vector<int> edge_node[2], edge_triangle[2];
    std::vector<double> inverse[3], rest_area, inverse_node_area;
    std::vector<double> area_share;       // of nodes: rest area over three times the area that area_ratio is over
    std::optional<SurfaceFilter> filter;  // of a semi-implicit step
    std::array<std::size_t, 3> held_force = {0, 0, 0};  // of the filter: in Surfaces::state
    std::optional<SurfaceViscosity> viscosity;
    [[nodiscard]] bool viscous() const { return std::ranges::any_of(laws, &Law::viscous); }
  };
  /// One worker's arrays, for one cell after another.
  struct Scratch {
    std::vector<double> side[2][3], normal[3], invariant[2], stress[2];
    std::vector<double> force[3];  // on the first corners of all triangles, then on the second and third ones
    std::vector<double> turned_length, edge_turn;
    std::vector<double> curvature, area_ratio, node_moment, node_pull, law[4], energy;
    std::vector<double> ahead[3];  // of a semi-implicit step
    PolynomialRoom filtered;
    SurfaceViscosity::Room straining;
  };
  struct Whole {
    double volume = 0, surface_area = 0, pressure = 0, surface_tension = 0;
  };

  static Law describe(const MembraneLaw& model);
  static Type prepare(const RestSurface& rest, const MembraneLaws& laws);
  /// The arrays of the worker whose first cell this is; made when it first asks.
  Scratch& scratch_of(int first_cell);
  static SurfaceArrays arrays_of(const Type& type, Scratch& scratch);
  static Whole measure(const Type& type, Nodes nodes, Scratch& scratch);
  static void apply(const Type& type, const RestSurface& rest, Scratch& scratch, Whole& whole, MembraneEnergy* energy);
  static void act(const Type& type, const Whole& whole, Scratch& scratch);
  /// Where the nodes of a cell will be after another step like the last one.
  static Nodes look_ahead(const Surfaces& surfaces, const CellRange& cell, Scratch& scratch);
  /// Makes the forces those of the semi-implicit step.
  static void soften(const Type& type, Surfaces& surfaces, const CellRange& cell, Scratch& scratch);

  std::vector<Type> types_;
  WorkerScratch<Scratch> scratch_;
};

}  // namespace rouleau::core
