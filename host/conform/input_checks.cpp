#include "check.hpp"

namespace rouleau::host {

std::vector<Check> input_checks() { return {}; }

}  // namespace rouleau::host
