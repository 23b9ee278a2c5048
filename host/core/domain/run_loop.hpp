// Calls a loop over arrays in the variant for this processor.
#pragma once

#include <cstddef>
#include <iterator>
#include <rouleau/dispatch.hpp>

namespace rouleau::core {

/// Loop::run<bytes>(&arrays), compiled for the widest registers there are (Dispatch).
template <class Loop, class Arrays>
void run_loop(const Arrays& arrays) {
  static const auto function = Dispatch<Loop, const Arrays*>::pick();
  function(&arrays);
}

/// Makes pointers point into as many arrays, so many elements behind their beginning.
void point_into(auto& pointers, auto& arrays, std::size_t offset = 0) {
  for (std::size_t k = 0; k < std::size(pointers); ++k) pointers[k] = arrays[k].data() + offset;
}

}  // namespace rouleau::core
