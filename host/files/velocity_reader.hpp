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
  std::size_t nx, ny;
  std::vector<double> y;                       ///< heights of the rows, m
  std::vector<double> velocity_x, velocity_y;  ///< m/s, x fastest
};

/// Nothing where no frame has a velocity. Throws Error(input_output).
std::optional<VelocityField> last_velocity(const std::filesystem::path& frames);

}  // namespace rouleau::files
