// Whether a finished run's files are what it wrote.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::files {

/// Text of summary.json: the summary, and under "files" the bytes and the checksum of each of these files of the
/// directory, at the end its own. Throws Error(input_output).
std::string sealed_summary(nlohmann::json summary, const std::filesystem::path& directory,
                           const std::vector<std::string>& names);

/// Puts sections into the summary.json of a finished run, whole or not at all; what it says of the other files stays.
/// Throws Error(bad_input) where it was changed since it was written, Error(input_output).
void amend_summary(const std::filesystem::path& directory, const nlohmann::json& sections);

struct Verification {
  int files = 0;                         ///< that were looked at
  std::vector<std::string> differences;  ///< one sentence each; empty: all files are as the run wrote them
};

/// Compares the files of a finished run with its summary.json, and that with its own checksum; `wanted`: only files
/// with these names. Throws Error(bad_input) for a directory whose summary.json is not there or has no checksums,
/// Error(input_output) where a file cannot be read.
Verification verify(const std::filesystem::path& directory,
                    const std::function<bool(const std::string& name)>& wanted = {});

/// The first dataset of a frame's membranes or fields with a NaN or an infinite value, in words; nothing where all are
/// finite. Throws Error(input_output).
std::optional<std::string> find_no_number_in_frames(const std::filesystem::path& frames);

}  // namespace rouleau::files
