// rouleau report DIR: the page about a run, a study or limits, about two runs side by side, or pictures, made again
// from the files there.
#include "report/report.hpp"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <iostream>

#include "base/error.hpp"
#include "base/installation.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "report/report_data.hpp"
#include "report/result_page.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

constexpr const char* report_help = R"(usage: rouleau report DIR [--out FILE]
       rouleau report --compare A B ... [--out FILE]
       rouleau report DIR --frames [--strains S,S,...] [--out DIR]

(Re)makes the page of what DIR holds, and prints its path: report.html from the files of a run, study.html from the
study.json of a study, limits.html from a limits.json. A page is one file that needs no network. A run that was killed
has a report too.
With --compare a page with two runs or more side by side: animations at the same strain, charts over each other, a table
of settings and results, and what differs in scenes, plugins and outcome. The runs must have ended.
With --frames pictures (PNG) of the outputs nearest to the strains, all of them in one figure (PNG, SVG, PDF), and where
ffmpeg is installed a video of the run, frames.mp4, with 25 pictures a second.

Examples:
  rouleau report runs/demo
  rouleau report runs/capsule-study
  rouleau report --compare runs/demo runs/demo-2 --out comparison.html
  rouleau report runs/demo --frames --strains 0,5,10,15
)";

struct Options {
  std::vector<std::string> directories, strains;
  std::string out;
  bool compare = false, frames = false;
};

std::string name_of(const fs::path& directory) {
  return fs::absolute(directory / "").lexically_normal().parent_path().filename().string();
}

/// Numbers of "--strains 0,5,10", as text.
std::vector<std::string> strains_of(const std::vector<std::string>& lists) {
  std::vector<std::string> strains;
  for (const std::string& list : lists) {
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      const std::string entry = list.substr(begin, end - begin);
      double value = 0;
      const auto [last, error] = std::from_chars(entry.data(), entry.data() + entry.size(), value);
      if (error != std::errc() || last != entry.data() + entry.size() || !(value >= 0))
        throw Error(Cause::bad_input, "rouleau report --strains: " + in_quotes(entry) +
                                          " is no strain; it wants numbers from 0 with commas, for example 0,5,10");
      strains.push_back(entry);
      begin = end + 1;
    }
  }
  return strains;
}

/// Becomes the program that draws.
[[noreturn]] void draw_frames(const Options& chosen) {
  const fs::path directory = chosen.directories[0];
  const fs::path program = installation().programs / "draw-frames";
  if (!fs::exists(program))
    throw Error(Cause::input_output, Place{program.string()},
                "is not there: this rouleau was built without cairo; install libcairo2-dev and build it again");
  const std::string out =
      chosen.out.empty() ? (directory / "").lexically_normal().parent_path().string() + "-frames" : chosen.out;
  std::vector<std::string> words{program.string(), directory.string(), out};
  const auto strains = strains_of(chosen.strains);
  words.insert(words.end(), strains.begin(), strains.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  give_terminal_back();
  ::execv(program.c_str(), pointers.data());
  throw Error(Cause::input_output, program.string() + " could not be started: " + std::strerror(errno));
}

void check(const Options& chosen) {
  const auto refuse = [](const std::string& words) { throw Error(Cause::bad_input, "rouleau report: " + words); };
  const std::size_t count = chosen.directories.size();
  if (chosen.compare && chosen.frames) refuse("--compare and --frames do not go together; give one of them");
  if (chosen.compare && (count < 2 || count > report::most_compared))
    refuse("--compare wants the directories of 2 to " + std::to_string(report::most_compared) + " runs; " +
           std::to_string(count) + (count == 1 ? " was given" : " were given"));
  if (!chosen.compare && count != 1) refuse("takes one directory; runs are set side by side with --compare A B");
  if (!chosen.strains.empty() && !chosen.frames) refuse("--strains is for --frames");
  if (!chosen.out.empty() && !chosen.frames && !chosen.compare && !report::has_run(chosen.directories[0]))
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
  description.add_options()("frames", options::bool_switch(&chosen.frames), "pictures, and a video where ffmpeg is");
  description.add_options()("strains", options::value(&chosen.strains)->composing()->value_name("S,S,..."),
                            "of the pictures (six from the first to the last)");
  description.add_options()(
      "out", options::value(&chosen.out)->value_name("PATH")->notifier(not_empty("--out")),
      "file of the report (DIR/report.html) or the comparison (A-and-B.html), directory of the pictures "
      "(DIR-frames)");
  positional.add("directory", -1);
  if (!parse_command_line("report", report_help, arguments, description, positional)) return 0;
  check(chosen);
  if (chosen.frames) draw_frames(chosen);

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
