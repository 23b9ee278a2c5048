// The semi-implicit step of stiff surfaces: SemiImplicitFilter's, on a mesh.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <optional>
#include <vector>

#include "core/membrane/node_mobility.hpp"
#include "mesh_polynomial.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

/// A symmetric positive matrix M = P' L D L' P.
class MeshInverse {
 public:
  /// Throws std::invalid_argument for a matrix that has no inverse.
  explicit MeshInverse(const Eigen::SparseMatrix<double>& matrix);

  /// The row of a node after the permutation P.
  [[nodiscard]] std::size_t place(std::size_t node) const { return static_cast<std::size_t>(place_[node]); }
  /// Replaces vectors of the nodes by M^-1 of them: rows of four numbers, in the order of place().
  void solve(double* rows) const;
  /// Of L below its diagonal.
  [[nodiscard]] int entries() const { return static_cast<int>(entry_.size()); }

 private:
  // L without its diagonal of ones, column by column.
  std::vector<int> place_;
  std::vector<int> first_, row_;  // entries [first_[j], first_[j + 1]) belong to column j; where rows of vectors begin
  std::vector<double> entry_;
  std::vector<double> inverse_;  // 1/D
};

/// Largest eigenvalue of (K A^-1)/2 that a lattice feels on a mesh so fine that it has all such waves; parameters as
/// below.
double largest_eigenvalue(const KernelResponse& response, double stretching, double bending);

/// What SemiImplicitFilter does for outlines, with the stiffness of a surface: C is the mesh's Laplacian at rest times
/// -1 (weights of cotangents; Pinkall and Polthier, Experimental Mathematics 2, 15, 1993), A the areas of the nodes,
/// and
///
///     F = H + (I + K A^-1/2)^-1 (F(X + V) - H),   K = k_s C + k_b C A^-1 C.
///
/// All three components have the same stiffness, the largest there is along the surface and across it, so that the
/// filter does not know how the cell is turned. Where that is quicker, a polynomial in C A^-1 stands for the inverse,
/// which differs by less than 1 % of its least eigenvalue. The sum of the forces stays what it is, for C has no sum;
/// their torque need not.
class SurfaceFilter {
 public:
  /// `stretching`: k_s = d tension / d stretch along one direction, the other held; `bending`: k_b = d moment / d
  /// curvature; `viscosity`: kinematic, of the fluid around the cell. Lattice units.
  SurfaceFilter(const RestSurface& rest, double viscosity, double stretching, double bending,
                const KernelResponse& response = {});

  /// Replaces a cell's forces F(X + V) by F, after taking them into their means `held`. `room`: of this call's own.
  void apply(const std::array<double*, 3>& force, const std::array<double*, 3>& held, PolynomialRoom& room) const;

  /// Largest eigenvalue of (K A^-1)/2, waves left aside that are shorter than the lattice feels.
  [[nodiscard]] double largest_eigenvalue() const { return largest_; }
  /// Of the polynomial that stands for the inverse, one more; 0: the inverse itself is taken, which is quicker for
  /// stiff membranes.
  [[nodiscard]] int terms() const { return static_cast<int>(series_.size()); }

 private:
  std::vector<double> area_;       // of the nodes
  double largest_, newest_share_;  // of K A^-1/2; of the newest force in the mean
  std::vector<double> series_;     // of the polynomial, in B; empty: `inverse_` is taken
  Mesh::Rings neighbours_;
  std::vector<double> own_, weight_;    // B (NeighbourMatrix)
  std::optional<MeshInverse> inverse_;  // of A + K/2
};

}  // namespace rouleau::core
