// The inverse of a matrix of a mesh's nodes, by its factors.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

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

}  // namespace rouleau::core
