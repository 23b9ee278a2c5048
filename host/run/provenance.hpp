// Where a result comes from: scene, models, version of the program, machine.
#pragma once

#include <string>

#include "summary.hpp"

namespace rouleau::run {

struct Machine {
  std::string processor;  ///< model
  unsigned processors;    ///< that the program may use
  long memory_bytes;
  std::string system;    ///< name, release, architecture
  std::string compiler;  ///< that the program was built with
};
Machine this_machine();
/// Processor model, number of processors, operating system.
std::string machine_description();
/// Present time, ISO 8601 in UTC.
std::string present_time();
/// Largest resident memory of this process so far.
long peak_memory_bytes();

/// The part of a summary that is known before the first step: scene, models with their hashes, plan, machine.
Summary describe(const plan::Plan& plan, const plan::PlanReport& report, int threads);

/// Version and, in a checkout, commit that the program was built from.
std::string program_version();

}  // namespace rouleau::run
