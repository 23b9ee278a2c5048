#include "run_words.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "accuracy/error_bars.hpp"
#include "base/text.hpp"
#include "command/process/terminal.hpp"
#include "observe/aggregates.hpp"
#include "report/report.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

namespace {

using Json = nlohmann::json;

std::string counted(double count, const std::string& what) {
  return number(count, 12) + " " + what + (count == 1 ? "" : "s");
}

std::string size_in_words(double bytes) {
  if (bytes < 1e6) return rounded(std::ceil(bytes / 1e3), 2) + " kB";
  return bytes < 1e9 ? rounded(bytes / 1e6, 2) + " MB" : rounded(bytes / 1e9, 2) + " GB";
}

std::string workers(int ranks, int threads) {
  return (ranks > 1 ? counted(ranks, "rank") + " with " : "") + counted(threads, "thread") + (ranks > 1 ? " each" : "");
}

using Members = std::vector<int>;

struct Event {
  double strain, time;
  std::vector<Members> aggregates;
  std::vector<Members> met_images;  ///< pairs that left each other and met by another image
  [[nodiscard]] const Members& largest() const {
    return *std::max_element(aggregates.begin(), aggregates.end(),
                             [](const Members& a, const Members& b) { return a.size() < b.size(); });
  }
  [[nodiscard]] bool holds(const Members& wanted) const {
    return std::any_of(aggregates.begin(), aggregates.end(), [&](const Members& members) {
      return std::includes(members.begin(), members.end(), wanted.begin(), wanted.end());
    });
  }
};

/// Strain says more than time once there is any.
std::string moment(const Event& event) {
  return std::abs(event.strain) > 1e-9 ? "strain " + number(event.strain, 3) : number(event.time, 3) + " s";
}

std::vector<Event> events_of(const Json& history) {
  std::vector<Event> events;
  for (const Json& entry : history) {
    if (entry.at("members").is_null()) continue;  // not kept, of many cells
    Event event{entry.at("strain"), entry.at("time_s"), entry.at(entry.contains("joined") ? "joined" : "members"),
                entry.value("met_images", std::vector<Members>())};
    for (Members& members : event.aggregates) std::sort(members.begin(), members.end());
    if (!event.aggregates.empty()) events.push_back(std::move(event));
  }
  return events;
}

using At = std::vector<Event>::const_iterator;

/// What a rouleau that is whole at the end went through since it formed.
std::string whole_in_words(At formed, At end, const Members& members) {
  const auto apart = [&](const Event& e) { return !e.holds(members); };
  const auto met = [&](const Event& e) {
    return std::find(e.met_images.begin(), e.met_images.end(), members) != e.met_images.end();
  };
  const At broke = std::find_if(formed + 1, end, apart), image = std::find_if(formed + 1, end, met);
  if (broke == end && image == end) return "; still whole at the end";
  if (image != end && image <= broke)
    return "; parted before " + moment(*image) + ", where it met an image of itself: the box is too short";
  At again = end;
  while (!apart(*(again - 1))) --again;
  return "; broke at " + moment(*broke) + "; whole again from " + moment(*again) +
         (image != end ? " by an image of itself: the box is too short" : "");
}

/// How many cells were close, where nothing joins them.
std::string closeness_in_words(std::size_t cells, std::size_t most, double gap_m) {
  const std::string gap = number(gap_m * 1e6, 3) + " um";
  if (most < 2) return "no two cells came closer than " + gap;
  return "at most " + std::to_string(most) + " of " + std::to_string(cells) + " cells were close, with gaps below " +
         gap + "; nothing attracts them to each other";
}

/// When the largest aggregate formed and broke for good, and how the cells ended; empty for fewer than two cells.
std::string aggregation_in_words(const std::vector<Event>& events, const Json& contacts) {
  if (events.empty()) return {};
  const Event& last = events.back();
  std::size_t cells = 0;
  for (const Members& members : last.aggregates) cells += members.size();
  if (cells < 2) return {};

  const auto formed = std::max_element(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return a.largest().size() < b.largest().size();
  });
  const Members members = formed->largest();
  if (contacts.at("attracting").empty()) return closeness_in_words(cells, members.size(), contacts.at("close_below_m"));
  if (members.size() < 2) return "the cells never join: all " + std::to_string(cells) + " stay single";
  std::string words = "rouleau of " + std::to_string(members.size()) +
                      (formed == events.begin() ? " from the start" : " at " + moment(*formed));
  if (last.holds(members)) return words + whole_in_words(formed, events.end(), members);

  const auto broken = std::find_if(events.rbegin(), events.rend(), [&](const Event& e) { return e.holds(members); });
  words += "; broke at " + moment(*broken.base());
  if (last.aggregates.size() < cells) {
    std::vector<std::size_t> sizes;
    for (const Members& aggregate : last.aggregates) sizes.push_back(aggregate.size());
    return words + "; " + observe::aggregates_in_words(std::move(sizes)) + " at the end";
  }
  const auto alone =
      std::find_if(events.rbegin(), events.rend(), [&](const Event& e) { return e.aggregates.size() < cells; });
  return words + "; all single from " + moment(*alone.base());
}

/// Of the last stage that has one: its mean, or why there is none.
std::string viscosity_in_words(const Json& summary) {
  const Json& stages = summary.at("rheology");
  for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
    const Json known = stage->value("/statistics/relative_viscosity"_json_pointer, Json());
    if (!known.is_object()) continue;
    const std::string in = " in " + stage->at("stage").get<std::string>();
    if (!known.at("mean").is_number())
      return "no mean of the relative viscosity" + in + ": " + known.at("verdict").get<std::string>();
    return "relative viscosity " + accuracy::with_error(known.at("mean"), known.at("bar_95")) +
           " (95 %; of chance, not of the lattice)" + in + " from " + number(known.at("from_s"), 3) + " s on";
  }
  return {};
}

}  // namespace

std::string opening(const plan::Plan& plan, const plan::PlanReport& report, int ranks, int threads, int processors,
                    const std::filesystem::path& folder) {
  const scene::Scene& scene = *plan.scene;
  std::vector<std::string> stages;
  for (const scene::Stage& stage : scene.stages) stages.push_back(stage.name);
  const plan::Estimate& estimate = report.estimate;
  std::string late;
  for (const plan::LateStart& start : report.late_starts) late += "  fluid from rest: " + plan::in_words(start) + "\n";
  return (scene.title.empty() ? "untitled scene" : scene.title) + "\n  " + scene::by_axes(scene.domain.size, 1e6, 3) +
         " um, " + scene::by_axes(scene.domain.nodes) + " nodes, " +
         counted(static_cast<double>(scene.placed().size()), "cell") +
         (scene.fed > 0 ? ", and more that come in" : "") + "; stages: " + listed(stages) + "\n  at most " +
         counted(estimate.steps, "step") + ", about " + time_in_words(estimate.wall_s / (ranks * threads)) + " on " +
         workers(ranks, threads) + " (the machine has " + counted(processors, "processor") + "), " +
         size_in_words(estimate.output.bytes()) + " of output\n" + late + "  into " + folder.string() + "\n";
}

std::vector<std::string> closing(const Json& summary) {
  std::string ended = summary.at("outcome").get<std::string>() + " in " + time_in_words(summary.at("wall_s")) + " (" +
                      workers(summary.value("ranks", 1), summary.at("threads"));
  if (summary.at("mlups").is_number()) ended += ", " + rounded(summary.at("mlups"), 3) + " MLUPS";
  ended += "): " + number(summary.at("simulated_time_s"), 3) + " s simulated";
  if (summary.at("strain").is_number() && std::abs(summary.at("strain").get<double>()) > 1e-9)
    ended += ", strain " + number(summary.at("strain"), 3);
  std::vector<std::string> lines{ended};

  const std::vector<Event> events = events_of(summary.at("aggregate_history"));
  if (const std::string words = aggregation_in_words(events, summary.at("contacts")); !words.empty())
    lines.push_back(words);
  std::string physics = viscosity_in_words(summary);
  const Json& drift = summary.at("conservation").at("area_drift_max");
  if (!events.empty() && drift.is_number())
    physics += (physics.empty() ? "" : "; ") +
               (std::string("largest ") + (summary.value("dimensions", 2) == 3 ? "volume" : "area") + " drift " +
                number(100 * drift.get<double>(), 2) + " %");
  if (!physics.empty()) lines.push_back(physics);
  return lines;
}

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
  if (summary.contains("error_bars") && summary.contains("cell_traffic") && summary["cell_traffic"]["cells_in"] != 0)
    lines.emplace_back("cells come in at other places on other lattices: the error bars have that noise in them");
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
