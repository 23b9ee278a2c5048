#include "check.hpp"

namespace rouleau::host {

std::vector<Check> collision_checks() { return {}; }

}  // namespace rouleau::host
