// The fluid as somebody would write it who needs one operator only: two-relaxation-time collision compiled into the
// loop over the same in-place lattice. What a plugin costs is the difference.
#pragma once

#include <functional>

#include "base/worker.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/lattice.hpp"
#include "core/fluid/periodic.hpp"

namespace rouleau::bench {

/// What is done to the populations of a node.
enum class Kernel {
  move,    ///< nothing: they only travel, which is what memory allows
  plain,   ///< collision, Stokes flow
  forced,  ///< collision with a force density, over which the velocity is written, its halo included
};

template <class T>
class BareFluid {
 public:
  BareFluid(Kernel kernel, int nx, int ny, double relaxation_rate, double magic, core::WallVelocity walls);

  /// Sets populations, deviations from rest, before the first step.
  void set(const std::function<double(int q, int x, int y)>& population);
  /// The same state as other's, which must be between an even number of steps.
  [[nodiscard]] double population(int q, int x, int y) const;
  [[nodiscard]] core::VectorField<T, 2>& force() { return force_; }

  [[nodiscard]] rouleau::Range rows() const { return {0, lattice_.size(1)}; }
  void step(rouleau::Range rows);
  void end_step() { parity_ = core::next(parity_); }

 private:
  Kernel kernel_;
  T relaxation_rate_, magic_;
  core::WallVelocity walls_;
  core::Lattice<T, core::D2Q9> lattice_;
  core::VectorField<T, 2> force_;
  core::Parity parity_ = core::Parity::even;
};

extern template class BareFluid<float>;
extern template class BareFluid<double>;

}  // namespace rouleau::bench
