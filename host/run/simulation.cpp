#include "simulation.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "aggregate_history.hpp"
#include "barrier.hpp"
#include "cell/motion.hpp"
#include "node_checks.hpp"
#include "observer.hpp"
#include "output/progress.hpp"
#include "pass_costs.hpp"
#include "provenance.hpp"
#include "rheology_history.hpp"
#include "schedule.hpp"
#include "solver.hpp"

namespace rouleau::host {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The state of a run that all its stages share.
class Simulation {
 public:
  Simulation(const Plan& plan, const RunOptions& options, RunDirectory& directory)
      : plan_(plan),
        scene_(*plan.scene),
        options_(options),
        directory_(directory),
        membranes_(plan.has_cells ? make_membranes(scene_, lattice_spacing(scene_)) : Membranes{}),
        observer_(scene_, membranes_),
        progress_(options.quiet) {}

  Summary run() {
    described_ = describe(plan_, options_.threads);
    directory_.log("started", {{"title", scene_.title}, {"threads", options_.threads}});
    for (const std::string& warning : plan_.warnings) directory_.log("warning", {{"message", warning}});
    if (scene_.numerics.precision == Precision::f64) {
      run_stages<double>();
    } else {
      run_stages<float>();
    }
    progress_.finish();
    Summary summary = summarise();
    directory_.log("finished", {{"status", summary.status}, {"steps", summary.steps}});
    directory_.finish(summary);
    return summary;
  }

 private:
  enum class Ending { none, duration, strain, at_rest, max_steps, interrupted, failed };
  static const char* name(Ending ending) {
    constexpr const char* names[] = {"", "duration", "strain", "at_rest", "max_steps", "interrupted", "failed"};
    return names[static_cast<int>(ending)];
  }

  template <class T>
  void run_stages() {
    std::unique_ptr<Solver<T>> solver;
    for (int stage = 0; stage < static_cast<int>(plan_.stages.size()) && !stopped_; ++stage) {
      if (solver) {
        const LatticeUnits &from = solver->setting().units, &to = plan_.stages[static_cast<std::size_t>(stage)].units;
        change_units(membranes_.state, from, to);
        change_units(membranes_.contacts, from, to);
      }
      auto next = std::make_unique<Solver<T>>(plan_, stage, membranes_);
      start_fluid(*next, solver.get());
      solver = std::move(next);
      run_stage(*solver);
    }
  }

  /// Fluid of a stage: the developed flow between its walls if the stage asks for it, else what the former stage left,
  /// rescaled with the time step: velocities and density deviations of the same flow scale like the density factor.
  template <class T>
  void start_fluid(Solver<T>& solver, Solver<T>* former) {
    const StageSetting& setting = solver.setting();
    double faster = 0;  // what the membranes' last displacement is worth in the new time step
    if (setting.stage->start == WallStart::developed) {
      // Couette and Poiseuille flow, y from the middle of the channel.
      const double middle = (scene_.domain.nodes[1] - 1) / 2.0, half_height = scene_.domain.nodes[1] / 2.0;
      const double curvature = setting.body_force_x / ((setting.tau - 0.5) / 3);
      solver.fluid().set_profile(
          [&](double y) {
            const double s = y - middle;
            return setting.shear_rate * s + curvature * (half_height * half_height - s * s) / 2;
          },
          [&](double y) { return setting.shear_rate - curvature * (y - middle); });
    } else if (former != nullptr) {
      faster = setting.stage->density_factor / former->setting().stage->density_factor;
      solver.fluid().take_over(former->fluid(), faster);
    }
    for (auto* velocity : {&membranes_.velocity_x, &membranes_.velocity_y}) {
      for (double& v : *velocity) v *= faster;
    }
  }

  template <class T>
  void run_stage(Solver<T>& solver) {
    const StageSetting& setting = solver.setting();
    directory_.log(
        "stage",
        {{"name", setting.stage->name}, {"time_step_s", setting.units.time}, {"most_steps", setting.max_steps}});
    observer_.start_stage();
    stage_step_ = 0;
    stage_ending_ = Ending::none;
    const Schedule cells(scene_.output.cells, setting, true), fields(scene_.output.fields, setting, false);
    rest_watch_ = membranes_;
    rest_watch_step_ = 0;
    steps_before_ = steps_;
    next_attention_ = 0;
    const auto start = Clock::now();
    step_loop(solver, cells, fields);
    wall_ += seconds_since(start);
    time_ += static_cast<double>(stage_step_) * setting.units.time;
    strain_ += std::abs(setting.shear_rate) * static_cast<double>(stage_step_);
    stages_.push_back({{"name", setting.stage->name},
                       {"steps", stage_step_},
                       {"ended_by", name(stage_ending_)},
                       {"wall_s", seconds_since(start)}});
    nlohmann::json ended = stages_.back();
    ended["stage_wall_s"] = ended["wall_s"];
    ended.erase("wall_s");
    directory_.log("stage_ended", ended);
    stopped_ =
        stage_ending_ == Ending::max_steps || stage_ending_ == Ending::interrupted || stage_ending_ == Ending::failed;
  }

  /// The steps of a stage. All workers run the same passes; what needs one of them alone happens between two steps, and
  /// only when something is due.
  template <class T>
  void step_loop(Solver<T>& solver, const Schedule& cells, const Schedule& fields) {
    std::exception_ptr trouble;
    std::atomic<long> stop_at{std::numeric_limits<long>::max()};
    std::optional<Barrier> barrier;
#pragma omp parallel num_threads(options_.threads)
    {
      // The system may grant fewer threads than were asked for.
#pragma omp single
      barrier.emplace(omp_get_num_threads());
      const Worker worker{omp_get_thread_num(), omp_get_num_threads()};
      const std::vector<Pass>&forces = solver.forces(), &advance = solver.advance();
      PassClock clock(forces.size() + advance.size());
      for (long step = 0;; ++step) {
        run_passes(forces, worker, *barrier, clock, 0);
        if (step >= next_attention_ || step >= stop_at.load(std::memory_order_relaxed) || went_wrong(solver)) {
          barrier->arrive_and_wait();
          if (worker.first()) {
            try {
              between_steps(solver, step, cells, fields);
            } catch (...) {
              trouble = std::current_exception();
              stage_ending_ = Ending::failed;
            }
          }
          barrier->arrive_and_wait();
          if (stage_ending_ != Ending::none) break;
          clock.resume();
        }
        run_passes(advance, worker, *barrier, clock, forces.size());
        // A request to stop counts two steps later, when every worker has passed a barrier since.
        if (worker.first() && interrupted()) stop_at.store(step + 2, std::memory_order_relaxed);
      }
      if (worker.first()) add_costs(solver, clock);
    }
    if (trouble) std::rethrow_exception(trouble);
  }

  static void run_passes(const std::vector<Pass>& passes, Worker worker, Barrier& barrier, PassClock& clock,
                         std::size_t first) {
    unsigned announced = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
      passes[i].run(worker);
      switch (passes[i].meeting) {
        case Meeting::all:
          barrier.arrive_and_wait();
          break;
        case Meeting::announce:
          announced = barrier.arrive();
          break;
        case Meeting::await:
          barrier.wait(announced);
          break;
        case Meeting::none:
          break;
      }
      if (worker.first()) clock.lap(first + i);
    }
  }

  template <class T>
  void add_costs(const Solver<T>& solver, const PassClock& clock) {
    std::size_t at = 0;
    std::set<std::string> counted;
    for (const std::vector<Pass>* passes : {&solver.forces(), &solver.advance()}) {
      for (const Pass& pass : *passes) {
        costs_.add(pass.name, clock.wall_s(at++), counted.insert(pass.name).second ? stage_step_ : 0);
      }
    }
  }

  [[nodiscard]] bool interrupted() const { return options_.interrupted != nullptr && options_.interrupted->load(); }

  /// Whether the last step must not be followed by another; all workers come to the same answer.
  template <class T>
  [[nodiscard]] bool went_wrong(const Solver<T>& solver) const {
    return !(largest_step(membranes_) <= scene_.checks.node_step) || solver.escaped();
  }

  /// One thread, forces computed: outputs, checks, and whether the stage ends here.
  template <class T>
  void between_steps(Solver<T>& solver, long step, const Schedule& cells, const Schedule& fields) {
    const auto start = Clock::now();
    stage_step_ = step;
    steps_ = steps_before_ + step;
    if (auto failure =
            check_nodes(membranes_, scene_.checks.node_step, solver.escaped_node(), solver.setting().units.length)) {
      fail(std::move(*failure), solver.setting());
      return;
    }
    // The end of a stage has been written; the beginning of the next is the same instant.
    const bool written = stage_step_ == 0 && steps_ > 0;
    const bool cells_due = !written && (steps_ == 0 || cells.due(stage_step_));
    const bool fields_due = !written && !scene_.output.fields.never() && fields.due(stage_step_);
    const bool check_due = stage_step_ % scene_.checks.every_steps == 0;
    const Ending ending = next_ending(solver.setting());
    if (cells_due || fields_due || check_due || ending != Ending::none) {
      if (auto failure = observer_.check(solver, membranes_)) {
        fail(std::move(*failure), solver.setting());
        return;
      }
      const bool last = ending != Ending::none;
      if (cells_due || fields_due || last) write(solver, fields_due || (last && !scene_.output.fields.never()));
      momentum_residual_ = std::max(momentum_residual_, Observer::momentum_residual(membranes_));
      progress_.update(progress(solver.setting()));
      costs_.add("observe and check", seconds_since(start), 1);
    }
    stage_ending_ = ending;
    const long check = (step / scene_.checks.every_steps + 1) * scene_.checks.every_steps;
    next_attention_ = std::min({cells.next(step), fields.next(step), check, last_step(solver.setting())});
    if (solver.setting().stage->until_at_rest) {
      next_attention_ = std::min(next_attention_, rest_watch_step_ + rest_window(solver.setting()));
    }
  }

  /// Step at which the stage ends unless something ends it before.
  [[nodiscard]] long last_step(const StageSetting& setting) const {
    const long most = options_.max_steps >= 0 ? options_.max_steps - steps_before_ : setting.max_steps;
    return std::min(setting.max_steps, most);
  }

  Ending next_ending(const StageSetting& setting) {
    const Stage& stage = *setting.stage;
    if (interrupted()) return Ending::interrupted;
    if (stage.until_at_rest && at_rest(setting)) return Ending::at_rest;
    if (stage_step_ >= setting.max_steps) {
      const bool by_strain =
          stage.strain && (!stage.duration || *stage.strain / std::abs(stage.shear_rate) <= *stage.duration);
      return by_strain ? Ending::strain : Ending::duration;
    }
    if (options_.max_steps >= 0 && steps_ >= options_.max_steps) return Ending::max_steps;
    return Ending::none;
  }

  [[nodiscard]] long rest_window(const StageSetting& setting) const {
    return std::max(1L, std::lround(setting.steps_of(scene_.at_rest.window)));
  }

  bool at_rest(const StageSetting& setting) {
    if (stage_step_ - rest_watch_step_ < rest_window(setting)) return false;
    const double limit = scene_.at_rest.displacement / setting.units.length;
    const double moved =
        largest_displacement(membranes_.x, membranes_.y, rest_watch_.x, rest_watch_.y, {0, membranes_.node_count()});
    rest_watch_.x = membranes_.x;
    rest_watch_.y = membranes_.y;
    rest_watch_step_ = stage_step_;
    return moved < limit;
  }

  void fail(Failure failure, const StageSetting& setting) {
    failure.step = steps_;
    failure.time = time_at(setting);
    failure.strain = strain_at(setting);
    directory_.log("diverged", {{"reason", failure.reason}, {"step", failure.step}, {"message", failure.message}});
    failure_ = std::move(failure);
    stage_ending_ = Ending::failed;
  }

  template <class T>
  void write(Solver<T>& solver, bool with_fields) {
    Snapshot snapshot = observer_.observe(solver, membranes_, with_fields);
    snapshot.step = steps_;
    snapshot.time = time_at(solver.setting());
    snapshot.strain = strain_at(solver.setting());
    history_.follow(snapshot);
    rheology_.follow(snapshot);
    directory_.write(snapshot);
  }

  [[nodiscard]] double time_at(const StageSetting& s) const {
    return time_ + static_cast<double>(stage_step_) * s.units.time;
  }
  [[nodiscard]] double strain_at(const StageSetting& s) const {
    return strain_ + std::abs(s.shear_rate) * static_cast<double>(stage_step_);
  }

  ProgressState progress(const StageSetting& setting) {
    double before = 0, all = 0;
    for (const StageSetting& s : plan_.stages) {
      if (s.index < setting.index) before += static_cast<double>(s.max_steps);
      all += static_cast<double>(s.max_steps);
    }
    return {steps_,
            all > 0 ? (before + static_cast<double>(stage_step_)) / all : 1.0,
            setting.stage->name,
            strain_at(setting),
            observer_.mach_max(),
            observer_.area_drift_max(),
            history_.count()};
  }

  Summary summarise() {
    Summary s = described_;
    s.status = failure_ ? "diverged" : (stage_ending_ == Ending::interrupted ? "interrupted" : "completed");
    s.failure = failure_;
    s.steps = steps_;
    s.strain = strain_;
    s.simulated_time_s = time_;
    s.wall_s = wall_;
    s.steps_per_s = wall_ > 0 ? static_cast<double>(steps_) / wall_ : 0;
    s.mlups = s.steps_per_s * scene_.domain.nodes[0] * scene_.domain.nodes[1] / 1e6;
    s.peak_rss_bytes = peak_memory_bytes();
    s.passes = costs_.passes();
    s.dimensionless["mach_max"] = observer_.mach_max();
    s.mass_drift = observer_.mass_drift();
    s.area_drift_max = observer_.area_drift_max();
    s.stretch = {observer_.stretch().least, observer_.stretch().most};
    s.area_leakage_max = Observer::area_leakage(membranes_);
    s.momentum_residual = momentum_residual_;
    s.aggregates_final = history_.count();
    s.aggregate_history = history_.events();
    s.rheology = rheology_.stages();
    s.stages = stages_;
    return s;
  }

  const Plan& plan_;
  const Scene& scene_;
  const RunOptions& options_;
  RunDirectory& directory_;
  Membranes membranes_;
  Observer observer_;
  Progress progress_;

  long steps_ = 0, stage_step_ = 0;          ///< taken so far: by the run, by the stage
  long steps_before_ = 0;                    ///< by the run when the stage began
  long next_attention_ = 0;                  ///< step of the stage before which nothing is due
  double time_ = 0, strain_ = 0, wall_ = 0;  ///< at the start of the present stage
  Ending stage_ending_ = Ending::none;
  bool stopped_ = false;
  Membranes rest_watch_;  ///< positions at the start of the window in which nothing may move
  long rest_watch_step_ = 0;
  std::optional<Failure> failure_;
  AggregateHistory history_;
  RheologyHistory rheology_;
  PassCosts costs_;
  double momentum_residual_ = 0;
  nlohmann::json stages_ = nlohmann::json::array();
  Summary described_;  ///< what is known before the first step
};

}  // namespace

Summary simulate(const Plan& plan, const RunOptions& options, RunDirectory& directory) {
  return Simulation(plan, options, directory).run();
}

}  // namespace rouleau::host
