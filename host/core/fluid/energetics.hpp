// Kinetic energy and viscous dissipation of the fluid, for the energy ledger.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/domain/exact_sum.hpp"
#include "fluid_halo.hpp"
#include "fluid_state.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// Velocities of rows with a node more at both ends, and of those around the block, of three layers across the last
/// axis that follow each other.
template <int D>
class VelocityRows {
 public:
  explicit VelocityRows(const Box<D>& block) {
    stride_[0] = 1;
    for (int k = 1; k < D; ++k) stride_[k] = stride_[k - 1] * (block.size(k - 1) + 2);
    for (auto& values : values_) values.resize(static_cast<std::size_t>(stride_[D - 1]) * layers);
  }
  /// Every component of a row, at x = 0; its coordinates in [-1, size].
  [[nodiscard]] std::array<double*, D> row(std::array<int, D - 1> row) {
    row[D - 2] = (row[D - 2] + 1) % layers - 1;
    std::ptrdiff_t at = 1;
    for (int k = 1; k < D; ++k) at += stride_[k] * (row[k - 1] + 1);
    std::array<double*, D> u;
    for (int k = 0; k < D; ++k) u[k] = values_[k].data() + at;
    return u;
  }

 private:
  static constexpr int layers = 3;
  std::array<std::ptrdiff_t, D> stride_;
  std::array<std::vector<double>, D> values_;
};

/// Sums over the rows of a block, which is settled, of what Energetics has.
template <class T, class Set>
class EnergySum {
 public:
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  using Row = typename FluidState<T, Set>::Row;

  /// All ranks together. `halo`: null without other ranks. `walls`: their speeds during the last step.
  EnergySum(const FluidState<T, Set>& state, const FluidHalo<T, Set>* halo, const WallVelocity& walls);
  /// Row i; from the first one to the last.
  void add(int i);
  /// Velocities along x in the row that was added last, x = 0..nx-1; 0 in the solid.
  [[nodiscard]] const double* velocity_along_flow() const { return velocity_along_flow_; }
  /// Of all ranks together.
  [[nodiscard]] Energetics<dimension> total(const Ranks<dimension>& ranks);

 private:
  enum { kinetic, membrane_power, wall_power, dissipation, sum_of_velocity };
  void exchange_edges();
  void find_row(int from, const Row& row);
  void find_layer(int layer);
  /// The block's row at a place along an axis, which may be its own image; -1: of another block, or beyond a wall.
  [[nodiscard]] int inside(int axis, int place) const;
  void add_membrane_power(int i, const std::array<double*, dimension>& u);

  const FluidState<T, Set>& state_;
  const FluidHalo<T, Set>* halo_;
  WallVelocity walls_;
  VelocityRows<dimension> rows_;
  /// Of the nodes at borders to other blocks, which tell each other of theirs before any row is summed up.
  std::array<std::vector<double>, dimension> edge_;
  std::vector<ExactSum> sums_;
  std::vector<double> power_;  ///< of a row's nodes
  const double* velocity_along_flow_ = nullptr;
};

extern template class EnergySum<float, D2Q9>;
extern template class EnergySum<double, D2Q9>;
extern template class EnergySum<float, D3Q19>;
extern template class EnergySum<double, D3Q19>;

}  // namespace rouleau::core
