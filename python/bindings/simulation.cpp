#include "simulation.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "core/membrane/motion.hpp"
#include "files/run_directory.hpp"
#include "monitor/node_checks.hpp"
#include "monitor/state_checks.hpp"
#include "run/checkpoint.hpp"
#include "run/checkpoint_match.hpp"
#include "run/engine.hpp"
#include "run/run_state.hpp"
#include "run/stage_course.hpp"
#include "run/stepper.hpp"
#include "run/traffic.hpp"

namespace rouleau::python {

namespace {

namespace fs = std::filesystem;

/// What a checkpoint has of the cells that forces change before the step is over: of surfaces nothing.
struct Remembered {
  std::vector<core::ElementState> state;
  core::ContactMemory contacts, wall_contacts;
};

template <int D>
class SimulationOf final : public Simulation, run::StepHooks {
 public:
  SimulationOf(plan::ReadScene read, plugin::Catalog catalog)
      : Simulation(std::move(read), std::move(catalog)),
        state_(observe::Observer(scene())),
        engine_(plan_),
        course_(plan_, state_),
        traffic_(plan_, engine_, state_) {
    engine_.begin(engine_.place_cells(state_.observer));
    begin_stage();
  }

  long step(long count, int threads) override {
    require_whole();
    long taken = 0;
    while (taken < count && !over_) {
      const long before = state_.stage_step;
      whole_ = false;
      course_.count_to(stepper_.take(engine_.solver().passes(), before, before + count - taken, threads));
      whole_ = true;
      taken += state_.stage_step - before;
      if (ending_ != run::Ending::none) next_stage();
      if (traffic_.found()) change_cells();
    }
    return taken;
  }

  void compute_forces() override {
    require_whole();
    if (stepper_.forces_known()) return;
    remember();
    whole_ = false;
    stepper_.compute_forces(engine_.solver().passes(), state_.stage_step);
    if (traffic_.found()) {
      change_cells();
      stepper_.compute_forces(engine_.solver().passes(), state_.stage_step);
    }
    whole_ = true;
  }

  FluidFields fluid() override {
    compute_forces();
    core::AnyFluid<D>& fluid = engine_.solver().fluid();
    fluid.settle();
    FluidFields fields;
    for (const int nodes : fluid.setting().domain.size) fields.size.push_back(nodes);
    const double speed = stage().units.unit(units::dimension::velocity);
    for (const auto& node : fluid.all_moments()) {
      for (const double component : node.velocity) fields.velocity.push_back(component * speed);
      fields.density.push_back(node.density);
    }
    return fields;
  }

  observe::Snapshot observe() override {
    compute_forces();
    observe::Snapshot snapshot = state_.observer.observe(engine_.solver(), stage(), false);
    course_.date(snapshot);
    state_.traffic.cells.tell(snapshot);
    return snapshot;
  }

  void set_force(std::function<void()> add) override {
    if (add && plan_.scene->numerics.slip_correction) {
      throw Error(Cause::bad_input, plan_.scene->place("/numerics/slip_correction"),
                  "with the slip correction the fluid feels other forces than those on the nodes, so none can be added",
                  {"set numerics.slip_correction to false"});
    }
    add_force_ = std::move(add);
  }

  void save(const fs::path& directory) override {
    require_whole();
    const bool ready = stepper_.forces_known();
    if (ready && engine_.solver().flow_control()) {
      throw Error(Cause::bad_input,
                  "the forces of the next step have been read, and the scene keeps a mean velocity: the state "
                  "between two steps is gone",
                  {"save before forces, fluid or cells are read, or after the next step"});
    }
    if (ready) exchange_memories();
    const auto back = [&] {
      if (ready) exchange_memories();
    };
    try {
      files::RunDirectory to(directory, scene(), files::FormerRun::replace);
      run::Checkpoints checkpoints(scene(), &to);
      checkpoints.write(plan_, 1, state_, engine_.solver());
      checkpoints.settle(true);
    } catch (...) {
      back();
      throw;
    }
    back();
  }

  void restore(const fs::path& directory) override {
    run::Resumption resumption = run::open_checkpoint(directory, plan_, false);
    whole_ = false;
    run::RunState state{observe::Observer(scene())};
    files::DirectoryMark of_no_interest;
    auto start = engine_.restore_cells(std::move(resumption.checkpoint), state, of_no_interest);
    state_ = std::move(state);
    engine_.begin(std::move(start));
    stepper_.begin(state_.stage_step);
    ending_ = run::Ending::none;
    over_ = false;
    whole_ = true;
  }

  [[nodiscard]] bool done() const override {
    return over_ || (course_.is_last() && course_.ending(engine_.solver()) != run::Ending::none);
  }
  [[nodiscard]] long steps() const override { return state_.steps; }
  [[nodiscard]] double time() const override { return state_.time_at(stage()); }
  [[nodiscard]] double strain() const override { return state_.strain_at(stage()); }
  [[nodiscard]] const scene::StageSetting& stage() const override { return course_.setting(); }
  [[nodiscard]] core::CellNodes& nodes() override { return engine_.cells(); }

 private:
  void require_whole() const {
    if (whole_) return;
    throw Error(Cause::bad_input, "the last step has ended in the middle, so there is no state to go on from",
                {"load the last checkpoint, or make the simulation anew"});
  }

  void remember() {
    const auto& cells = engine_.cells();
    if constexpr (D == 2) remembered_ = {cells.state, cells.contacts, cells.wall_contacts};
  }
  /// The cells get what they remembered before the forces of the next step, and the other way round.
  void exchange_memories() {
    if constexpr (D == 2) {
      auto& cells = engine_.cells();
      std::swap(cells.state, remembered_.state);
      std::swap(cells.contacts, remembered_.contacts);
      std::swap(cells.wall_contacts, remembered_.wall_contacts);
    }
  }

  void begin_stage() {
    course_.begin(engine_.solver());
    stepper_.begin(0);
  }

  void next_stage() {
    const run::Ending ending = std::exchange(ending_, run::Ending::none);
    over_ = course_.is_last();  // the forces at its end stay known
    if (over_) return;
    state_.end_stage(stage(), ending);
    engine_.begin_stage(++state_.stage);
    begin_stage();
  }

  void change_cells() {
    traffic_.take();
    stepper_.begin(state_.stage_step);
  }

  [[nodiscard]] bool adds_forces() const override { return add_force_ != nullptr; }
  void add_forces() override { add_force_(); }
  [[nodiscard]] bool wants_a_look() const override {
    return !(core::largest_step(engine_.cells()) <= scene().checks.node_step) || engine_.solver().escaped();
  }

  bool before_forces(long step) override {
    course_.count_to(step);
    if (traffic_.due()) return false;
    due_ending_ = course_.end(engine_.solver());
    if (due_ending_ != run::Ending::none) remember();
    return true;
  }

  bool after_forces(long step, bool attended) override {
    core::AnySolver<D>& solver = engine_.solver();
    course_.count_to(step);
    if (auto failure = monitor::check_nodes(solver, scene().checks.node_step, stage())) fail(std::move(*failure));
    if (!attended) return true;
    const long every = scene().checks.every_steps;
    if (step % every == 0 || due_ending_ != run::Ending::none) {
      if (auto failure = monitor::check_state(state_.observer, solver, stage(), plan_)) fail(std::move(*failure));
    }
    ending_ = due_ending_;
    course_.look(solver, false);
    stepper_.attend_next(std::min({(step / every + 1) * every, course_.next(), traffic_.next()}));
    return ending_ == run::Ending::none;
  }

  [[noreturn]] void fail(monitor::Failure failure) {
    course_.date(failure);
    throw Diverged{std::move(failure)};
  }

  run::RunState state_;
  run::Engine<D> engine_;
  run::StageCourse course_;
  run::Traffic<D> traffic_;
  run::Stepper stepper_{*this};
  std::function<void()> add_force_;
  Remembered remembered_;  ///< before the forces that are known were computed
  run::Ending due_ending_ = run::Ending::none, ending_ = run::Ending::none;
  bool over_ = false;  ///< the last stage has ended
  bool whole_ = true;  ///< false: a step has ended in the middle
};

}  // namespace

Simulation::Simulation(plan::ReadScene read, plugin::Catalog catalog)
    : read_(std::move(read)),
      catalog_(std::move(catalog)),
      plan_(plan::make_plan(read_.scene, catalog_, read_.numerics_choice)) {}

std::unique_ptr<Simulation> make_simulation(const SceneChoice& choice) {
  const auto catalog_of = [&](const scene::Scene& scene) {
    plugin::Catalog catalog(plugin::plugin_search_path(choice.plugins, scene.plugin_dirs));
    const fs::path lock = plugin::lock_beside(choice.file);
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(lock, ignored))) {
      catalog.set_lock(plugin::read_lock(lock, "if this is meant, lock the scene again"));
    }
    return catalog;
  };
  plan::ReadScene read = plan::read_within_limits(choice.file, choice.overrides, catalog_of);
  plugin::Catalog catalog = catalog_of(read.scene);
  if (read.scene.domain.dimension() == 3) return std::make_unique<SimulationOf<3>>(std::move(read), std::move(catalog));
  return std::make_unique<SimulationOf<2>>(std::move(read), std::move(catalog));
}

}  // namespace rouleau::python
