// The program that draws frames of a run; `rouleau report DIR --frames` becomes it. It is a program of its own so that
// what it draws with (cairo) is never part of the one that simulates.
//
// usage: draw-frames DIR OUT [STRAIN...]
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "command/process/program.hpp"
#include "files/csv_reader.hpp"
#include "files/file.hpp"
#include "files/frames.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "observe/aggregate_words.hpp"
#include "report/draw/figure.hpp"
#include "report/draw/flow_reader.hpp"
#include "report/draw/frame_choice.hpp"
#include "report/draw/video.hpp"

namespace {

using nlohmann::literals::operator""_json_pointer;
using rouleau::Cause;
using rouleau::Error;
using rouleau::Place;
namespace files = rouleau::files;
namespace report = rouleau::report;
namespace fs = std::filesystem;

constexpr std::size_t default_frames = 6, columns = 3;  // as in docs/pictures
constexpr int frame_width = 960, panel_width = 420;
constexpr int video_seconds = 12, frames_per_second = 25;
constexpr int most_between = 12;       ///< pictures of the video from one output to the next
constexpr double tracers_seconds = 1;  ///< of the video that a line of the flow lives

std::string number(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  std::string digits = text.str();
  if (digits.find('.') != std::string::npos) digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

/// Outlines between two outputs, `share` of the way; the nearer ones where their nodes do not correspond.
rouleau::observe::OutlineSnapshot between(rouleau::observe::OutlineSnapshot a,
                                          const rouleau::observe::OutlineSnapshot& b, double share) {
  if (a.first != b.first) return share < 0.5 ? a : b;
  for (std::size_t i = 0; i < a.x.size(); ++i) {
    a.x[i] += share * (b.x[i] - a.x[i]);
    a.y[i] += share * (b.y[i] - a.y[i]);
  }
  return a;
}

/// What a run's directory says about its outputs, and the outlines and the flow of each.
class Run {
 public:
  explicit Run(const fs::path& directory)
      : series_(table(directory)), reader_(directory / "frames.h5"), flow_(directory / "frames.h5") {
    times_ = {series_.numbers("strain"), series_.numbers("time_s")};
    steps_ = series_.numbers("step");
    if (joins_all(directory / "summary.json")) sizes_ = aggregate_sizes(directory / "aggregates.csv");
    stages_ = series_.texts("stage_name");
    if (series_.has("shear_rate_1_per_s")) shear_rate_ = series_.numbers("shear_rate_1_per_s");
    const auto frames = std::min(series_.rows(), static_cast<std::size_t>(reader_.frames()));  // of a killed run
    times_.strain.resize(frames);
    times_.time_s.resize(frames);
    if (frames == 0) throw Error(Cause::bad_input, Place{directory.string()}, "has no outputs to draw");
  }

  [[nodiscard]] const report::OutputTimes& times() const { return times_; }
  [[nodiscard]] report::PanelBox box() const { return {reader_.size(), reader_.periodic_y()}; }
  /// The run at an output, or with a fraction between two. Of a video of which a picture takes `outputs_each`.
  [[nodiscard]] report::Panel panel(double position, double outputs_each = 0) {
    const auto low = static_cast<std::size_t>(position), high = std::min(low + 1, times_.strain.size() - 1);
    const double share = high > low ? position - double(low) : 0;
    const auto near = share < 0.5 ? low : high;
    const auto first = reader_.outlines(static_cast<int>(low));
    report::Panel panel{caption(near, first.first.size()),
                        share > 0 ? between(first, reader_.outlines(static_cast<int>(high)), share) : first};
    if (const report::BlockVelocity* velocity = flow_.at(near); velocity != nullptr && flow_holds(near)) {
      const double life = outputs_each > 0 ? outputs_each * frames_per_second * tracers_seconds : lone_life();
      panel.flow = report::flow_lines(*velocity, position / life, life * seconds_each(near));
    }
    if (near < shear_rate_.size() && std::isfinite(shear_rate_[near]) && !box().periodic_y) {
      const double half = reader_.size()[1] / 2,
                   strain = times_.strain[low] + share * (times_.strain[high] - times_.strain[low]);
      panel.walls = {{-half * shear_rate_[near], half * shear_rate_[near]}, {-half * strain, half * strain}};
    }
    return panel;
  }
  /// "strain 7.5", or where the strain never grows "2.1 s".
  [[nodiscard]] std::string instant(std::size_t output) const { return words(output, times_.sheared()); }

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
  [[nodiscard]] std::string words(std::size_t output, bool by_strain) const {
    return by_strain ? "strain " + number(times_.strain[output], 2) : number(times_.time_s[output], 4) + " s";
  }
  /// Whether the strain grows in the stage of an output; of the first output, in the run.
  [[nodiscard]] bool grows(std::size_t output) const {
    const auto [begin, end] = stage(output);
    return times_.sheared() && times_.strain[end] > times_.strain[begin];
  }
  /// First and last output of the stage that has `output`; the first is the one with which the stage begins.
  [[nodiscard]] std::pair<std::size_t, std::size_t> stage(std::size_t output) const {
    std::size_t begin = output, end = output;
    while (begin > 0 && stages_[begin] == stages_[output]) --begin;
    while (end + 1 < times_.strain.size() && stages_[end + 1] == stages_[output]) ++end;
    return {begin, end};
  }
  /// Simulated seconds from one output to the next.
  [[nodiscard]] double seconds_each(std::size_t output) const {
    const auto [begin, end] = stage(output);
    return (times_.time_s[end] - times_.time_s[begin]) / std::max(1.0, double(end - begin));
  }
  /// Outputs that a line of the flow lives in a picture by itself.
  [[nodiscard]] double lone_life() const {
    return std::max(1.0, double(times_.strain.size()) * tracers_seconds / video_seconds);
  }
  /// Whether the last field written belongs to the stage of `output`: that of another says nothing of this one.
  [[nodiscard]] bool flow_holds(std::size_t output) const { return stages_[flow_.read_output()] == stages_[output]; }
  /// "shear: strain 7.5, a rouleau of 3 cells and 1 single cell".
  [[nodiscard]] std::string caption(std::size_t output, std::size_t firsts) const {
    std::string instant = stages_[output] + ": " + words(output, grows(output));
    const auto sizes = sizes_.find(steps_[output]);
    if (firsts < 3 || sizes == sizes_.end()) return instant;
    return instant + ", " + rouleau::observe::aggregates_in_words(sizes->second);
  }
  /// Whether cells that are close are joined, all of them: where not, they are no rouleaux.
  static bool joins_all(const fs::path& file) {
    if (!fs::exists(file)) return false;
    const nlohmann::json summary = rouleau::json::Document::read(file).root();
    if (summary.value("/contacts/attracting"_json_pointer, nlohmann::json::array()).empty()) return false;
    const nlohmann::json& history = summary.at("aggregate_history");
    return std::none_of(history.begin(), history.end(), [](const auto& event) { return event.contains("joined"); });
  }
  /// Number of cells of each aggregate by step: aggregates.csv has a row for every contact.
  static std::map<double, std::vector<std::size_t>> aggregate_sizes(const fs::path& file) {
    std::map<double, std::vector<std::size_t>> sizes;
    if (!fs::exists(file)) return sizes;
    const files::StoredTable table(file);
    const auto steps = table.numbers("step"), labels = table.numbers("aggregate");
    const auto members = table.texts("members");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (row > 0 && steps[row] == steps[row - 1] && labels[row] == labels[row - 1]) continue;
      const auto joints = std::count(members[row].begin(), members[row].end(), '+');
      sizes[steps[row]].push_back(1 + static_cast<std::size_t>(joints));
    }
    return sizes;
  }
  files::StoredTable series_;
  files::FrameReader reader_;
  report::FlowReader flow_;
  std::vector<std::string> stages_;
  std::vector<double> shear_rate_;
  report::OutputTimes times_;
  std::vector<double> steps_;
  std::map<double, std::vector<std::size_t>> sizes_;
};

std::string file_name(std::size_t place, std::string instant) {
  std::replace(instant.begin(), instant.end(), ' ', '-');
  const std::string digits = std::to_string(place);
  return (digits.size() < 2 ? "0" : "") + digits + "-" + instant + ".png";
}

void draw(const fs::path& directory, const fs::path& out, const std::vector<double>& strains) {
  Run run(directory);
  const auto chosen =
      strains.empty() ? report::even_outputs(run.times(), default_frames) : report::outputs_at(run.times(), strains);
  std::error_code error;
  fs::create_directories(out, error);
  if (error) rouleau::fail_file(out, "cannot be made", error.value());
  const auto write = [&](const std::string& name, const std::string& bytes) {
    files::write_file(out / name, bytes);
    std::cout << (out / name).string() << '\n' << std::flush;
  };
  std::vector<report::Panel> panels;
  for (const std::size_t output : chosen) {
    panels.push_back(run.panel(double(output)));
    write(file_name(panels.size(), run.instant(output)),
          report::draw_panels(run.box(), {panels.back()}, 1, frame_width));
  }
  using report::PictureFormat;
  for (const auto& [name, format] : {std::pair("figure.png", PictureFormat::png),
                                     {"figure.svg", PictureFormat::svg},
                                     {"figure.pdf", PictureFormat::pdf}})
    write(name, report::draw_panels(run.box(), panels, columns, panel_width, format));

  // The video has the whole run, a stage at rest included, unless strains were named.
  const double first = strains.empty() ? 0 : double(chosen.front());
  const double last = strains.empty() ? double(run.times().strain.size() - 1) : double(chosen.back());
  if (last - first < 1) return;
  const int pictures = std::min(video_seconds * frames_per_second, int(most_between * (last - first)) + 1);
  const double each = (last - first) / (pictures - 1);
  int next = 0;
  const auto picture = [&]() -> std::optional<std::string> {
    if (next == pictures) return std::nullopt;
    const double position = std::min(last, first + each * next++);
    return report::draw_panels(run.box(), {run.panel(position, each)}, 1, frame_width, PictureFormat::pixels);
  };
  const auto size = report::picture_size(run.box(), 1, 1, frame_width);
  if (report::write_video(out / "frames.mp4", size, frames_per_second, picture))
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
