#include "version.hpp"

namespace rouleau::run {

std::string program_version() { return ROULEAU_VERSION; }

}  // namespace rouleau::run
