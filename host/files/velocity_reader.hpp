// The last velocity field of a run, read back from its frames.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace rouleau::files {

struct VelocityField {
  double time;        ///< s
  std::size_t stage;  ///< number of the scene's stage
  std::size_t nx;
  std::vector<double> y, z;      ///< of the rows, m; in two dimensions one z, 0
  std::vector<double> velocity;  ///< m/s, three components beside each other, then x, y, z
};

/// Nothing where no frame has a velocity. Throws Error(input_output).
std::optional<VelocityField> last_velocity(const std::filesystem::path& frames);

}  // namespace rouleau::files
