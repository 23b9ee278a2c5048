#include "scene_options.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <latch>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/crew.hpp"
#include "manage_plugins.hpp"
#include "plan/placed_cells.hpp"
#include "scene/scene.hpp"

namespace rouleau::command {

namespace options = boost::program_options;

void SceneOptions::add_to(options::options_description& description,
                          options::positional_options_description& positional) {
  description.add_options()("scene", options::value(&scene)->required(), "SCENE file (JSON)")(
      "set", options::value(&overrides)->composing()->value_name("POINTER=VALUE"),
      "replace a value of the scene, e.g. --set /numerics/tau=0.8 (repeatable; any JSON value)")(
      "plugin-dir", options::value(&plugin_dirs)->composing()->value_name("DIR"),
      "search this folder for plugins first (repeatable)")(
      "lock", options::value(&lock)->value_name("FILE")->notifier(not_empty("--lock")),
      "use only the plugins of this lock (default: NAME.lock.json beside the scene NAME.json, if it is there)")(
      "no-scene-plugins", options::bool_switch(&without_its_plugins)->notifier([](bool given) {
        if (given) ::setenv("ROULEAU_SCENE_PLUGINS", "no", 1);
      }),
      "do not search folders that the scene names (plugin_dirs): for scenes of people you do not know");
  positional.add("scene", 1);
}

namespace {

/// Says on the terminal how far cells at random have come, once that takes some seconds.
shape::PackingWatch packing_words() {
  using Clock = std::chrono::steady_clock;
  if (Crew::present() != nullptr && !Crew::present()->first()) return {};
  return [begin = Clock::now(), said = Clock::now()](double share) mutable {
    constexpr std::chrono::seconds patience{3};
    if (Clock::now() - said < patience) return;
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - begin).count();
    std::cerr << "placing cells at random: " << number(100 * share, 3) << " % of them have found room after " << seconds
              << " s" << (said == begin ? "; where that stands still they do not fit, which takes a while to tell" : "")
              << "\n";
    said = Clock::now();
  };
}

}  // namespace

plan::ReadScene SceneOptions::read() const {
  return plan::read_within_limits(
      scene, overrides, [&](const scene::Scene& read) { return catalog(read); }, packing_words());
}

std::string SceneOptions::in_shell() const {
  std::string words = command::in_shell(scene);
  for (const std::string& override : overrides) words += " --set " + command::in_shell(override);
  for (const std::string& folder : plugin_dirs) words += " --plugin-dir " + command::in_shell(folder);
  if (!lock.empty()) words += " --lock " + command::in_shell(lock);
  if (without_its_plugins) words += " --no-scene-plugins";
  return words;
}

plugin::Catalog SceneOptions::catalog(const scene::Scene& read) const {
  const std::vector<std::filesystem::path> given(plugin_dirs.begin(), plugin_dirs.end());
  plugin::Catalog catalog(plugin::plugin_search_path(given, read.plugin_dirs));
  const std::filesystem::path file = lock.empty() ? plugin::lock_beside(scene) : std::filesystem::path(lock);
  // A link that leads nowhere is a lock that cannot be read, not a scene without one.
  std::error_code ignored;
  if (!lock.empty() || std::filesystem::exists(std::filesystem::symlink_status(file, ignored)))
    catalog.set_lock(plugin::read_lock(file, lock_renewal(file, scene)));
  return catalog;
}

plan::Plan plan_and_place(const plan::ReadScene& read, const plugin::Catalog& catalog) {
  const scene::Scene& scene = read.scene;
  std::optional<plan::Plan> plan;
  Faults faults;
  faults.attempt([&] { plan = plan::make_plan(scene, catalog, read.numerics_choice); });
  if (!scene.cells.empty()) faults.attempt([&] { plan::try_cells(scene); });
  faults.raise();
  return *std::move(plan);
}

PlannedScene::PlannedScene(const SceneOptions& options)
    : read(options.read()),
      catalog(options.catalog(read.scene)),
      plan(plan_and_place(read, catalog)),
      report(plan::make_report(plan)),
      blocks(Crew::present() == nullptr ? std::nullopt
                                        : std::optional(plan::make_blocks(plan, Crew::present()->ranks()))) {}

void require_startable(const PlannedScene& planned, const plan::Blocks* blocks, int ranks) {
  plan::require_computable(planned.read.scene, blocks);
  plan::require_memory(planned.report.estimate.memory_bytes / ranks, "the run");
}

int processors() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

void check_threads(const char* option, int threads) {
  if (threads >= 1 && threads <= 1024) return;
  throw Error(Cause::bad_input, std::string(option) + " " + std::to_string(threads) +
                                    ": wants a number from 1 to 1024 (this machine has " +
                                    std::to_string(processors()) + " processors)");
}

int useful_threads(const scene::Scene& scene, int threads) {
  const double rows = scene.domain.node_count() / scene.domain.nodes[0];
  return static_cast<int>(std::min<double>(threads, std::max(1.0, rows / 4)));
}

void require_threads(const char* option, int threads) {
  std::latch all_asked(1);
  std::vector<std::jthread> others;
  try {
    for (int k = 1; k < threads; ++k) others.emplace_back([&] { all_asked.wait(); });
  } catch (const std::system_error& error) {
    all_asked.count_down();
    throw Error(Cause::input_output,
                std::string(option) + " " + std::to_string(threads) + ": the system grants no more than " +
                    std::to_string(others.size() + 1) + ": " + error.code().message(),
                {"take fewer, or raise the limit of processes (ulimit -u) or of memory (ulimit -v)"});
  }
  all_asked.count_down();
}

}  // namespace rouleau::command
