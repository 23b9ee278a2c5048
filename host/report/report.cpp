#include "report.hpp"

#include <iostream>

#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "page_file.hpp"
#include "report_compare.hpp"
#include "report_data.hpp"
#include "report_template.hpp"

namespace rouleau::report {

std::filesystem::path write_report(const std::filesystem::path& directory, std::filesystem::path file) {
  if (file.empty()) file = directory / "report.html";
  const nlohmann::json data = report_data(directory);
  for (const auto& words : data["shown"]["damage"]) std::cerr << "warning: " << words.get<std::string>() << "\n";
  files::write_file(file, page_with(report_template, data));
  return file;
}

void write_comparison(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& file) {
  files::write_file(file, page_with(report_template, compare_data(directories)));
}

}  // namespace rouleau::report
