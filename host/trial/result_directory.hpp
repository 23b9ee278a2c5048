// The directory that a command fills with many runs and what they came to, and what the files of study and limits
// share.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "file_lock.hpp"
#include "matrix.hpp"

namespace rouleau::trial {

/// Whose directory it is, for the messages.
struct ResultKind {
  const char* file;     ///< that it holds: "study.json"
  const char* command;  ///< "no COMMAND wrote"
  const char* program;  ///< "another PROGRAM is writing"
};

/// Makes the directory with its folder points/, or takes the one that the same command has left, and locks it. Throws
/// Error(bad_input) for a directory with other files, or that another process has locked.
void take_result_directory(const std::filesystem::path& directory, const ResultKind& kind,
                           std::optional<FileLock>& lock);

/// this_machine(): {cpu, cores, memory_bytes, system, compiler}.
nlohmann::json machine_json();
/// [{name, labels, positions}]; a position that is no number is null.
nlohmann::json axes_json(const std::vector<Axis>& axes);

}  // namespace rouleau::trial
