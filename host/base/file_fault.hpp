// Failures of files in words for the user.
#pragma once

#include <filesystem>
#include <string>

namespace rouleau {

/// Throws Error(input_output): the path, what was tried ("cannot be written"), the system's words for `error` (an
/// errno) and what the user can do about it.
[[noreturn]] void fail_file(const std::filesystem::path& file, const std::string& what, int error);

/// The same for a file that cannot be read.
[[noreturn]] void fail_reading(const std::filesystem::path& file, int error);

}  // namespace rouleau
