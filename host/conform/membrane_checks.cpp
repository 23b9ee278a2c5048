#include "check.hpp"

namespace rouleau::host {

std::vector<Check> membrane_checks() { return {}; }

}  // namespace rouleau::host
