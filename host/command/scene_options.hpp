// What the commands that take a scene have in common: options, search path, reading, how many threads they take.
#pragma once

#include <boost/program_options.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plan/plan.hpp"
#include "plan/plan_report.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/read_scene.hpp"

namespace rouleau::command {

/// Options of `rouleau run` and `rouleau plan` that decide which scene is meant.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<std::string> plugin_dirs;
  std::string lock;                  ///< empty: the one beside the scene, if there is one
  bool without_its_plugins = false;  ///< the scene's plugin_dirs are not searched, by this process and those it starts

  /// --set, --plugin-dir, --lock, --no-scene-plugins; the scene itself is positional.
  void add_to(boost::program_options::options_description& options,
              boost::program_options::positional_options_description& positional);
  [[nodiscard]] plan::ReadScene read() const;
  /// The scene and these options as somebody would type them again.
  [[nodiscard]] std::string in_shell() const;
  /// What the search path offers, bound by the lock.
  [[nodiscard]] plugin::Catalog catalog(const scene::Scene& scene) const;
};

/// The plan of a scene whose cells have been found to lie apart, within the walls. Throws all that speaks against
/// either.
plan::Plan plan_and_place(const plan::ReadScene& read, const plugin::Catalog& catalog);

/// A scene as the options mean it, read and planned. Its parts refer to each other: it stays where it is.
struct PlannedScene {
  explicit PlannedScene(const SceneOptions& options);
  PlannedScene(const PlannedScene&) = delete;
  PlannedScene& operator=(const PlannedScene&) = delete;

  const plan::ReadScene read;
  const plugin::Catalog catalog;
  const plan::Plan plan;
  const plan::PlanReport report;
  const std::optional<plan::Blocks> blocks;  ///< none where this process is alone
};

/// Throws what a run on this machine by so many ranks is refused for: too many nodes of a rank, too little memory.
void require_startable(const PlannedScene& planned, const plan::Blocks* blocks, int ranks);

/// Of this machine, one at least.
int processors();
/// Throws Error(bad_input) for a number that no machine has; `option`: what gave it.
void check_threads(const char* option, int threads);
/// No more than have rows of the lattice to share.
int useful_threads(const scene::Scene& scene, int threads);
/// Throws Error(input_output) where the system refuses so many: OpenMP's library would end the program.
void require_threads(const char* option, int threads);

}  // namespace rouleau::command
