// Takes the tangential slip out of the coupling of surfaces, as slip_correction.hpp does for outlines.
#pragma once

#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/surface/surfaces.hpp"
#include "slip_constants.hpp"

namespace rouleau::core {

/// With the outer normal n, P = 1 - n n and F = F_n n + F_t all forces on a node: forces act and velocities are read at
/// X - d n; the dipole -d n (x) F that this brings is made isotropic and symmetric by another, -d [F_n P + F_t (x) n], of
/// forces on the nodes around; velocities are turned by the adjoint of that. A node then gains the slip `slip / viscosity x`
/// tangential force per area, smoothed along the membrane (docs: physics, slip correction).
class SurfaceSlip {
 public:
  /// What the correction has to know of a cell type, lattice units.
  struct Type {
    SlipConstants constants;
    double
        stretching_stiffness;  ///< largest d tension / d stretch: stiff membranes need their slip smoothed more often
  };
  /// `viscosity`: of the suspending fluid, lattice units.
  SurfaceSlip(const Surfaces& surfaces, std::vector<Type> types, double viscosity);

  /// Pass over cells: normals and areas at the present positions, and where the nodes touch the lattice.
  void measure(Worker worker, const Surfaces& surfaces, Whose whose = Whose::own);
  /// Pass over cells, once the forces on them are complete: the slip, and what is to be spread, forces().
  void complete(Worker worker, const Surfaces& surfaces);
  /// Pass over cells: turns velocities interpolated at the touching points into those of the membrane.
  void correct(Worker worker, Surfaces& surfaces);

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
  /// One worker's arrays for one cell: of its triangles, and of its nodes.
  struct Scratch {
    std::vector<double> area;
    std::vector<std::array<Vec<3>, 3>>
        gradient;                         // of the three nodes' hat functions, on the triangle that touches the lattice
    std::vector<Eigen::Matrix3d> turned;  // of nodes: F_t to what the couple is made of
    std::vector<Vec<3>> value, other;
  };
  void find_areas(const Surfaces& surfaces, int cell, Scratch& scratch) const;
  void find_gradients(const Surfaces& surfaces, int cell, Scratch& scratch) const;
  void add_couples(const Surfaces& surfaces, int cell, Scratch& scratch);
  void find_slip(const Surfaces& surfaces, int cell, Scratch& scratch);
  [[nodiscard]] Vec<3> normal(int node) const { return {normal_[0][node], normal_[1][node], normal_[2][node]}; }
  [[nodiscard]] const SlipConstants& constants(const Surfaces& surfaces, int cell) const {
    return types_[surfaces.cells[cell].type].constants;
  }

  std::vector<Type> types_;
  double viscosity_;
  std::vector<int> smoothings_;  // of the slip of each type's cells
  std::array<PagedArray<double>, 3> normal_, touch_, force_, slip_;
  PagedArray<double> area_;  // a third of the triangles around each node
};

}  // namespace rouleau::core
