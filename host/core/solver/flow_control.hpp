// Keeps the mean velocity of the fluid in a channel by the force that drives it.
#pragma once

#include <algorithm>
#include <numbers>
#include <optional>

namespace rouleau::core {

/// By the balance of momentum: the mean velocity u changes as du/dt = F - R, R what the walls take for each volume of
/// fluid. A look at u every so many steps tells R, the force of the time in between less what u has gained; the next
/// force is that R, and what brings u to the wanted value within a few such times. R changes slowly, cells or not, so
/// nothing has to be known of the channel and nothing swings over: in a fluid at rest 2e-3 are left after H^2/(pi^2
/// nu), in which a channel starts with a constant force to 1/e. In the end F is what the suspension needs. Lattice
/// units.
class FlowControl {
 public:
  /// `guess`: the force that would do without cells.
  FlowControl(double mean_velocity, double guess, double viscosity, double height)
      : wanted_(mean_velocity),
        interval_(std::max(
            1L, static_cast<long>(height * height / (std::numbers::pi * std::numbers::pi * viscosity) / looks))),
        state_{.force = guess, .last = {}} {}

  /// What it remembers from one look to the next.
  struct State {
    double force;
    std::optional<double> last;  ///< mean velocity at the last look
  };
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

  /// Whether it wants to know the mean velocity after so many steps.
  [[nodiscard]] bool due(long steps) const { return steps % interval_ == 0; }
  /// The force from now on, that has been told the present mean velocity (half a step of the present force in it).
  double follow(double mean_velocity) {
    const double former = state_.force, gained = mean_velocity - state_.last.value_or(mean_velocity);
    const auto interval = static_cast<double>(interval_);
    state_.force = former - gained / interval + (wanted_ - mean_velocity) / (patience * interval);
    state_.last = mean_velocity + (state_.force - former) / 2;  // with half a step of the new force
    return state_.force;
  }

 private:
  static constexpr int looks = 20;    ///< in the time in which a channel starts
  static constexpr int patience = 4;  ///< intervals in which what is missing is made good
  double wanted_;
  long interval_;  ///< steps from one look to the next
  State state_;
};

}  // namespace rouleau::core
