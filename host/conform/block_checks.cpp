#include "check.hpp"

namespace rouleau::host {

std::vector<Check> block_checks() { return {}; }

}  // namespace rouleau::host
