// Polynomials of an operator that joins the nodes of a mesh with their neighbours.
#pragma once

#include <span>
#include <vector>

#include "mesh.hpp"

namespace rouleau::core {

/// Row i of a matrix B: own[i] in the diagonal, weight[k] in column neighbour[k] for k from first[i] to first[i + 1] -
/// 1.
struct NeighbourMatrix {
  int nodes;
  const int *first, *neighbour;
  const double *own, *weight;
};

/// Vectors of the nodes of a cell, four numbers each of which the last is nothing: what a polynomial is applied to, and
/// two of which it makes use.
struct PolynomialRoom {
  std::vector<double> value, one, other;
  void resize(std::size_t nodes) {
    for (auto* vectors : {&value, &one, &other}) vectors->resize(4 * nodes);
  }
};

/// The sum over k of coefficient[k] T_k(B) value, with Chebyshev's polynomials T_k, by Clenshaw's recurrence. It stays
/// in `room` until that is used again. B is to have eigenvalues from -1 to 1.
[[nodiscard]] const double* apply_polynomial(const NeighbourMatrix& matrix, std::span<const double> coefficients,
                                             PolynomialRoom& room);

/// For each node the nodes around it, in the order of Mesh::node_edges().
Mesh::Rings neighbours_of(const Mesh& mesh);

}  // namespace rouleau::core
