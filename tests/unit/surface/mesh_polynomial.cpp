// Polynomials of a matrix on a mesh, against its eigenvectors.
#include "core/surface/mesh_polynomial.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

TEST_CASE("a sum of Chebyshev's polynomials of a matrix does to its eigenvectors what it does to numbers") {
  auto random = generator(221);
  std::uniform_real_distribution<double> any(-1, 1);
  const RestSurface rest = core::rest_surface(core::ellipsoid(3, {3, 4, 5}));
  const Mesh& mesh = rest.mesh;
  const int n = mesh.node_count();
  const Mesh::Rings neighbours = neighbours_of(mesh);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (const Mesh::Edge& edge : mesh.edges()) matrix(edge.a, edge.b) = matrix(edge.b, edge.a) = any(random);
  for (int i = 0; i < n; ++i) matrix(i, i) = any(random);
  matrix /= 1.01 * matrix.selfadjointView<Eigen::Lower>().operatorNorm();
  std::vector<double> own, weight;
  for (int i = 0; i < n; ++i) {
    own.push_back(matrix(i, i));
    for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k)
      weight.push_back(matrix(i, neighbours.entry[k]));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrix);
  const int terms = GENERATE(1, 2, 3, 8);
  std::vector<double> coefficients;
  for (int k = 0; k < terms; ++k) coefficients.push_back(any(random));
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < terms; ++k) factor[i] += coefficients[k] * std::cos(k * std::acos(modes.eigenvalues()[i]));
  }
  Eigen::MatrixXd value(n, 3);
  for (int i = 0; i < value.size(); ++i) value(i) = any(random);
  const Eigen::MatrixXd exact =
      modes.eigenvectors() * (factor.asDiagonal() * (modes.eigenvectors().transpose() * value));

  PolynomialRoom room;
  room.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) room.value[4 * i + c] = value(i, c);
  }
  const double* const found = apply_polynomial(
      {n, neighbours.first.data(), neighbours.entry.data(), own.data(), weight.data()}, coefficients, room);
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(found[4 * i + c] - exact(i, c)));
  }
  CHECK(worst < 1e-13);
}
