// rouleau report DIR: the page about a run, a study or limits, or about two runs side by side, made again from the
// files there.
#include "report/report.hpp"

#include <iostream>

#include "base/error.hpp"
#include "command/process/command_line.hpp"
#include "commands.hpp"
#include "report/report_data.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

constexpr const char* report_help = R"(usage: rouleau report DIR [--out FILE]
       rouleau report --compare A B ... [--out FILE]

(Re)makes the page of what DIR holds, and prints its path: report.html from the files of a run, study.html from the
study.json of a study, limits.html from a limits.json. A page is one file that needs no network. A run that was killed
has a report too.
With --compare a page with two runs or more side by side: animations at the same strain, charts over each other, a table
of settings and results, and what differs in scenes, plugins and outcome. The runs must have ended.

Examples:
  rouleau report runs/demo
  rouleau report runs/capsule-study
  rouleau report --compare runs/demo runs/demo-2 --out comparison.html
)";

struct Options {
  std::vector<std::string> directories;
  std::string out;
  bool compare = false;
};

std::string name_of(const fs::path& directory) {
  return fs::absolute(directory / "").lexically_normal().parent_path().filename().string();
}

void check(const Options& chosen) {
  const auto refuse = [](const std::string& words) { throw Error(Cause::bad_input, "rouleau report: " + words); };
  const std::size_t count = chosen.directories.size();
  if (chosen.compare && (count < 2 || count > report::most_compared))
    refuse("--compare wants the directories of 2 to " + std::to_string(report::most_compared) + " runs; " +
           std::to_string(count) + (count == 1 ? " was given" : " were given"));
  if (!chosen.compare && count != 1) refuse("takes one directory; runs are set side by side with --compare A B");
  if (!chosen.out.empty() && !chosen.compare && !report::has_run(chosen.directories[0]))
    refuse("--out is for the report of a run; pages of studies and limits lie in their directories");
}

}  // namespace

int report_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  Options chosen;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("directory", options::value(&chosen.directories)->required(), "directory DIR");
  description.add_options()("compare", options::bool_switch(&chosen.compare), "two runs or more on one page");
  description.add_options()("out", options::value(&chosen.out)->value_name("FILE")->notifier(not_empty("--out")),
                            "file of the report (DIR/report.html) or the comparison (A-and-B.html)");
  positional.add("directory", -1);
  if (!parse_command_line("report", report_help, arguments, description, positional)) return 0;
  check(chosen);

  if (chosen.compare) {
    const std::vector<fs::path> runs(chosen.directories.begin(), chosen.directories.end());
    const std::string others = runs.size() > 2 ? std::to_string(runs.size() - 1) + "-more" : name_of(runs[1]);
    const fs::path file = chosen.out.empty() ? name_of(runs[0]) + "-and-" + others + ".html" : chosen.out;
    report::write_comparison(runs, file);
    std::cout << file.string() << "\n";
  } else if (!chosen.out.empty()) {
    std::cout << report::write_report(chosen.directories[0], chosen.out).string() << "\n";
  } else {
    for (const fs::path& page : report::write_pages(chosen.directories[0])) std::cout << page.string() << "\n";
  }
  return exit_code::done;
}

}  // namespace rouleau::command
