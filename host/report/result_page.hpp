// study.html and limits.html: self-contained pages made from study.json and limits.json alone.
#pragma once

#include <filesystem>
#include <vector>

namespace rouleau::report {

/// (Re)makes DIR/study.html from DIR/study.json. Throws Error(input_output), and Error(bad_input) for a file that is
/// no result of `rouleau study`, or one of another version.
std::filesystem::path write_study_page(const std::filesystem::path& directory);

/// (Re)makes DIR/limits.html from DIR/limits.json. Throws as write_study_page.
std::filesystem::path write_limits_page(const std::filesystem::path& directory);

/// (Re)makes the page of every result that a directory holds: a study's, a limits', a run's. Throws as these, and
/// Error(bad_input) for a directory with none of them.
std::vector<std::filesystem::path> write_pages(const std::filesystem::path& directory);

}  // namespace rouleau::report
