// Where a result comes from: version of the program and machine.
#pragma once

#include <string>

namespace rouleau::host {

/// Version and, in a checkout, commit that the program was built from.
std::string program_version();
/// Processor model, number of processors, operating system.
std::string machine_description();
/// Present time, ISO 8601 in UTC.
std::string present_time();

}  // namespace rouleau::host
