// Takes the tangential slip out of the immersed boundary, which the smearing of forces over the kernel leaves behind.
#pragma once

#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/node_mobility.hpp"
#include "slip_constants.hpp"

namespace rouleau::core {

/// Forces act and velocities are read at X - d n (n outward); the couple that this takes away is given back by forces
/// on both neighbours, and the velocities are turned by the adjoint of that. A node then gains the slip
/// `slip / viscosity x` tangential force per length, smoothed along the membrane (docs: physics, slip correction).
class SlipCorrection {
 public:
  /// What the correction has to know of a cell type, lattice units.
  struct Type {
    SlipConstants constants;
    double stretching_stiffness;  ///< d tension / d stretch: stiff membranes need their slip smoothed more often
    double bending_stiffness;     ///< d moment / d curvature
  };
  /// `viscosity`: of the suspending fluid, lattice units.
  SlipCorrection(const Membranes& membranes, std::vector<Type> types, double viscosity);

  /// Pass over cells: directions at the present positions, and where the nodes touch the lattice.
  void measure(Worker worker, const Membranes& membranes, Whose whose = Whose::own);
  /// Pass over cells, once the forces on them are complete: the slip, and what is to be spread, forces(). Both are made
  /// of all forces on a node: where these balance, everything comes to rest.
  void complete(Worker worker, const Membranes& membranes);
  /// Pass over cells: turns velocities interpolated at the touching points into those of the membrane.
  void correct(Worker worker, Membranes& membranes);

  /// Of each cell type.
  [[nodiscard]] std::vector<NodeMobility> mobility() const;
  /// Takes no memory for these nodes until they are measured again.
  void forget(std::span<const Range> nodes);
  [[nodiscard]] std::array<const double*, 2> positions() const { return {touch_x_.data(), touch_y_.data()}; }
  [[nodiscard]] std::array<double*, 2> forces_of_all() { return {force_x_.data(), force_y_.data()}; }
  [[nodiscard]] std::array<const double*, 2> forces() const { return {force_x_.data(), force_y_.data()}; }

 private:
  template <class Loop>
  void run(Worker worker, const Membranes& membranes, double* velocity_x, double* velocity_y, Whose whose);

  std::vector<Type> types_;
  double viscosity_;
  std::vector<int> smoothings_;               // of the slip of each type's cells
  PagedArray<double> tangent_x_, tangent_y_;  // along the chord from the node before to the node after
  PagedArray<double> inverse_chord_;          // 1 / its length
  PagedArray<double> touch_x_, touch_y_;
  PagedArray<double> force_x_, force_y_;  // of the couples; in the end all that is spread
  PagedArray<double> slip_;               // velocity along the tangent
  PagedArray<double> scratch_x_, scratch_y_;
};

}  // namespace rouleau::core
