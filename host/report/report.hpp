// report.html: one self-contained page made from the files of a run's directory, or of several.
#pragma once

#include <filesystem>
#include <vector>

namespace rouleau::report {

/// (Re)makes `file`, DIR/report.html when empty, from DIR's files alone, and returns its path. Says on the terminal
/// which of an ended run's files are damaged: the page shows what can be read. Throws Error(input_output) or, for a
/// directory that is no run, Error(bad_input).
std::filesystem::path write_report(const std::filesystem::path& directory, std::filesystem::path file = {});

inline constexpr std::size_t most_compared = 12;

/// Writes a page with runs side by side into `file`. Throws as write_report, and Error(bad_input) where a run has
/// not ended.
void write_comparison(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& file);

}  // namespace rouleau::report
