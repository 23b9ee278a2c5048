#include "surface_filter.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/membrane/semi_implicit_filter.hpp"

namespace rouleau::core {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Matrix>;

/// Minus the Laplacian of the mesh at rest, integrated over the nodes' areas: half the cotangents of the angles across an edge.
Matrix stiffness_of_shape(const RestSurface& rest) {
  const Mesh& mesh = rest.mesh;
  std::vector<Eigen::Triplet<double>> entries;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<int, 3>& corner = mesh.triangles()[t];
    // With the metric's inverse at rest, edges a and b from the first corner: grad of a node's hat function is constant.
    const double g11 = rest.inverse_11[t], g12 = rest.inverse_12[t], g22 = rest.inverse_22[t];
    const double with_first[3] = {g11 + 2 * g12 + g22, -(g11 + g12), -(g12 + g22)};
    const double product[3][3] = {
        {with_first[0], with_first[1], with_first[2]}, {with_first[1], g11, g12}, {with_first[2], g12, g22}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) entries.emplace_back(corner[i], corner[j], rest.triangle_area[t] * product[i][j]);
    }
  }
  Matrix matrix(mesh.node_count(), mesh.node_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Largest eigenvalue of A^-1 C: the square of the largest wave number that the mesh has, 6/l^2 of one of regular triangles.
double largest_square_of_wave_number(const Matrix& shape, const Eigen::VectorXd& area) {
  constexpr int iterations = 100;
  Eigen::VectorXd mode(area.size());
  for (int i = 0; i < mode.size(); ++i) mode[i] = i % 2 == 0 ? 1 : -1;
  double value = 0;
  for (int i = 0; i < iterations; ++i) {
    mode = (shape * mode).cwiseQuotient(area);
    value = mode.norm();
    mode /= value;
  }
  return value;
}

// The mean needs no more steps than the shortest waves that the lattice feels (KernelResponse); a fine mesh alone would give it
// very many, over which a cell that comes to rest swings. Of those of bending twice that: with less, meshes of spacings below 1
// failed at tau 0.6 with ten times the explicit limit.
constexpr double bending_felt = 2;

// Of the largest eigenvalue of a bending stiffness: one that is smaller is left to the explicit step, which bears forty times
// as much, and the filter takes a third of the time.
constexpr double least_bending = 0.25;

/// By how much the stretching and the bending stiffness pull, at most, at waves that the lattice feels; `square`: of the largest
/// wave number of the mesh.
struct Pulls {
  double stretching, bending;
  Pulls(const KernelResponse& response, double stretching_stiffness, double bending_stiffness,
        double square = std::numeric_limits<double>::infinity()) {
    const double mobility = node_mobility * response.gain;
    stretching = mobility * stretching_stiffness * std::min(square, response.stretching / response.gain);
    bending = mobility * bending_stiffness * std::min(square * square, bending_felt * response.bending / response.gain);
  }
};

}  // namespace

double largest_eigenvalue(const KernelResponse& response, double stretching, double bending) {
  const Pulls pulls(response, stretching, bending);
  return pulls.stretching + pulls.bending;
}

SurfaceFilter::SurfaceFilter(const RestSurface& rest, double viscosity, double stretching, double bending,
                             const KernelResponse& response)
    : area_(rest.node_area) {
  const Eigen::Map<const Eigen::VectorXd> area(area_.data(), static_cast<Eigen::Index>(area_.size()));
  const Matrix shape = stiffness_of_shape(rest);
  const double square = largest_square_of_wave_number(shape, area);
  const double mobility = node_mobility * response.gain;
  const Pulls pulls(response, stretching, bending, square);
  largest_ = pulls.stretching + pulls.bending;
  newest_share_ = 1 / steps_of_mean(largest_, viscosity);

  Matrix whole = mobility * stretching * shape;
  if (pulls.bending > least_bending) whole += mobility * bending * (shape * area.cwiseInverse().asDiagonal() * shape);
  whole.diagonal() += area;
  const Factors factors(whole);
  if (factors.info() != Eigen::Success) {
    throw std::invalid_argument(
        "the surface at rest has triangles without area, for which there is no semi-implicit step");
  }
  const Matrix lower = factors.matrixL();
  for (int i = 0; i < rest.mesh.node_count(); ++i) {
    place_.push_back(factors.permutationP().indices()[i]);
    inverse_.push_back(1 / factors.vectorD()[i]);
    first_.push_back(static_cast<int>(entry_.size()));
    for (Matrix::InnerIterator below(lower, i); below; ++below) {
      if (below.row() == i) continue;
      row_.push_back(static_cast<int>(below.row()));
      entry_.push_back(below.value());
    }
  }
  first_.push_back(static_cast<int>(entry_.size()));
}

void SurfaceFilter::solve(double* rows) const {
  const auto count = static_cast<int>(area_.size());
  for (int j = 0; j < count; ++j) {
    const double *const of_column = rows + 3 * j, x = of_column[0], y = of_column[1], z = of_column[2];
    for (int k = first_[j]; k < first_[j + 1]; ++k) {
      double* const row = rows + 3 * row_[k];
      row[0] -= entry_[k] * x, row[1] -= entry_[k] * y, row[2] -= entry_[k] * z;
    }
  }
  for (int j = count; j-- > 0;) {
    double* const column = rows + 3 * j;
    double x = column[0] * inverse_[j], y = column[1] * inverse_[j], z = column[2] * inverse_[j];
    for (int k = first_[j]; k < first_[j + 1]; ++k) {
      const double* const row = rows + 3 * row_[k];
      x -= entry_[k] * row[0], y -= entry_[k] * row[1], z -= entry_[k] * row[2];
    }
    column[0] = x, column[1] = y, column[2] = z;
  }
}

void SurfaceFilter::apply(const std::array<double*, 3>& force, const std::array<double*, 3>& held,
                          std::vector<double>& work) const {
  const std::size_t count = area_.size();
  work.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    double* const row = &work[3 * static_cast<std::size_t>(place_[i])];
    for (std::size_t k = 0; k < 3; ++k) {
      held[k][i] += newest_share_ * (force[k][i] - held[k][i]);
      row[k] = force[k][i] - held[k][i];
    }
  }
  solve(work.data());
  for (std::size_t i = 0; i < count; ++i) {
    const double* const row = &work[3 * static_cast<std::size_t>(place_[i])];
    for (std::size_t k = 0; k < 3; ++k) force[k][i] = held[k][i] + area_[i] * row[k];
  }
}

}  // namespace rouleau::core
