#include "close_run.hpp"

#include <cmath>
#include <iostream>

#include "command/process/terminal.hpp"
#include "report/report.hpp"
#include "run_words.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

std::vector<std::string> in_words(const accuracy::MeasuredErrors& errors) {
  if (!errors.missing.empty()) return {"no error bars: " + errors.missing};
  std::vector<std::string> lines = accuracy::sentences(errors.bars);
  lines.push_back("error bars took " + std::to_string(std::lround(100 * errors.share)) +
                  " % of the run's time; summary.json has all " + std::to_string(errors.bars.size()));
  return lines;
}

void close_run(const std::filesystem::path& folder, const std::vector<std::string>& more) {
  const std::filesystem::path page = report::write_report(folder);
  const nlohmann::json summary = trial::read_summary(folder);
  std::vector<std::string> lines = closing(summary);
  {
    const Coloured status(std::cout, summary.at("status") == "completed" ? Colour::green : Colour::red);
    std::cout << lines.front();
  }
  std::cout << "\n";
  lines.erase(lines.begin());
  lines.insert(lines.end(), more.begin(), more.end());
  for (const std::string& line : lines) std::cout << line << "\n";
  std::cout << "report: " << page.string() << "\n" << std::flush;  // before what std::cerr may have to add
}

void say(const monitor::Failure& failure) {
  {
    const Coloured red(std::cerr, Colour::red);
    std::cerr << failure.reason << " at step " << failure.step << ", strain " << failure.strain;
    if (failure.cell >= 0) std::cerr << ", cell " << failure.cell;
    std::cerr << ", place (" << failure.place[0] * 1e6 << ", " << failure.place[1] * 1e6 << ") um";
  }
  std::cerr << "\n  " << failure.message << "\n  found " << failure.value << ", limit " << failure.limit << "\n  "
            << failure.remedy << "\n";
}

}  // namespace rouleau::command
