// What surfaces resist with to the rate at which they are strained, by a step that is stable at any viscosity.
#pragma once

#include <array>
#include <vector>

#include "padded_triangles.hpp"
#include "surface_kernels.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

/// A triangle with the sides e1 and e2 in the metric g, its nodes moving by v, has the rate of strain D = dg/dt / 2,
/// dg_ij/dt = e_i.v_j + e_j.v_i, the same all over it. With the shear viscosity m and the area viscosity k the surface
/// is under the stress
///
///     T = 2 m (D - tr D g/2) + k tr D g
///
/// (Evans and Hochmuth, Biophys. J. 16, 1976, a Newtonian surface), whose forces on the nodes are F = -N v: without sum
/// and torque, whatever v, and dissipative. They change v within the step by M, the velocity that a node gains from a
/// force of 1; explicit steps therefore fail from m near 1 lattice unit on. As outlines do (TensionRateStep) the step
/// takes
///
///     F = -N u,   u = V + M (F - F_old),
///
/// V the last step's motion and F_old the force of the last stress, kept for each triangle along its sides, so that it
/// turns with them. The fixed point is F = -N V: no viscosity is lost. Since F.V = F.u - M F.(F - F_old), whatever the
/// step, a membrane of a given shape gives back no more than it has taken.
/// u - V is found by conjugate gradients (Hestenes and Stiefel 1952). F is the force of the stress at what they arrive
/// at: momentum, torque and F.u <= 0 do not depend on how far they went.
class SurfaceViscosity {
 public:
  /// One worker's arrays, for one cell after another.
  struct Room {
    std::vector<double> viscosity[2];                      // of triangles: shear and area viscosity, what laws give
    std::vector<double> stress[3];                         // T A along the sides: 11, 12, 22
    std::vector<double> change[3], on_corner[3];           // of triangles, of their corners
    std::vector<double> force[3], residual[3], search[3];  // of nodes
    /// For this many triangles, padded.
    void resize(std::size_t triangles);
  };

  /// Of a type of cells. `gain`: how many times further a force moves its node than through the 4-point kernel;
  /// `tension_unit`: SI size of the lattice unit of tension. The stress is in surfaces.state from step to step.
  SurfaceViscosity(Surfaces& surfaces, int type, double gain, double tension_unit);

  /// Takes the stress of a cell, in its state and in the room, one step on. `arrays`: its sides and normals.
  void step(const PaddedTriangles& mesh, const SurfaceArrays& arrays, Surfaces& surfaces, const CellRange& cell,
            Room& room) const;

  /// Power that the stress of a cell takes out of its motion.
  double power(const PaddedTriangles& mesh, const SurfaceArrays& arrays, const Surfaces& surfaces,
               const CellRange& cell, Room& room) const;

 private:
  void take_stress(const PaddedTriangles& mesh, const Surfaces& surfaces, const CellRange& cell, Room& room) const;

  std::vector<double> inverse_mobility_;  // of nodes
  std::array<std::size_t, 6> stress_;     // in Surfaces::state
};

}  // namespace rouleau::core
