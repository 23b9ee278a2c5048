#include "report.hpp"

#include <algorithm>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>

#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "json/shown.hpp"
#include "report_compare.hpp"
#include "report_data.hpp"
#include "report_template.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;

/// The page with what draws in space, where a run is there.
std::string report_page(Json data) {
  std::string_view space;
  const auto add = [&](const Json& run) {
    if (run.contains("domain") && run["domain"]["size_um"].size() > 2) space = space_template;
  };
  if (data.contains("runs"))
    std::for_each(data["runs"].begin(), data["runs"].end(), add);
  else
    add(data);
  constexpr std::string_view mark = "@ROULEAU_SPACE@";
  std::string page(report_template);
  page.replace(page.find(mark), mark.size(), space);
  return page_with(page, std::move(data));
}

namespace fs = std::filesystem;

/// Leaves only the names of files: a page goes to others, who need not know the folders of its author.
void remove_folders(Json& value) {
  for (auto& [key, member] : value.items()) {
    if (member.is_structured()) remove_folders(member);
    const bool names_file = key.ends_with("library") || key == "directory" || key == "file" || key.ends_with("_file");
    if (!names_file || !member.is_string()) continue;
    const fs::path path = member.get<std::string>();
    if (path.is_absolute()) member = path.filename().string();
  }
}

/// A result's file, the key that says what it is, and what it is called.
struct ResultPage {
  const char *file, *page, *key, *name;
  std::string_view page_template;
};

fs::path write_result_page(const fs::path& directory, const ResultPage& kind) {
  files::require_own(directory / kind.file);
  const json::Document document = json::Document::read(directory / kind.file);
  const auto& root = document.root();
  const Remedy remedy{"make the directory anew"};
  if (!root.is_object() || !root.contains(kind.key))
    throw Error(Cause::bad_input, document.place(""),
                "is no " + std::string(kind.name) + " result: it has no \"" + kind.key + "\"", remedy);
  const std::string pointer = std::string("/") + kind.key;
  if (root[kind.key] != 1)
    throw Error(Cause::bad_input, document.place(pointer),
                "is " + json::shown(root[kind.key]) + ", and this rouleau knows version 1 only", remedy);
  fs::path page = directory / kind.page;
  files::write_file(page, page_with(kind.page_template, root));
  return page;
}

}  // namespace

std::filesystem::path write_report(const std::filesystem::path& directory, std::filesystem::path file) {
  if (file.empty()) file = directory / "report.html";
  Json data = report_data(directory);
  for (const auto& words : data["shown"]["damage"])
    std::cerr << "warning: " << (directory / "").string() << words.get<std::string>() << "\n";
  files::write_file(file, report_page(std::move(data)));
  return file;
}

void write_comparison(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& file) {
  files::write_file(file, report_page(compare_data(directories)));
}

fs::path write_study_page(const fs::path& directory) {
  return write_result_page(directory, {"study.json", "study.html", "rouleau_study_result", "study", study_template});
}

fs::path write_limits_page(const fs::path& directory) {
  return write_result_page(directory,
                           {"limits.json", "limits.html", "rouleau_limits_result", "limits", limits_template});
}

std::vector<fs::path> write_pages(const fs::path& directory) {
  const auto has = [&](const char* file) { return fs::exists(directory / file); };
  std::vector<fs::path> pages;
  if (has("study.json")) pages.push_back(write_study_page(directory));
  if (has("limits.json")) pages.push_back(write_limits_page(directory));
  if (has_run(directory)) pages.push_back(write_report(directory));
  if (pages.empty() && !fs::exists(directory))
    throw Error(Cause::bad_input, Place{directory.string()}, "does not exist");
  if (pages.empty())
    throw Error(
        Cause::bad_input, Place{directory.string()},
        "is the directory of no run, study or limits: it has neither summary.json nor series.csv, study.json or "
        "limits.json");
  return pages;
}

std::string page_with(std::string_view page, Json data) {
  remove_folders(data);
  // "</script>" or "<!--" inside a string of the data would end the data early: "<" is written as its escape.
  // Everything the pages show is set as text, never as markup.
  std::string text;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);

  constexpr std::string_view mark = "@ROULEAU_DATA@";
  std::string result(page);
  result.replace(result.find(mark), mark.size(), text);
  return result;
}

}  // namespace rouleau::report
