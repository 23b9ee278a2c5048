// Takes the tangential slip out of the coupling of surfaces, as slip_correction.hpp does for outlines.
#pragma once

#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/surface/mesh_polynomial.hpp"
#include "core/surface/padded_triangles.hpp"
#include "core/surface/surface_normals.hpp"
#include "core/surface/surfaces.hpp"
#include "slip_constants.hpp"
#include "surface_slip_kernels.hpp"

namespace rouleau::core {

/// With the outer normal n, P = 1 - n n and F = F_n n + F_t all forces on a node: forces act and velocities are read at
/// X - d n; the dipole -d n (x) F that this brings is made isotropic and symmetric by another, -d [F_n P + F_t (x) n],
/// of forces on the nodes around; velocities are turned by the adjoint of that. A node then gains the slip `slip /
/// viscosity x` tangential force per area, smoothed along the membrane (docs: physics, slip correction).
class SurfaceSlip {
 public:
  /// What the correction has to know of a cell type, lattice units.
  struct Type {
    SlipConstants constants;
    double stretching_stiffness;  ///< largest d tension / d stretch: slip of stiff membranes is smoothed further
  };
  /// `viscosity`: of the suspending fluid, lattice units.
  SurfaceSlip(const Surfaces& surfaces, std::vector<Type> types, double viscosity);

  // `normals`: at the present positions.

  /// Pass over cells: normals, and where the nodes touch the lattice.
  void measure(Worker worker, const Surfaces& surfaces, const SurfaceNormals& normals, Whose whose = Whose::own);
  /// Pass over cells, once the forces on them are complete: the slip, and what is to be spread, forces().
  void complete(Worker worker, const Surfaces& surfaces, const SurfaceNormals& normals);
  /// Pass over cells: turns velocities interpolated at the touching points into those of the membrane.
  void correct(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals);

  /// Takes no memory for these nodes until they are measured again.
  void forget(std::span<const Range> nodes);
  [[nodiscard]] std::array<const double*, 3> positions() const {
    return {touch_[0].data(), touch_[1].data(), touch_[2].data()};
  }
  [[nodiscard]] std::array<double*, 3> forces_of_all() {
    return {force_[0].data(), force_[1].data(), force_[2].data()};
  }
  [[nodiscard]] std::array<const double*, 3> forces() const {
    return {force_[0].data(), force_[1].data(), force_[2].data()};
  }

 private:
  /// What the cells of a type share.
  struct Shared {
    Shared(const Mesh& mesh, int order);
    PaddedTriangles mesh;
    Mesh::Rings neighbours;
    std::vector<int> left, right;  // of each of their entries: the triangles on either side of what joins both nodes
    std::vector<double> coefficients;  // by which slip is smoothed
    std::vector<double> own;           // NeighbourMatrix
  };
  /// One worker's arrays, for one cell after another.
  struct Scratch {
    std::vector<double> gradient[2][3], covered_triangle[6];        // of triangles
    std::vector<double> result[3];                                  // of their corners
    std::vector<double> covered[6], turned[3], along[3], pressure;  // of nodes
    std::vector<double> weight;                                     // of neighbours
    PolynomialRoom smoothing;
  };
  Scratch& scratch_of(int first_cell);
  SlipArrays arrays_of(const Surfaces& surfaces, int cell, const SurfaceNormals& normals, Scratch& scratch);
  void add_couples(int cell, const Surfaces& surfaces, const SlipArrays& arrays);
  void find_slip(int cell, const Surfaces& surfaces, const SlipArrays& arrays, Scratch& scratch);
  [[nodiscard]] const SlipConstants& constants(const Surfaces& surfaces, int cell) const {
    return types_[surfaces.cells[cell].type].constants;
  }

  std::vector<Type> types_;
  std::vector<Shared> shared_;  // of each type
  double viscosity_;
  std::array<PagedArray<double>, 3> normal_, touch_, force_, slip_;
  std::array<PagedArray<double>, 6> turn_;  // of a tangential vector, SlipArrays
  WorkerScratch<Scratch> scratch_;
};

}  // namespace rouleau::core
