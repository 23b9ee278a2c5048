#include "output/report.hpp"

#include <string>
#include <string_view>

#include "output/report_data.hpp"
#include "output/report_template.hpp"
#include "output/run_directory.hpp"

namespace rouleau::host {

std::filesystem::path write_report(const std::filesystem::path& directory) {
  // "</script>" or "<!--" inside a string of the data would end the data early: "<" is written as its escape.
  // Everything the page shows is set as text, never as markup.
  std::string data;
  for (const char c : report_data(directory).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    data += c == '<' ? std::string("\\u003c") : std::string(1, c);

  constexpr std::string_view mark = "@ROULEAU_DATA@";
  std::string page(report_template);
  page.replace(page.find(mark), mark.size(), data);
  auto file = directory / "report.html";
  write_file(file, page);
  return file;
}

}  // namespace rouleau::host
