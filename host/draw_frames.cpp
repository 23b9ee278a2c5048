// The program that draws frames of a run; `rouleau report DIR --frames` becomes it. It is a program of its own so that
// what it draws with (cairo) is never part of the one that simulates.
//
// usage: draw-frames DIR OUT [STRAIN...]
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <system_error>

#include "base/error.hpp"
#include "command/program.hpp"
#include "files/csv_reader.hpp"
#include "files/file.hpp"
#include "files/frames.hpp"
#include "files/run_directory.hpp"
#include "report/draw/figure.hpp"
#include "report/draw/frame_choice.hpp"
#include "report/draw/video.hpp"

namespace {

using rouleau::Cause;
using rouleau::Error;
using rouleau::Place;
namespace files = rouleau::files;
namespace report = rouleau::report;
namespace fs = std::filesystem;

constexpr std::size_t default_frames = 6, columns = 3;  // as in docs/pictures
constexpr int frame_width = 960, panel_width = 420;
constexpr int video_seconds = 12;

std::string number(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  std::string digits = text.str();
  if (digits.find('.') != std::string::npos) digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

/// What a run's directory says about its outputs, and the outlines of each.
class Run {
 public:
  explicit Run(const fs::path& directory) : series_(table(directory)), reader_(directory / "frames.h5") {
    times_ = {series_.numbers("strain"), series_.numbers("time_s")};
    aggregates_ = series_.numbers("aggregate_count");
    const auto frames = std::min(series_.rows(), static_cast<std::size_t>(reader_.frames()));  // of a killed run
    times_.strain.resize(frames);
    times_.time_s.resize(frames);
    if (frames == 0) throw Error(Cause::bad_input, Place{directory.string()}, "has no outputs to draw");
  }

  [[nodiscard]] const report::OutputTimes& times() const { return times_; }
  [[nodiscard]] report::PanelBox box() const { return {reader_.size(), reader_.periodic_y()}; }
  [[nodiscard]] report::Panel panel(std::size_t output) const {
    const auto outlines = reader_.outlines(static_cast<int>(output));
    const auto count = static_cast<long>(aggregates_[output]);
    const std::string held =
        outlines.first.empty() ? "" : ", " + std::to_string(count) + (count == 1 ? " aggregate" : " aggregates");
    return {instant(output) + held, outlines};
  }
  /// "strain 7.5", or where the strain does not grow "2.1 s".
  [[nodiscard]] std::string instant(std::size_t output) const {
    return times_.sheared() ? "strain " + number(times_.strain[output], 2) : number(times_.time_s[output], 4) + " s";
  }

 private:
  static files::StoredTable table(const fs::path& directory) {
    if (!fs::exists(directory / "series.csv"))
      throw Error(Cause::bad_input, Place{directory.string()},
                  fs::exists(directory) ? "is no run's directory: it has no series.csv" : "does not exist");
    if (!fs::exists(directory / "frames.h5") && !fs::exists(directory / "frames-0001.h5"))
      throw Error(Cause::bad_input, Place{(directory / "frames.h5").string()},
                  "is missing: pictures are drawn from it; bring it back, or run the scene again");
    return files::StoredTable(directory / "series.csv");
  }
  files::StoredTable series_;
  files::FrameReader reader_;
  report::OutputTimes times_;
  std::vector<double> aggregates_;
};

std::string file_name(std::size_t place, std::string instant) {
  std::replace(instant.begin(), instant.end(), ' ', '-');
  const std::string digits = std::to_string(place);
  return (digits.size() < 2 ? "0" : "") + digits + "-" + instant + ".png";
}

void draw(const fs::path& directory, const fs::path& out, const std::vector<double>& strains) {
  const Run run(directory);
  const auto chosen =
      strains.empty() ? report::even_outputs(run.times(), default_frames) : report::outputs_at(run.times(), strains);
  std::error_code error;
  fs::create_directories(out, error);
  if (error) files::fail_file(out, "cannot be made", error.value());
  const auto write = [&](const std::string& name, const std::string& bytes) {
    files::write_file(out / name, bytes);
    std::cout << (out / name).string() << '\n' << std::flush;
  };
  std::vector<report::Panel> panels;
  for (const std::size_t output : chosen) {
    panels.push_back(run.panel(output));
    write(file_name(panels.size(), run.instant(output)),
          report::draw_panels(run.box(), {panels.back()}, 1, frame_width));
  }
  write("figure.png", report::draw_panels(run.box(), panels, columns, panel_width));

  const std::size_t outputs = chosen.back() - chosen.front() + 1;
  if (outputs < 2) return;
  std::size_t next = chosen.front();
  const int per_second = std::clamp(static_cast<int>(outputs) / video_seconds, 5, 30);
  const auto picture = [&]() -> std::optional<std::string> {
    if (next > chosen.back()) return std::nullopt;
    return report::draw_panels(run.box(), {run.panel(next++)}, 1, frame_width);
  };
  if (report::write_video(out / "frames.mp4", per_second, picture))
    std::cout << (out / "frames.mp4").string() << '\n';
  else
    std::cout << "no video, because there is no ffmpeg (Debian: apt-get install ffmpeg)\n";
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::cerr << "usage: draw-frames DIR OUT [STRAIN...]\nrouleau report DIR --frames starts this program\n";
    return rouleau::command::exit_code::bad_input;
  }
  const report::Drawing drawing;
  const auto body = [&] {
    std::vector<double> strains;
    for (int i = 3; i < count; ++i) strains.push_back(std::strtod(words[i], nullptr));
    draw(words[1], words[2], strains);
    return rouleau::command::exit_code::done;
  };
  return rouleau::command::run_program(body, " to draw frames");
}
