// Whether cells have come to an equilibrium: their energy has hardly changed within a window of time.
#pragma once

#include <cmath>

#include "json/json.hpp"

namespace rouleau::monitor {

/// Compares the energy at the end of a window with that at its start; windows follow one another. All energies in one
/// unit, times in steps.
class EquilibriumWatch {
 public:
  /// Nothing is known yet.
  void start() { *this = {}; }
  /// First step at which the energy is wanted again.
  [[nodiscard]] long next(long window) const { return known_ ? step_ + window : 0; }
  /// `magnitude`: what the energy's change is compared with; `least_rate`: its relative change in a step below which
  /// there is an equilibrium.
  void note(long step, double energy, double magnitude, double least_rate) {
    if (known_) {
      const double change = std::abs(energy - energy_);
      reached_ = change <= least_rate * static_cast<double>(step - step_) * magnitude;
    }
    known_ = true;
    step_ = step;
    energy_ = energy;
  }
  [[nodiscard]] bool reached() const { return reached_; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(EquilibriumWatch, step_, known_, reached_, energy_)

 private:
  long step_ = 0;
  bool known_ = false, reached_ = false;
  double energy_ = 0;
};

}  // namespace rouleau::monitor
