#include "check.hpp"

namespace rouleau::host {

std::vector<Check> interaction_checks() { return {}; }

}  // namespace rouleau::host
