// Whether the frames of a run hold a value that is no number.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace rouleau::files {

/// The first dataset of a frame's membranes or fields with a NaN or an infinite value, in words; nothing where all are
/// finite. Throws Error(input_output).
std::optional<std::string> find_no_number_in_frames(const std::filesystem::path& frames);

}  // namespace rouleau::files
