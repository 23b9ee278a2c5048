#include "report.hpp"

#include <iostream>

#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "page_file.hpp"
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

}  // namespace rouleau::report
