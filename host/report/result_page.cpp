#include "result_page.hpp"

#include <string>
#include <string_view>

#include "base/text.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "json/shown.hpp"
#include "page_file.hpp"
#include "report.hpp"
#include "report_data.hpp"
#include "report_template.hpp"

namespace rouleau::report {

namespace {

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

}  // namespace rouleau::report
