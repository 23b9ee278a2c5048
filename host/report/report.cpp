#include "report.hpp"

#include <iostream>
#include <string>
#include <string_view>

#include "base/text.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "json/shown.hpp"
#include "report_compare.hpp"
#include "report_data.hpp"
#include "report_template.hpp"

namespace rouleau::report {

namespace {

/// The page with what draws surfaces, where there are some.
std::string report_page(const nlohmann::json& data) {
  const bool has_surfaces = data.contains("surfaces") && !data["surfaces"].is_null();
  constexpr std::string_view mark = "@ROULEAU_SPACE@";
  std::string page(report_template);
  page.replace(page.find(mark), mark.size(), has_surfaces ? space_template : std::string_view{});
  return page_with(page, data);
}

namespace fs = std::filesystem;

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
  const nlohmann::json data = report_data(directory);
  for (const auto& words : data["shown"]["damage"]) std::cerr << "warning: " << words.get<std::string>() << "\n";
  files::write_file(file, report_page(data));
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

std::string page_with(std::string_view page, const nlohmann::json& data) {
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
