// The version of this program.
#pragma once

#include <string>

namespace rouleau::run {

/// Version and, in a checkout, commit that the program was built from.
std::string program_version();

}  // namespace rouleau::run
