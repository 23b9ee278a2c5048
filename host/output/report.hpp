// report.html: one self-contained page made from the files of a run's directory.
#pragma once

#include <filesystem>

namespace rouleau::host {

/// (Re)makes DIR/report.html from DIR's files alone. Throws Error(input_output) or, for a directory that is no run,
/// Error(bad_input).
std::filesystem::path write_report(const std::filesystem::path& directory);

}  // namespace rouleau::host
