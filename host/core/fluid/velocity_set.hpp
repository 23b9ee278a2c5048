// The velocity sets of lattices. They are the SDK's, where models find them, too.
#pragma once

#include <rouleau/d2q9.hpp>
#include <rouleau/d3q19.hpp>

namespace rouleau::core {

using rouleau::D2Q9;
using rouleau::D3Q19;

}  // namespace rouleau::core
