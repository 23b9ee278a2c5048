// What surfaces resist with to the rate at which they are strained, by a step that is stable at any viscosity.
#pragma once

#include <vector>

#include "core/membrane/node_mobility.hpp"
#include "padded_triangles.hpp"
#include "surface_kernels.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

/// A triangle with the sides e1 and e2 in the metric g, its nodes moving by v, has the rate of strain D = dg/dt / 2,
/// dg_ij/dt = e_i.v_j + e_j.v_i, the same all over it. With the shear viscosity m and the area viscosity k the surface
/// is under the stress
///
///     X = 2 m (D - tr D g/2) + k tr D g
///
/// (Evans and Hochmuth, Biophys. J. 16, 1976, a Newtonian surface). Its forces on the nodes, of any stress, have
/// neither sum nor torque. They change v within the step, so that explicit steps fail from m near 6 lattice units on.
/// The stress T that acts is therefore that of a dashpot behind a spring which an explicit step bears with ease, of the
/// modulus G = (m + k)/L. An inerter beside the dashpot, L steps times its viscosity, takes the lag of T away:
///
///     (T' - T) L = X - W',   (W' - W) L = T' - W',   W the stress of the dashpot,
///
/// T = X + O(L^2) where X changes slowly. T and W are kept for each triangle along its sides, so that they turn with
/// them. With |.| the energy norm of 1/(2 m), 1/k, a triangle takes, of a given shape,
///
///     T'.D = |W'|^2 + L/2 (|T'|^2 - |T|^2 + |T' - T|^2 + |W'|^2 - |W|^2 + |W' - W|^2):
///
/// it never gives back more than it has taken, at any viscosity.
class SurfaceViscosity {
 public:
  /// One worker's arrays of triangles, for one cell after another.
  struct Room {
    std::vector<double> viscosity[2];  // shear and area viscosity, what laws give
    std::vector<double> stress[6];     // T A, then W A along the sides: 11, 12, 22
    /// For this many triangles, padded.
    void resize(std::size_t triangles);
  };

  /// Of a type of cells. `modulus`: G; `tension_unit`: SI size of the lattice unit of tension. T and W are in
  /// surfaces.state from step to step.
  SurfaceViscosity(Surfaces& surfaces, int type, double modulus, double tension_unit);

  /// Takes the stress of a cell, in its state and in the room, one step on. `arrays`: its sides and normals.
  void step(const PaddedTriangles& mesh, const SurfaceArrays& arrays, Surfaces& surfaces, const CellRange& cell,
            Room& room) const;

  /// Power that the stress of a cell takes out of its motion.
  double power(const PaddedTriangles& mesh, const SurfaceArrays& arrays, const Surfaces& surfaces,
               const CellRange& cell) const;

 private:
  double modulus_;
  std::vector<std::size_t> stress_;  // in Surfaces::state: what Room::stress has
};

/// The modulus G of a membrane in a fluid of this kinematic viscosity: a tenth of the stretching stiffness that
/// explicit steps bear, or a little more (docs: results, membrane viscosity). Lattice units.
double viscous_modulus(double viscosity, const KernelResponse& response);

}  // namespace rouleau::core
