#include "output/report.hpp"

#include <iostream>

#include "output/page_file.hpp"
#include "output/report_compare.hpp"
#include "output/report_data.hpp"
#include "output/report_template.hpp"
#include "output/run_directory.hpp"

namespace rouleau::host {

std::filesystem::path write_report(const std::filesystem::path& directory, std::filesystem::path file) {
  if (file.empty()) file = directory / "report.html";
  const nlohmann::json data = report_data(directory);
  for (const auto& words : data["shown"]["damage"]) std::cerr << "warning: " << words.get<std::string>() << "\n";
  write_file(file, page_with(report_template, data));
  return file;
}

void write_comparison(const std::filesystem::path& a, const std::filesystem::path& b,
                      const std::filesystem::path& file) {
  write_file(file, page_with(report_template, compare_data(a, b)));
}

}  // namespace rouleau::host
