#include "simulation.hpp"
#include "plan/placed_cells.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/signal_stack.hpp"
#include "core/membrane/motion.hpp"
#include "core/solver/solver.hpp"
#include "files/run_directory.hpp"
#include "monitor/node_checks.hpp"
#include "monitor/state_checks.hpp"
#include "plan/solver_setup.hpp"
#include "run/checkpoint.hpp"
#include "run/checkpoint_match.hpp"
#include "run/run_state.hpp"
#include "run/stage_course.hpp"

namespace rouleau::python {

namespace {

namespace fs = std::filesystem;

/// What a checkpoint has of the cells that forces change before the step is over: of surfaces nothing.
struct Remembered {
  std::vector<core::ElementState> state;
  core::ContactMemory contacts, wall_contacts;
};

/// T: of the populations; Set: D2Q9 or D3Q19. The order of what happens in a step is that of run/simulation.cpp, so that the bits are the same.
template <class T, class Set>
class SimulationOf final : public Simulation {
 public:
  static constexpr int dimension = Set::dimension;
  using Solver = core::Solver<T, Set>;

  SimulationOf(plan::ReadScene read, plugin::Catalog catalog)
      : Simulation(std::move(read), std::move(catalog)),
        cells_(plan_.has_cells ? plan::make_cells<dimension>(scene()) : plan::Cells<dimension>{}),
        state_(observe::Observer(scene(), cells_)),
        course_(plan_, state_) {
    start_stage(nullptr);
  }

  long step(long count, int threads) override {
    require_whole();
    long taken = 0;
    while (taken < count && !over_) {
      const long before = state_.stage_step;
      step_stage(count - taken, threads);
      taken += state_.stage_step - before;
      if (ending_ != run::Ending::none) next_stage();
    }
    return taken;
  }

  void compute_forces() override {
    require_whole();
    if (ready_) return;
    remember();
    whole_ = false;
    if (state_.stage_step >= next_attention_) before_forces(state_.stage_step);
    core::Barrier nobody(1);
    const auto run = [&](std::size_t from, std::size_t to) {
      core::run_passes(solver_->passes(), from, to, solver_->bands(), Worker{}, nobody, nullptr);
    };
    run(0, solver_->rows_pass());
    if (add_force_) add_force_();
    run(solver_->rows_pass(), solver_->observable_pass());
    ready_ = whole_ = true;
  }

  FluidFields fluid() override {
    compute_forces();
    solver_->fluid().settle();
    FluidFields fields;
    for (const int nodes : plan::lattice_domain<dimension>(scene()).size) fields.size.push_back(nodes);
    const double speed = stage().units.unit(units::dimension::velocity);
    for (const auto& node : solver_->fluid().all_moments()) {
      for (const double component : node.velocity) fields.velocity.push_back(component * speed);
      fields.density.push_back(node.density);
    }
    return fields;
  }

  observe::Snapshot observe() override {
    compute_forces();
    observe::Snapshot snapshot = state_.observer.observe(*solver_, stage(), cells_, false);
    course_.date(snapshot);
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
    if (ready_ && solver_->flow_control()) {
      throw Error(Cause::bad_input,
                  "the forces of the next step have been read, and the scene keeps a mean velocity: the state "
                  "between two steps is gone",
                  {"save before forces, fluid or cells are read, or after the next step"});
    }
    if (ready_) exchange_memories();
    const auto back = [&] {
      if (ready_) exchange_memories();
    };
    try {
      files::RunDirectory to(directory, scene(), files::FormerRun::replace);
      run::Checkpoints checkpoints(scene(), &to);
      checkpoints.write(plan_, 1, state_, cells_, *solver_);
      checkpoints.settle(true);
    } catch (...) {
      back();
      throw;
    }
    back();
  }

  void restore(const fs::path& directory) override {
    run::Resumption resumption = run::open_checkpoint(directory, plan_, false);
    const std::shared_ptr<const files::CheckpointReader> reader = std::move(resumption.checkpoint);
    whole_ = false;
    run::RunState state(observe::Observer(scene(), cells_));
    auto restored = run::restore<T, Set>(reader, plan_, plan::lattice_domain<dimension>(scene()).block, state, cells_);
    state_ = std::move(state);
    solver_ = std::make_unique<Solver>(plan::make_solver_setup<dimension>(plan_, state_.stage), cells_);
    solver_->start(std::move(restored.solver));
    next_attention_ = state_.stage_step;
    ending_ = run::Ending::none;
    ready_ = over_ = false;
    whole_ = true;
  }

  [[nodiscard]] bool done() const override {
    return over_ || (course_.is_last() && course_.ending(*solver_) != run::Ending::none);
  }
  [[nodiscard]] long steps() const override { return state_.steps; }
  [[nodiscard]] double time() const override { return state_.time_at(stage()); }
  [[nodiscard]] double strain() const override { return state_.strain_at(stage()); }
  [[nodiscard]] const plan::StageSetting& stage() const override { return course_.setting(); }
  [[nodiscard]] core::CellNodes& nodes() override { return cells_; }

 private:
  void require_whole() const {
    if (whole_) return;
    throw Error(Cause::bad_input, "the last step has ended in the middle, so there is no state to go on from",
                {"load the last checkpoint, or make the simulation anew"});
  }

  void remember() {
    if constexpr (dimension == 2) remembered_ = {cells_.state, cells_.contacts, cells_.wall_contacts};
  }
  /// The cells get what they remembered before the forces of the next step, and the other way round.
  void exchange_memories() {
    if constexpr (dimension == 2) {
      std::swap(cells_.state, remembered_.state);
      std::swap(cells_.contacts, remembered_.contacts);
      std::swap(cells_.wall_contacts, remembered_.wall_contacts);
    }
  }

  void start_stage(Solver* former) {
    auto next = std::make_unique<Solver>(plan::make_solver_setup<dimension>(plan_, state_.stage), cells_);
    next->start(former);
    solver_ = std::move(next);
    course_.begin(*solver_);
    next_attention_ = 0;
  }

  void next_stage() {
    const run::Ending ending = std::exchange(ending_, run::Ending::none);
    over_ = ready_ = course_.is_last();  // the forces at the end of a stage are computed
    if (over_) return;
    state_.end_stage(stage(), ending);
    ++state_.stage;
    start_stage(solver_.get());
  }

  /// So many steps, or to the end of the stage, which ending_ then tells.
  void step_stage(long count, int threads) {
    std::exception_ptr trouble;
    std::optional<core::Barrier> barrier;
    const long first = state_.stage_step;
    whole_ = false;
#pragma omp parallel num_threads(threads)
    {
      thread_local const SignalStack stack;
      // The system may grant fewer threads than were asked for.
#pragma omp single
      barrier.emplace(omp_get_num_threads());
      try {
        take_steps({omp_get_thread_num(), omp_get_num_threads()}, *barrier, first, first + count);
      } catch (const core::Barrier::Abandoned&) {
        // The worker that has given up says why.
      } catch (...) {
        if (barrier->abandon()) trouble = std::current_exception();
      }
    }
    if (trouble) std::rethrow_exception(trouble);
    whole_ = true;
  }

  void take_steps(Worker worker, core::Barrier& barrier, long step, long last) {
    const std::vector<core::Pass>& passes = solver_->passes();
    const std::size_t rows = solver_->rows_pass(), observable = solver_->observable_pass();
    const auto alone = [&](auto&& action) {
      barrier.arrive_and_wait();
      if (worker.first()) action();
      barrier.arrive_and_wait();
    };
    const auto run = [&](std::size_t from, std::size_t to) {
      core::run_passes(passes, from, to, solver_->bands(), worker, barrier, nullptr);
    };
    bool ready = ready_;
    for (; step < last; ++step) {
      const bool attend = step >= next_attention_;
      if (!ready) {
        if (attend) alone([&] { before_forces(step); });
        run(0, rows);
        if (add_force_) alone(add_force_);
      }
      if (attend || wants_a_look()) {
        if (!ready) run(rows, observable);
        alone([&] { after_forces(step, attend); });
        if (ending_ != run::Ending::none) break;
        run(observable, passes.size());
      } else {
        run(ready ? observable : rows, passes.size());
      }
      ready = false;
    }
    barrier.arrive_and_wait();
    if (!worker.first()) return;
    ready_ = false;
    course_.count_to(step);
  }

  /// The last step must not be followed by another; all workers come to the same answer.
  [[nodiscard]] bool wants_a_look() const {
    return !(core::largest_step(cells_) <= scene().checks.node_step) || solver_->escaped();
  }

  void before_forces(long step) {
    course_.count_to(step);
    due_ending_ = course_.end(*solver_);
    if (due_ending_ != run::Ending::none) remember();
  }

  void after_forces(long step, bool attended) {
    course_.count_to(step);
    if (auto failure = monitor::check_nodes(*solver_, scene().checks.node_step, stage())) fail(std::move(*failure));
    if (!attended) return;
    const long every = scene().checks.every_steps;
    if (step % every == 0 || due_ending_ != run::Ending::none) {
      if (auto failure = monitor::check_state(state_.observer, *solver_, stage(), cells_, plan_))
        fail(std::move(*failure));
    }
    ending_ = due_ending_;
    course_.look(*solver_);
    next_attention_ = std::min((step / every + 1) * every, course_.next());
  }

  [[noreturn]] void fail(monitor::Failure failure) {
    course_.date(failure);
    throw Diverged{std::move(failure)};
  }

  plan::Cells<dimension> cells_;
  run::RunState state_;
  run::StageCourse course_;
  std::unique_ptr<Solver> solver_;
  std::function<void()> add_force_;
  Remembered remembered_;    ///< before the forces that are ready were computed
  long next_attention_ = 0;  ///< step of the stage at which something is due
  run::Ending due_ending_ = run::Ending::none, ending_ = run::Ending::none;
  bool ready_ = false;  ///< the forces of the next step are computed
  bool over_ = false;   ///< the last stage has ended
  bool whole_ = true;   ///< false: a step has ended in the middle
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
  const bool space = read.scene.domain.depth.has_value();
  const auto make = [&]<class T, class Set>(T, Set) -> std::unique_ptr<Simulation> {
    return std::make_unique<SimulationOf<T, Set>>(std::move(read), std::move(catalog));
  };
  if (read.scene.numerics.precision == scene::Precision::f32)
    return space ? make(float{}, core::D3Q19{}) : make(float{}, core::D2Q9{});
  return space ? make(double{}, core::D3Q19{}) : make(double{}, core::D2Q9{});
}

}  // namespace rouleau::python
