#include "check.hpp"

namespace rouleau::host {

std::vector<Check> physics_checks() { return {}; }

}  // namespace rouleau::host
