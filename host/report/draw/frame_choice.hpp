// Which outputs of a run are drawn as frames.
#pragma once

#include <cstddef>
#include <vector>

namespace rouleau::report {

/// Outputs of a run by number: strain and time of each.
struct OutputTimes {
  std::vector<double> strain;
  std::vector<double> time_s;
  [[nodiscard]] bool sheared() const;  ///< the strain grows
};

/// The outputs nearest to these strains, in the order of the run and each once; of outputs at the same strain, such as
/// those of a stage at rest, the last. Throws Error(bad_input) for a strain that the run did not reach, and when the
/// strain does not grow at all.
std::vector<std::size_t> outputs_at(const OutputTimes& outputs, const std::vector<double>& strains);

/// `count` outputs from the first to the last: at even strains, or where the strain does not grow at even numbers.
std::vector<std::size_t> even_outputs(const OutputTimes& outputs, std::size_t count);

}  // namespace rouleau::report
