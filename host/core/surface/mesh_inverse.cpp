#include "mesh_inverse.hpp"

#include <Eigen/SparseCholesky>
#include <rouleau/pack.hpp>
#include <stdexcept>

#include "core/domain/run_loop.hpp"

namespace rouleau::core {

namespace {

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
    using Four = Pack<double, 4>;
    const SolveTask t = *task;
    // A pack that is written like this is read at once; Pack(number) takes an addition more.
    const auto all = [](double number) { return Four(Four::Vector{number, number, number, number}); };
    for (int j = 0; j < t.count; ++j) {
      const Four of_column = Four::load(t.rows + 4 * j);
      for (int k = t.first[j]; k < t.first[j + 1]; ++k) {
        double* const row = t.rows + t.place[k];
        (Four::load(row) - all(t.entry[k]) * of_column).store(row);
      }
    }
    for (int j = t.count; j-- > 0;) {
      // Two sums take turns, since each waits for its last term.
      Four one = Four::load(t.rows + 4 * j) * all(t.inverse[j]), two = 0.0;
      int k = t.first[j];
      for (; k + 2 <= t.first[j + 1]; k += 2) {
        one -= all(t.entry[k]) * Four::load(t.rows + t.place[k]);
        two -= all(t.entry[k + 1]) * Four::load(t.rows + t.place[k + 1]);
      }
      if (k < t.first[j + 1]) one -= all(t.entry[k]) * Four::load(t.rows + t.place[k]);
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

}  // namespace rouleau::core
