#include "surface_filter.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <rouleau/pack.hpp>
#include <stdexcept>

#include "core/domain/run_loop.hpp"
#include "core/membrane/semi_implicit_filter.hpp"

namespace rouleau::core {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Minus the Laplacian of the mesh at rest, integrated over the nodes' areas: half the cotangents of the angles across
/// an edge.
Matrix stiffness_of_shape(const RestSurface& rest) {
  const Mesh& mesh = rest.mesh;
  std::vector<Eigen::Triplet<double>> entries;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<int, 3>& corner = mesh.triangles()[t];
    // With the metric's inverse at rest, edges a and b from the first corner: grad of a node's hat function is
    // constant.
    const double g11 = rest.inverse_11[t], g12 = rest.inverse_12[t], g22 = rest.inverse_22[t];
    const double with_first[3] = {g11 + 2 * g12 + g22, -(g11 + g12), -(g12 + g22)};
    const double product[3][3] = {
        {with_first[0], with_first[1], with_first[2]}, {with_first[1], g11, g12}, {with_first[2], g12, g22}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) entries.emplace_back(corner[i], corner[j], rest.triangle_area[t] * product[i][j]);
  }
  Matrix matrix(mesh.node_count(), mesh.node_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Largest eigenvalue of A^-1 C: the square of the largest wave number that the mesh has, 6/l^2 of one of regular
/// triangles.
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

// The mean needs no more steps than the shortest waves that the lattice feels (KernelResponse); a fine mesh alone would
// give it very many, over which a cell that comes to rest swings. Of those of bending twice that: with less, meshes of
// spacings below 1 failed at tau 0.6 with ten times the explicit limit.
constexpr double bending_felt = 2;

// Of the largest eigenvalue of a bending stiffness: one that is smaller is left to the explicit step, which bears forty
// times as much, and the filter takes a third of the time.
constexpr double least_bending = 0.25;

/// By how much the stretching and the bending stiffness pull, at most, at waves that the lattice feels; `square`: of
/// the largest wave number of the mesh.
struct Pulls {
  double stretching, bending;
  Pulls(const KernelResponse& response, double stretching_stiffness, double bending_stiffness,
        double square = std::numeric_limits<double>::infinity()) {
    const double mobility = node_mobility * response.gain;
    stretching = mobility * stretching_stiffness * std::min(square, response.stretching / response.gain);
    bending = mobility * bending_stiffness * std::min(square * square, bending_felt * response.bending / response.gain);
  }
};

// So close is a polynomial to the inverse, as a share of its least value: the filter stays positive, and its largest
// eigenvalue times that of K is right to 1 %.
constexpr double polynomial_error = 0.005;
// Of L in a column: they take the time of one degree.
constexpr int entries_per_degree = 3;

/// Chebyshev's series of 1/(1 + a s + b s^2) for s from 0 to `largest`, as far as it takes for that; its value at 0 is
/// 1. Empty if it takes more than `most`. Trefethen, Approximation Theory and Approximation Practice (2013), chapter 3.
std::vector<double> inverse_series(double a, double b, double largest, int most) {
  const auto inverse = [=](double x) {
    const double s = largest * (1 + x) / 2;
    return 1 / (1 + a * s + b * s * s);
  };
  const int points = 4 * most;
  std::vector<double> series;
  for (int k = 0; k < points / 2; ++k) {
    double sum = 0;
    for (int j = 0; j < points; ++j) {
      const double angle = M_PI * (j + 0.5) / points;
      sum += inverse(std::cos(angle)) * std::cos(k * angle);
    }
    series.push_back((k == 0 ? 1.0 : 2.0) / points * sum);
  }
  double left_out = 0;
  while (!series.empty() && left_out + std::abs(series.back()) < polynomial_error * inverse(1)) {
    left_out += std::abs(series.back());
    series.pop_back();
  }
  if (static_cast<int>(series.size()) > most) return {};
  double at_0 = 0;
  for (std::size_t k = 0; k < series.size(); ++k) at_0 += (k % 2 == 0 ? 1 : -1) * series[k];
  for (double& coefficient : series) coefficient /= at_0;
  return series;
}

using Matrix = Eigen::SparseMatrix<double>;

struct SolveTask {
  int count;
  const int *first, *place;
  const double *entry, *inverse;
  double* rows;
};

struct Solve {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SolveTask* task) {
    using Lanes = Pack<double, 4>;
    const SolveTask t = *task;
    // A pack that is written like this is read at once; Pack(number) takes an addition more.
    const auto all = [](double number) { return Lanes(Lanes::Vector{number, number, number, number}); };
    for (int j = 0; j < t.count; ++j) {
      const Lanes of_column = Lanes::load(t.rows + 4 * j);
      for (int k = t.first[j]; k < t.first[j + 1]; ++k) {
        double* const row = t.rows + t.place[k];
        (Lanes::load(row) - all(t.entry[k]) * of_column).store(row);
      }
    }
    for (int j = t.count; j-- > 0;) {
      // Two sums take turns, since each waits for its last term.
      Lanes one = Lanes::load(t.rows + 4 * j) * all(t.inverse[j]), two = 0.0;
      int k = t.first[j];
      for (; k + 2 <= t.first[j + 1]; k += 2) {
        one -= all(t.entry[k]) * Lanes::load(t.rows + t.place[k]);
        two -= all(t.entry[k + 1]) * Lanes::load(t.rows + t.place[k + 1]);
      }
      if (k < t.first[j + 1]) one -= all(t.entry[k]) * Lanes::load(t.rows + t.place[k]);
      (one + two).store(t.rows + 4 * j);
    }
  }
};

}  // namespace

MeshInverse::MeshInverse(const Matrix& matrix) {
  const Eigen::SimplicialLDLT<Matrix> factors(matrix);
  if (factors.info() != Eigen::Success) {
    throw std::invalid_argument(
        "the surface at rest has triangles without area, for which there is no semi-implicit step");
  }
  const Matrix lower = factors.matrixL();
  for (int i = 0; i < matrix.rows(); ++i) {
    place_.push_back(factors.permutationP().indices()[i]);
    inverse_.push_back(1 / factors.vectorD()[i]);
    first_.push_back(entries());
    for (Matrix::InnerIterator below(lower, i); below; ++below) {
      if (below.row() == i) continue;
      row_.push_back(4 * static_cast<int>(below.row()));
      entry_.push_back(below.value());
    }
  }
  first_.push_back(entries());
}

void MeshInverse::solve(double* rows) const {
  run_loop<Solve>(
      SolveTask{static_cast<int>(place_.size()), first_.data(), row_.data(), entry_.data(), inverse_.data(), rows});
}

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

  const double by_square = pulls.bending > least_bending ? mobility * bending : 0;
  Matrix whole = mobility * stretching * shape;
  if (by_square > 0) whole += by_square * (shape * area.cwiseInverse().asDiagonal() * shape);
  whole.diagonal() += area;
  const MeshInverse inverse(whole);
  // The power method's value is a little less than the largest eigenvalue.
  const double bound = 1.05 * square;
  const int most = inverse.entries() / (entries_per_degree * rest.mesh.node_count());
  series_ = inverse_series(mobility * stretching, by_square, bound, std::max(1, most));
  if (series_.empty()) {
    inverse_ = inverse;
    return;
  }
  // B = (2/bound) C A^-1 - 1
  neighbours_ = neighbours_of(rest.mesh);
  const double scale = 2 / bound;
  for (int i = 0; i < rest.mesh.node_count(); ++i) {
    own_.push_back(scale * shape.coeff(i, i) / area_[i] - 1);
    for (int k = neighbours_.first[i]; k < neighbours_.first[i + 1]; ++k) {
      const int other = neighbours_.entry[k];
      weight_.push_back(scale * shape.coeff(i, other) / area_[other]);
    }
  }
}

void SurfaceFilter::apply(const std::array<double*, 3>& force, const std::array<double*, 3>& held,
                          PolynomialRoom& room) const {
  const std::size_t count = area_.size();
  room.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    double* const row = &room.value[4 * (inverse_ ? inverse_->place(i) : i)];
    for (std::size_t k = 0; k < 3; ++k) {
      held[k][i] += newest_share_ * (force[k][i] - held[k][i]);
      row[k] = force[k][i] - held[k][i];
    }
  }
  if (inverse_) {
    inverse_->solve(room.value.data());
    for (std::size_t i = 0; i < count; ++i) {
      const double* const row = &room.value[4 * inverse_->place(i)];
      for (std::size_t k = 0; k < 3; ++k) force[k][i] = held[k][i] + area_[i] * row[k];
    }
    return;
  }
  const double* const filtered = apply_polynomial(
      {static_cast<int>(count), neighbours_.first.data(), neighbours_.entry.data(), own_.data(), weight_.data()},
      series_, room);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) force[k][i] = held[k][i] + filtered[4 * i + k];
}

}  // namespace rouleau::core
