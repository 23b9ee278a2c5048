#include "simulation.hpp"
#include "plan/placed_cells.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "base/signal_stack.hpp"
#include "checkpoint.hpp"
#include "checkpoint_match.hpp"
#include "core/membrane/motion.hpp"
#include "load_balance.hpp"
#include "monitor/contact_remedy.hpp"
#include "monitor/energy_check.hpp"
#include "monitor/node_checks.hpp"
#include "monitor/state_checks.hpp"
#include "plan/output_schedule.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/solver_setup.hpp"
#include "progress.hpp"
#include "provenance.hpp"
#include "run_state.hpp"
#include "stage_course.hpp"

namespace rouleau::run {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// How many steps ranks take from one time that they ask each other whether somebody wants them to attend to the next.
constexpr long steps_between_questions = 16;

/// The stages of a run one after another, and the steps of each: what one rank does of it. All ranks decide the same. What
/// one of them alone sees, its clock, its signals and its cells, they tell each other first.
/// T: of the populations; Set: D2Q9 or D3Q19.
template <class T, class Set>
class Simulation {
 public:
  static constexpr int dimension = Set::dimension;
  using Cells = typename core::Solver<T, Set>::Cells;
  using Boxes = std::vector<core::BoundingBox<dimension>>;

  Simulation(const plan::Plan& plan, const plan::PlanReport& report, const RunOptions& options,
             files::RunDirectory* directory, const core::Ranks<dimension>& ranks, const std::vector<int>& owner)
      : plan_(plan),
        scene_(*plan.scene),
        options_(options),
        directory_(directory),
        ranks_(ranks),
        owner_(owner),
        state_(observe::Observer(scene_)),
        course_(plan, state_),
        progress_(options.quiet || directory == nullptr),
        checkpoints_(scene_, directory),
        summary_(describe(plan, report, options.threads)) {
    if (ranks_.several()) summary_.ranks = ranks_.blocks->ranks();
    summary_.message_library = options.message_library;
    if (plan.has_cells) place_cells();
  }

  Summary run() {
    std::optional<core::SolverState<T>> former = go_on();
    if (!former) log("started", {{"title", scene_.title}, {"threads", options_.threads}, {"ranks", summary_.ranks}});
    for (const std::string& warning : summary_.plan.warnings) log("warning", {{"message", warning}});
    run_stages(std::move(former));
    progress_.finish();
    summarise();
    log("finished", {{"status", summary_.status}, {"steps", summary_.steps}});
    if (directory_ != nullptr) directory_->finish(to_json(summary_));
    return std::move(summary_);
  }

 private:
  void log(const char* event, const nlohmann::json& details) {
    if (directory_ != nullptr) directory_->log(event, details);
  }

  /// Of the present stage.
  [[nodiscard]] const plan::StageSetting& setting() const { return course_.setting(); }

  /// As the scene has them; with other ranks those that this one has to know.
  void place_cells() {
    if (!ranks_.several()) {
      cells_ = plan::make_cells<dimension>(scene_);
      state_.observer.begin_with(cells_);
      return;
    }
    Boxes boxes;
    boxes.reserve(scene_.cells.size());
    plan::for_each_cell<dimension>(scene_, plan::lattice_spacing(scene_), [&](std::size_t, const Cells& cell) {
      boxes.push_back(core::box_of<dimension>(cell, 0));
      state_.observer.begin_with(cell);
    });
    part_ = find_part(boxes, owner_);
    cells_ = plan::make_known_cells<dimension>(scene_, [this](int cell) { return part_->knows(cell); });
    part_->set_parts(cells_);
  }
  /// This rank's part in the cells with these boxes, for a solver of the present stage.
  [[nodiscard]] core::GhostCells<dimension> find_part(const Boxes& boxes, std::vector<int> owner) const {
    const auto setup = plan::make_solver_setup<dimension>(plan_, state_.stage);
    return {ranks_, boxes, core::ghost_reach(setup), std::move(owner)};
  }

  /// Takes over what the directory's checkpoint says, if the run goes on from one. The rank that has the directory goes
  /// first, and tells the others which file it is.
  std::optional<core::SolverState<T>> go_on() {
    std::optional<Restored<T>> restored;
    std::string file;
    TakePart<dimension> take_part;
    if (ranks_.several() && plan_.has_cells) {
      take_part = [this](const Boxes& boxes) {
        part_ = find_part(boxes, owner_);
        part_->set_parts(cells_);
      };
    }
    if (directory_ != nullptr && directory_->resumes()) {
      Resumption resumption = open_checkpoint(directory_->path(), plan_, options_.force);
      const std::shared_ptr<const files::CheckpointReader> reader = std::move(resumption.checkpoint);
      restored = restore<T, Set>(reader, plan_, domain().block, state_, cells_, take_part);
      directory_->go_back(restored->directory);
      reader->take_place(directory_->path());
      file = files::checkpoint_file(directory_->path()).string();
      log("resumed", state_.resumed.emplace_back(Continuation{state_.steps, options_.threads, summary_.ranks,
                                                              resumption.accepted, resumption.damage}));
      checkpoints_.go_on_from(state_.steps);
      say_where_it_goes_on(resumption.damage);
    }
    file = core::text_of_rank(ranks_, 0, file);
    if (!restored && !file.empty()) {
      const auto reader = std::make_shared<const files::CheckpointReader>(file);
      restored = restore<T, Set>(reader, plan_, domain().block, state_, cells_, take_part);
    }
    if (!restored) return std::nullopt;
    return std::move(restored->solver);
  }

  /// The cells are handed on to where the next solver wants them, by ranks that may have other blocks by now; what
  /// viscosities were made from, too.
  core::DisplacementWatch::Memory pass_on(const Boxes& boxes, std::vector<int> owner) {
    part_ = find_part(boxes, std::move(owner));
    return solver_->cell_tasks()->pass_on(*part_);
  }
  /// What walls do to the cells along y and z.
  [[nodiscard]] std::array<double, 2> force_from_walls() const {
    const auto* tasks = solver_->cell_tasks();
    if (tasks == nullptr || tasks->wall_contacts() == nullptr) return {};
    std::array<double, 2> force{tasks->wall_contacts()->net_force(cells_, ranks_), 0};
    if constexpr (Set::dimension == 3) force[1] = tasks->wall_contacts()->net_force(cells_, ranks_, 2);
    return force;
  }

  /// On the terminal, where what was lost is said even to whom wants no progress.
  void say_where_it_goes_on(const std::string& damage) const {
    const std::string step = "step " + std::to_string(state_.steps);
    if (!damage.empty()) {
      std::cerr << "warning: going on from " << step << ", the checkpoint before the last, for " << damage << "\n";
    } else if (!options_.quiet) {
      std::cerr << "going on from " << step << "\n";
    }
    if (options_.max_steps >= 0 && state_.steps > options_.max_steps) {
      std::cerr << "warning: " << step << " lies beyond the limit of " << options_.max_steps << " steps\n";
    }
  }

  /// What this rank computes of the lattice.
  [[nodiscard]] core::Domain<dimension> domain() const {
    return ranks_.several() ? ranks_.blocks->domain(ranks_.transport->rank()) : plan::lattice_domain<dimension>(scene_);
  }

  /// Of the present stage, for this rank's block.
  [[nodiscard]] std::unique_ptr<core::Solver<T, Set>> make_solver() {
    core::BasicSolverSetup<dimension> setup = plan::make_solver_setup<dimension>(plan_, state_.stage);
    setup.domain = domain();
    return std::make_unique<core::Solver<T, Set>>(std::move(setup), cells_, ranks_, std::exchange(part_, std::nullopt));
  }

  void run_stages(std::optional<core::SolverState<T>> former) {
    for (; state_.stage < static_cast<int>(plan_.stages.size()) && !stopped_; ++state_.stage) {
      const auto start = Clock::now();
      if (solver_ && ranks_.several() && plan_.has_cells) pass_on(solver_->cell_tasks()->boxes_of_all(), owner_);
      auto next = make_solver();
      if (former) {
        next->start(*std::exchange(former, std::nullopt));
        solver_ = std::move(next);
      } else {
        next->start(solver_.get());
        solver_ = std::move(next);
        start_stage();
      }
      cut_s_ = seconds_since(start);
      run_stage();
    }
  }

  void start_stage() {
    const plan::StageSetting& setting = this->setting();
    log("stage",
        {{"name", setting.stage->name}, {"time_step_s", setting.units.time}, {"most_steps", setting.max_steps}});
    course_.begin(*solver_);
  }

  void run_stage() {
    const plan::StageSetting& setting = this->setting();
    ending_ = Ending::none;
    for (const std::string& pass : solver_->pass_names())
      state_.costs.add(pass, 0, 0);  // ranks do not change their order
    const plan::OutputSchedule cells(scene_.output.cells, setting, true), fields(scene_.output.fields, setting, false);
    next_attention_ = state_.stage_step;
    clock_ = Clock::now();
    begin_balance();
    cut_at_ = never;
    for (step_loop(cells, fields); cut_due_; step_loop(cells, fields)) cut_again();
    take_time();
    state_.end_stage(setting, ending_);
    log("stage_ended", {{"name", setting.stage->name},
                        {"steps", state_.stage_step},
                        {"ended_by", ending_},
                        {"stage_wall_s", state_.stage_wall}});
    stopped_ = ending_ == Ending::max_steps || ending_ == Ending::interrupted || ending_ == Ending::failed;
  }

  /// The time since this was last called goes to the run and the stage.
  void take_time() {
    const double passed = seconds_since(clock_);
    clock_ = Clock::now();
    state_.wall += passed;
    state_.stage_wall += passed;
  }

  /// What this rank has computed for, waiting for others and what is done alone left out.
  [[nodiscard]] double computed_s() const {
    double sum = 0;
    std::set<std::string> counted;
    for (const core::Pass& pass : solver_->passes()) {
      if (pass.name != "ranks" && counted.insert(pass.name).second) sum += state_.costs.wall_s(pass.name);
    }
    return sum;
  }

  void begin_balance() {
    computed_s_ = computed_s();
    balance_.begin();
  }

  /// One thread, at a check: whether some ranks wait so long for others that they get new blocks before the next step.
  void look_at_balance(long step) {
    if (!ranks_.several()) return;
    const double own = computed_s() - computed_s_;
    std::vector<core::ExactSum> sum(1);
    sum.front().add(own);
    core::add_up(ranks_, sum);
    const auto [slowest, cut] = core::largest(ranks_, std::array{own, cut_s_});
    balance_.look(slowest, sum.front().value() / ranks_.blocks->ranks(), cut);
    if (balance_.over()) begin_balance();
    if (balance_.due() || options_.cut_at_checks) cut_at_ = step + 1;
  }

  /// All ranks, between two steps, whose messages have been taken: other blocks for the same state.
  void cut_again() {
    const auto start = Clock::now();
    std::vector<double> seconds;
    for (const std::vector<double>& of_rank : core::all_of(ranks_, std::vector<double>{computed_s() - computed_s_}))
      seconds.push_back(of_rank.front());
    const core::Ranks<dimension> before = ranks_;
    auto blocks = std::make_unique<const core::Decomposition<dimension>>(
        plan::cut_again<dimension>(plan_, before, cells_, seconds));
    auto* const tasks = solver_->cell_tasks();
    const Boxes boxes = tasks != nullptr ? tasks->boxes_of_all() : Boxes{};
    ranks_.blocks = blocks.get();
    core::Fluid<T, Set>& fluid = solver_->fluid();
    fluid.settle();
    core::SolverState<T> state{.populations =
                                   [&](int q) {
                                     std::vector<T> values;
                                     fluid.copy_populations(q, values);
                                     return core::rearrange(before, *blocks, values);
                                   },
                               .walls_have_acted = fluid.walls_have_acted(),
                               .steps = state_.stage_step,
                               .flow_control = {},
                               .viscosity = {}};
    if (const auto& control = solver_->flow_control()) state.flow_control = control->state();
    if (tasks != nullptr) state.viscosity = pass_on(boxes, {});
    auto next = make_solver();
    next->start(std::move(state));
    solver_ = std::move(next);
    blocks_ = std::move(blocks);
    cut_s_ = seconds_since(start);
    state_.costs.add("cut", cut_s_, 1);
    log("cut",
        {{"step", state_.steps}, {"slowest_over_mean", balance_.slowest_over_mean()}, {"wall_s_of_cut", cut_s_}});
    begin_balance();
    next_attention_ = state_.stage_step;
    cut_at_ = never;
    cut_due_ = false;
  }

  /// The steps of a stage, by all workers of this rank.
  void step_loop(const plan::OutputSchedule& cells, const plan::OutputSchedule& fields) {
    std::exception_ptr trouble;
    std::optional<core::Barrier> barrier;
    attend_at_ = never;
#pragma omp parallel num_threads(options_.threads)
    {
      // The system may grant fewer threads than were asked for.
#pragma omp single
      barrier.emplace(omp_get_num_threads());
      const SignalStack stack;
      try {
        take_steps({omp_get_thread_num(), omp_get_num_threads()}, *barrier, cells, fields);
      } catch (const core::Barrier::Abandoned&) {
        // The worker that has given up says why.
      } catch (...) {
        if (barrier->abandon()) trouble = std::current_exception();
      }
    }
    if (trouble) std::rethrow_exception(trouble);
  }

  /// All workers run the same passes; what needs one of them alone happens before or after the forces of a step, and only
  /// when something is due.
  void take_steps(Worker worker, core::Barrier& barrier, const plan::OutputSchedule& cells,
                  const plan::OutputSchedule& fields) {
    const std::vector<core::Pass>& passes = solver_->passes();
    const std::size_t rows = solver_->rows_pass(), observable = solver_->observable_pass();
    core::PassClock clock(passes.size());
    long counted = state_.stage_step;  // steps whose costs are in the state
    const auto count_costs = [&](long step) {
      add_costs(clock, step - counted);
      counted = step;
    };
    const auto alone = [&](auto&& action) {
      barrier.arrive_and_wait();
      if (worker.first()) action();
      barrier.arrive_and_wait();
      clock.resume();
    };
    const auto run = [&](std::size_t from, std::size_t to) {
      run_passes(passes, from, to, solver_->bands(), worker, barrier, &clock);
    };
    for (long step = state_.stage_step;; ++step) {
      const bool attend = step >= next_attention_ || step >= attend_at_.load(std::memory_order_relaxed);
      if (attend) {
        alone([&] {
          count_costs(step);
          attend_at_.store(never, std::memory_order_relaxed);
          before_forces(step);
        });
        if (cut_due_) break;
      }
      run(0, rows);
      if (attend || wants_a_look()) {
        run(rows, observable);
        alone([&] { after_forces(step, cells, fields); });
        if (ending_ != Ending::none) break;
        run(observable, passes.size());
      } else {
        run(rows, passes.size());
      }
      if (worker.first() && step + 2 < attend_at_.load() && wants_attention(step)) {
        attend_at_.store(step + 2, std::memory_order_relaxed);  // when every worker has passed a barrier since
      }
    }
    if (worker.first()) count_costs(state_.stage_step);
  }

  void add_costs(core::PassClock& clock, long steps) {
    std::size_t at = 0;
    std::set<std::string> counted;
    for (const core::Pass& pass : solver_->passes()) {
      state_.costs.add(pass.name, clock.take(at++), counted.insert(pass.name).second ? steps : 0);
    }
  }

  /// Whether a signal or a clock wants the loop to attend to a step soon.
  [[nodiscard]] bool wants_attention(long step) const {
    if (ranks_.several() && step % steps_between_questions != 0) return false;
    solver_->end_messages();
    return core::any(ranks_, interrupted() || checkpoints_.due());
  }

  [[nodiscard]] bool interrupted() const { return options_.interrupted != nullptr && options_.interrupted->load(); }

  /// Whether the last step must not be followed by another; all workers come to the same answer.
  [[nodiscard]] bool wants_a_look() const {
    return !(core::largest_step(cells_) <= scene_.checks.node_step) || solver_->escaped();
  }

  /// One thread, before the forces of a step: whether the stage ends here, and the checkpoint.
  void before_forces(long step) {
    course_.count_to(step);
    solver_->end_messages();
    if (step >= cut_at_) {
      cut_due_ = true;
      return;
    }
    due_ending_ = next_ending();
    const bool stops = due_ending_ == Ending::interrupted || due_ending_ == Ending::max_steps;
    const bool ends = due_ending_ != Ending::none && (course_.is_last() || stops);
    if (core::any(ranks_, checkpoints_.due()) || (checkpoints_.wanted() && ends)) {
      take_time();
      const auto start = Clock::now();
      checkpoints_.write(plan_, options_.threads, state_, cells_, *solver_);
      state_.costs.add("checkpoint", seconds_since(start), 1);
    }
  }

  /// One thread, forces computed: outputs, checks, and whether the stage ends here.
  void after_forces(long step, const plan::OutputSchedule& cells, const plan::OutputSchedule& fields) {
    const auto start = Clock::now();
    const plan::StageSetting& setting = this->setting();
    course_.count_to(step);
    solver_->end_messages();
    if (fails(monitor::check_nodes(*solver_, scene_.checks.node_step, setting))) return;
    if (checkpoints_.pending()) {
      observe::Observer look = state_.observer;  // one that leaves no trace
      checkpoints_.settle(!monitor::check_state(look, *solver_, setting, cells_, plan_));
    }
    // The end of a stage has been written; the beginning of the next is the same instant.
    const bool written = step == 0 && state_.steps > 0;
    const bool cells_due = !written && (state_.steps == 0 || cells.due(step));
    const bool fields_due = !written && !scene_.output.fields.never() && fields.due(step);
    const bool check_due = step % scene_.checks.every_steps == 0;
    const bool last = due_ending_ != Ending::none;
    if (cells_due || fields_due || check_due || last) {
      if (fails(monitor::check_state(state_.observer, *solver_, setting, cells_, plan_))) return;
      if (check_due) look_at_balance(step);
      if ((cells_due || fields_due || last) && !write(fields_due || (last && !scene_.output.fields.never()))) return;
      state_.momentum_residual =
          std::max(state_.momentum_residual, observe::Observer::momentum_residual(cells_, force_from_walls(), ranks_));
      if (ranks_.first()) progress_.update(progress(setting));
      state_.costs.add("observe and check", seconds_since(start), 1);
    }
    ending_ = due_ending_;
    course_.look(*solver_);
    const long check = (step / scene_.checks.every_steps + 1) * scene_.checks.every_steps;
    next_attention_ = std::min({cells.next(step), fields.next(step), check, course_.next(), cut_at_});
    if (options_.max_steps >= 0) next_attention_ = std::min(next_attention_, options_.max_steps - state_.steps_before);
  }

  /// What ends the stage before the forces of this step.
  [[nodiscard]] Ending next_ending() {
    const Ending by_scene = course_.end(*solver_);
    if (core::any(ranks_, interrupted())) return Ending::interrupted;
    if (by_scene != Ending::none) return by_scene;
    if (options_.max_steps >= 0 && state_.steps >= options_.max_steps) return Ending::max_steps;
    return Ending::none;
  }

  /// Whether all ranks have found a failure, the same, with which the run ends.
  [[nodiscard]] bool fails(std::optional<monitor::Failure> found) {
    if (!found) return false;
    failure_ = std::move(found);
    course_.date(*failure_);
    log("diverged", {{"reason", failure_->reason}, {"step", failure_->step}, {"message", failure_->message}});
    ending_ = Ending::failed;
    return true;
  }

  /// Writes the present state, unless it has gained energy that nothing gave it: then the run fails, and false is
  /// returned.
  bool write(bool with_fields) {
    observe::Snapshot snapshot = state_.observer.observe(*solver_, setting(), cells_, with_fields);
    if (ranks_.first()) {
      course_.date(snapshot);
      const units::LatticeUnits& units = setting().units;
      state_.energy.follow(snapshot, setting().is_driven(),
                           units.to_si(solver_->slight_energy(), units::dimension::energy_per_depth) /
                               (dimension == 3 ? scene_.domain.depth->nodes : 1));
    }
    if (fails(monitor::check_energy(state_.energy, cells_, ranks_, plan_, setting()))) return false;
    if (ranks_.first()) {
      state_.history.follow(snapshot, summary_.plan.attracting);
      state_.rheology.follow(snapshot);
      if (directory_ != nullptr) directory_->write(snapshot);
    } else {
      observe::give_all(snapshot.membranes.fields);
      observe::give_all(snapshot.fields.fields);
    }
    return true;
  }

  ProgressState progress(const plan::StageSetting& setting) {
    double before = 0, all = 0;
    for (const plan::StageSetting& s : plan_.stages) {
      if (s.index < setting.index) before += static_cast<double>(s.max_steps);
      all += static_cast<double>(s.max_steps);
    }
    const double done = before + static_cast<double>(state_.stage_step);
    double fraction = all > 0 ? done / all : 1.0, left = all - done;
    if (options_.max_steps > 0) {
      fraction = std::max(fraction, static_cast<double>(state_.steps) / static_cast<double>(options_.max_steps));
      left = std::min(left, static_cast<double>(options_.max_steps - state_.steps));
    }
    return {state_.steps,
            fraction,
            setting.stage->name,
            state_.strain_at(setting),
            state_.observer.mach_max(),
            state_.observer.area_drift_max(),
            summary_.plan.attracting.empty() ? -1 : state_.history.rouleaux(),
            left,
            scene_.domain.depth.has_value()};
  }

  /// Adds to the summary what is known behind the last step.
  void summarise() {
    Summary& s = summary_;
    s.status = failure_ ? "diverged" : (ending_ == Ending::interrupted ? "interrupted" : "completed");
    s.failure = failure_;
    state_.report(s);
    s.mlups = s.steps_per_s * scene_.domain.node_count() / 1e6;
    s.peak_rss_bytes = 0;
    for (const std::vector<long>& of_rank : core::all_of(ranks_, std::vector<long>{peak_memory_bytes()}))
      s.peak_rss_bytes += of_rank.front();
    s.checkpoint_step = checkpoints_.kept();
    s.area_leakage_max = observe::Observer::area_leakage(cells_, ranks_);
  }

  const plan::Plan& plan_;
  const scene::Scene& scene_;
  const RunOptions& options_;
  files::RunDirectory* directory_;  ///< null on all ranks but one
  core::Ranks<dimension> ranks_;
  const std::vector<int>& owner_;
  Cells cells_;
  std::optional<core::GhostCells<dimension>>
      part_;                                      ///< in the cells, that the next solver is given; none without ranks
  std::unique_ptr<core::Solver<T, Set>> solver_;  ///< of the present stage
  RunState state_;
  StageCourse course_;
  Progress progress_;

  std::unique_ptr<const core::Decomposition<dimension>> blocks_;  ///< that ranks_ has, once they have been cut again
  LoadBalance balance_;
  double cut_s_ = 0;       ///< what making a solver for other blocks takes
  double computed_s_ = 0;  ///< when it began to measure

  static constexpr long never = std::numeric_limits<long>::max();
  long next_attention_ = 0;             ///< step of the stage before which nothing is due
  std::atomic<long> attend_at_{never};  ///< step that somebody has asked for
  long cut_at_ = never;                 ///< before whose forces ranks get other blocks
  bool cut_due_ = false;                ///< the step loop has stopped for that
  Ending due_ending_ = Ending::none, ending_ = Ending::none;
  bool stopped_ = false;
  std::optional<monitor::Failure> failure_;
  Clock::time_point clock_;
  Checkpoints checkpoints_;
  Summary summary_;
};

}  // namespace

Summary simulate(const plan::Plan& plan, const plan::PlanReport& report, const RunOptions& options,
                 files::RunDirectory* directory, const Ranks& ranks, const std::vector<int>& owner) {
  try {
    const auto in = [&]<class Set>(Set) {
      const auto* given = std::get_if<core::Ranks<Set::dimension>>(&ranks);
      const core::Ranks<Set::dimension> of_lattice = given != nullptr ? *given : core::Ranks<Set::dimension>{};
      if (plan.scene->numerics.precision == scene::Precision::f64) {
        return Simulation<double, Set>(plan, report, options, directory, of_lattice, owner).run();
      }
      return Simulation<float, Set>(plan, report, options, directory, of_lattice, owner).run();
    };
    return plan.scene->domain.depth ? in(core::D3Q19{}) : in(core::D2Q9{});
  } catch (...) {
    std::visit(
        [](const auto& of_lattice) {
          if (of_lattice.several()) of_lattice.transport->abandon();
        },
        ranks);
    throw;
  }
}

}  // namespace rouleau::run
