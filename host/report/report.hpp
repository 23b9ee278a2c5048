// report.html of a run, and the pages of a study and of limits, made again from the files there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "json/json.hpp"

namespace rouleau::report {

/// (Re)makes DIR/study.html from DIR/study.json. Throws Error(input_output), and Error(bad_input) for a file that is
/// no result of `rouleau study`, or one of another version.
std::filesystem::path write_study_page(const std::filesystem::path& directory);

/// (Re)makes DIR/limits.html from DIR/limits.json. Throws as write_study_page.
std::filesystem::path write_limits_page(const std::filesystem::path& directory);

/// (Re)makes the page of every result that a directory holds: a study's, a limits', a run's. Throws as these, and
/// Error(bad_input) for a directory with none of them.
std::vector<std::filesystem::path> write_pages(const std::filesystem::path& directory);

/// `page` with its mark for the data replaced by `data`, in such a way that no text in the data can end it early or
/// become markup; of absolute paths to files their names alone.
std::string page_with(std::string_view page, nlohmann::json data);

/// (Re)makes `file`, DIR/report.html when empty, from DIR's files alone, and returns its path. Says on the terminal
/// which of an ended run's files are damaged: the page shows what can be read. Throws Error(input_output) or, for a
/// directory that is no run, Error(bad_input).
std::filesystem::path write_report(const std::filesystem::path& directory, std::filesystem::path file = {});

inline constexpr std::size_t most_compared = 12;

/// Writes a page with runs side by side into `file`. Throws as write_report, and Error(bad_input) where a run has
/// not ended.
void write_comparison(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& file);

}  // namespace rouleau::report
