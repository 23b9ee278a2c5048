// A scene that is stepped from outside: the schedule, the stages and the checks of `rouleau run`, without its outputs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/membrane/cell_nodes.hpp"
#include "monitor/failure.hpp"
#include "observe/snapshot.hpp"
#include "plan/plan.hpp"
#include "plan/read_scene.hpp"

namespace rouleau::python {

struct SceneChoice {
  std::filesystem::path file;
  std::vector<std::string> overrides;          ///< as for --set
  std::vector<std::filesystem::path> plugins;  ///< folders, searched first
};

/// The state is not one to go on from: a check has failed.
struct Diverged {
  monitor::Failure failure;
};

/// The mean state of the fluid in its nodes, row by row from below, x fastest, then y; SI.
struct FluidFields {
  std::vector<int> size;         ///< nodes along x, y and, in three dimensions, z
  std::vector<double> velocity;  ///< m/s, all components of each node
  std::vector<double> density;   ///< relative deviation from the fluid's density
};

/// One thread calls it. Whoever asks for forces, fluid or cells gets the state before the next step, whose forces are
/// computed once.
class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Takes steps, through as many stages as it takes, with this many threads; returns how many: fewer where the scene
  /// has ended. Throws Diverged.
  virtual long step(long count, int threads) = 0;
  /// Computes the forces of the next step.
  virtual void compute_forces() = 0;
  virtual FluidFields fluid() = 0;
  virtual observe::Snapshot observe() = 0;
  /// Called by the thread that called step(), each step, when the forces of the models are known: it may add to them.
  /// Throws Error(bad_input) for a scene with slip_correction, which spreads other forces than those.
  virtual void set_force(std::function<void()> add) = 0;
  /// A run directory of which a run can go on. Throws Error.
  virtual void save(const std::filesystem::path& directory) = 0;
  /// The state of a directory's checkpoint. Throws Error.
  virtual void restore(const std::filesystem::path& directory) = 0;

  [[nodiscard]] virtual bool done() const = 0;
  [[nodiscard]] virtual long steps() const = 0;
  [[nodiscard]] virtual double time() const = 0;  ///< s
  [[nodiscard]] virtual double strain() const = 0;
  [[nodiscard]] virtual const scene::StageSetting& stage() const = 0;
  /// Of all cells; what is along z is empty in two dimensions.
  [[nodiscard]] virtual core::CellNodes& nodes() = 0;
  [[nodiscard]] const scene::Scene& scene() const { return read_.scene; }
  /// A sentence for each library that comes with the scene.
  [[nodiscard]] std::vector<std::string> code_of_the_scene() const { return plan::code_of_the_scene(plan_); }
  /// Whether the scene has three dimensions.
  [[nodiscard]] bool in_space() const { return scene().domain.dimension() == 3; }

 protected:
  Simulation(plan::ReadScene read, plugin::Catalog catalog);

  plan::ReadScene read_;
  plugin::Catalog catalog_;
  plan::Plan plan_;
};

/// Reads and plans the scene as the program does. Throws Error.
std::unique_ptr<Simulation> make_simulation(const SceneChoice& choice);

}  // namespace rouleau::python
