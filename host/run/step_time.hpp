// What a scene's own steps take on this machine, as it is now.
#pragma once

#include "json/json.hpp"
#include "plan/estimate.hpp"

namespace rouleau::run {

/// Wall-clock times, s.
struct StepTime {
  int threads = 1;
  long steps = 0;       ///< that were taken
  double step_s = 0;    ///< of one, the mean behind the first
  double output_s = 0;  ///< of what an output measures, without writing it
  double wall_s = 0;    ///< of the whole run, as far as its steps are like the first ones
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(StepTime, threads, steps, step_s, output_s, wall_s)
};

/// Takes the first steps of a plan for about a second, three at least, and writes nothing. Memory for the run is there.
/// `estimate`: of that plan, for how many steps and outputs there are.
StepTime measure_steps(const plan::Plan& plan, const plan::Estimate& estimate, int threads);

}  // namespace rouleau::run
