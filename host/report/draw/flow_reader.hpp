// The velocity that a run wrote, for pictures of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "flow_lines.hpp"
#include "hdf5/hdf5_file.hpp"

namespace rouleau::report {

/// The velocity fields of a frames.h5, means over few blocks. Throws Error(input_output).
class FlowReader {
 public:
  explicit FlowReader(const std::filesystem::path& frames);
  /// Whether there is any velocity in the file.
  [[nodiscard]] bool empty() const { return outputs_.empty(); }
  /// The velocity of the last output with one at or before `output`; null before the first. Valid until the next call.
  const BlockVelocity* at(std::size_t output);
  /// The output that the last call found.
  [[nodiscard]] std::size_t read_output() const { return read_; }

 private:
  hdf5::File file_;
  std::vector<std::size_t> outputs_;
  std::size_t read_ = 0;
  BlockVelocity velocity_;
};

}  // namespace rouleau::report
