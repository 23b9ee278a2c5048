// From positions to lattice indices, without the library calls that std::floor is on plain x86-64.
#pragma once

namespace rouleau::core {

/// Largest integer not above `value`, which must fit an int.
inline int floor_int(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

}  // namespace rouleau::core
