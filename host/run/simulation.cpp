#include "simulation.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <string>
#include <type_traits>

#include "base/stopwatch.hpp"
#include "checkpoint.hpp"
#include "checkpoint_match.hpp"
#include "core/membrane/motion.hpp"
#include "engine.hpp"
#include "load_balance.hpp"
#include "monitor/node_checks.hpp"
#include "monitor/state_checks.hpp"
#include "progress.hpp"
#include "provenance.hpp"
#include "run_state.hpp"
#include "scene/output_schedule.hpp"
#include "stage_course.hpp"
#include "stepper.hpp"
#include "traffic.hpp"

namespace rouleau::run {

namespace {

/// How many steps ranks take from one time that they ask each other whether somebody wants them to attend to the next.
constexpr long steps_between_questions = 16;

/// The stages of a run one after another, and what happens between their steps: what one rank does of it. All ranks
/// decide the same. What one of them alone sees, its clock, its signals and its cells, they tell each other first.
template <int D>
class Simulation final : StepHooks {
 public:
  Simulation(const plan::Plan& plan, const plan::PlanReport& report, const RunOptions& options,
             files::RunDirectory* directory, const core::Ranks<D>& ranks, const std::vector<int>& owner)
      : plan_(plan),
        options_(options),
        directory_(directory),
        state_(observe::Observer(*plan.scene, report.attracting)),
        engine_(plan, ranks, owner),
        course_(plan, state_),
        traffic_(plan, engine_, state_),
        progress_(options.quiet || directory == nullptr),
        checkpoints_(scene(), directory),
        summary_(describe(plan, report, options.threads)) {
    if (ranks.several()) summary_.ranks = ranks.blocks->ranks();
    summary_.message_library = options.message_library;
  }

  Summary run() {
    run_stages();
    progress_.finish();
    summarise();
    log("finished", {{"status", summary_.status}, {"steps", summary_.steps}});
    if (directory_ != nullptr) directory_->finish(to_json(summary_), state_.profiles);
    return std::move(summary_);
  }

 private:
  [[nodiscard]] const scene::Scene& scene() const { return *plan_.scene; }
  /// Of the present stage.
  [[nodiscard]] const scene::StageSetting& setting() const { return course_.setting(); }
  [[nodiscard]] core::AnySolver<D>& solver() { return engine_.solver(); }
  [[nodiscard]] const core::Ranks<D>& ranks() const { return engine_.ranks(); }
  void log(const char* event, const nlohmann::json& details) {
    if (directory_ != nullptr) directory_->log(event, details);
  }

  /// What the first solver is made from: the directory's checkpoint, if the run goes on from one, or the scene. The
  /// rank that has the directory goes first, and tells the others which file it is.
  typename Engine<D>::Start find_start() {
    std::optional<typename Engine<D>::Start> start;
    std::string file;
    files::DirectoryMark mark;
    if (directory_ != nullptr && directory_->resumes()) {
      Resumption resumption = open_checkpoint(directory_->path(), plan_, options_.force);
      const std::shared_ptr<const files::CheckpointReader> reader = std::move(resumption.checkpoint);
      start = engine_.restore_cells(reader, state_, mark);
      directory_->go_back(mark);
      reader->take_place(directory_->path());
      file = files::checkpoint_file(directory_->path()).string();
      log("resumed", state_.resumed.emplace_back(Continuation{state_.steps, options_.threads, summary_.ranks,
                                                              resumption.accepted, resumption.damage}));
      checkpoints_.go_on_from(state_.steps);
      say_where_it_goes_on(resumption.damage);
    }
    file = core::text_of_rank(ranks(), 0, file);
    if (!start && !file.empty())
      start = engine_.restore_cells(std::make_shared<const files::CheckpointReader>(file), state_, mark);
    if (!start) start = engine_.place_cells(state_.observer);
    return *std::move(start);
  }

  /// On the terminal, where what was lost is said even to whom wants no progress.
  void say_where_it_goes_on(const std::string& damage) const {
    const std::string step = "step " + std::to_string(state_.steps);
    if (!damage.empty())
      std::cerr << "warning: going on from " << step << ", the checkpoint before the last, for " << damage << "\n";
    else if (!options_.quiet)
      std::cerr << "going on from " << step << "\n";
    if (options_.max_steps >= 0 && state_.steps > options_.max_steps)
      std::cerr << "warning: " << step << " lies beyond the limit of " << options_.max_steps << " steps\n";
  }

  void run_stages() {
    Stopwatch watch;
    typename Engine<D>::Start from = find_start();
    const bool resumes = from.state.has_value();
    if (!resumes) log("started", {{"title", scene().title}, {"threads", options_.threads}, {"ranks", summary_.ranks}});
    for (const std::string& warning : summary_.plan.warnings) log("warning", {{"message", warning}});
    engine_.begin(std::move(from));
    if (!resumes) start_stage();
    for (;;) {
      balance_.made(watch.seconds());
      run_stage();
      if (stopped() || course_.is_last()) return;
      watch = {};
      engine_.begin_stage(++state_.stage);
      start_stage();
    }
  }

  void start_stage() {
    log("stage",
        {{"name", setting().stage->name}, {"time_step_s", setting().units.time}, {"most_steps", setting().max_steps}});
    course_.begin(solver());
  }

  void run_stage() {
    stage_.emplace(Stage{{scene().output.cells, setting(), true}, {scene().output.fields, setting(), false}});
    for (const std::string& pass : solver().passes().names) state_.costs.add(pass, 0, 0);
    clock_ = {};
    balance_.begin(computed_s());
    while (stage_->ended == Ending::none) {
      stepper_.begin(state_.stage_step);
      stepper_.take(solver().passes(), state_.stage_step, Stepper::never, options_.threads, &state_.costs);
      if (stage_->ended != Ending::none) break;
      traffic_.found() ? change_cells() : cut_again();
    }
    take_time();
    state_.end_stage(setting(), stage_->ended);
    log("stage_ended", {{"name", setting().stage->name},
                        {"steps", state_.stage_step},
                        {"ended_by", stage_->ended},
                        {"stage_wall_s", state_.stage_wall}});
  }
  /// Whether the run ends with the present stage.
  [[nodiscard]] bool stopped() const {
    const Ending by = stage_->ended;
    return by == Ending::max_steps || by == Ending::interrupted || by == Ending::failed;
  }

  /// The time since this was last called goes to the run and the stage.
  void take_time() {
    const double passed = clock_.seconds();
    clock_ = {};
    state_.wall += passed;
    state_.stage_wall += passed;
  }

  /// What this rank has computed for, waiting for others and what is done alone left out.
  [[nodiscard]] double computed_s() {
    double sum = 0;
    for (const std::string& pass : solver().passes().names) sum += state_.costs.wall_s(pass);
    return sum;
  }

  /// All ranks, between two steps, whose messages have been taken: cells come and go.
  void change_cells() {
    const auto change = traffic_.take();
    for (const auto& departure : change.gone)
      log("cell_left",
          {{"step", state_.steps}, {"cell", departure.cell}, {"end", departure.end == 0 ? "lower" : "upper"}});
    for (const auto& arrival : change.come) log("cell_came", {{"step", state_.steps}, {"cell", arrival.cell}});
  }

  /// All ranks, between two steps, whose messages have been taken: other blocks for the same state.
  void cut_again() {
    const Stopwatch watch;
    engine_.cut_again(state_.stage, state_.stage_step, balance_.seconds(ranks(), computed_s()));
    const double seconds = watch.seconds();
    state_.costs.add("cut", seconds, 1);
    log("cut",
        {{"step", state_.steps}, {"slowest_over_mean", balance_.slowest_over_mean()}, {"wall_s_of_cut", seconds}});
    balance_.made(seconds);
    balance_.begin(computed_s());
  }

  /// Of a signal or a clock.
  bool wants_attention(long step) override {
    if (ranks().several() && step % steps_between_questions != 0) return false;
    solver().end_messages();
    return core::any(ranks(), interrupted() || checkpoints_.due());
  }

  [[nodiscard]] bool interrupted() const { return options_.interrupted != nullptr && options_.interrupted->load(); }

  [[nodiscard]] bool wants_a_look() const override {
    return !(core::largest_step(engine_.cells()) <= scene().checks.node_step) || engine_.solver().escaped();
  }

  /// Whether the stage ends here, and the checkpoint; ranks that get other blocks before this step do not take it yet.
  bool before_forces(long step) override {
    course_.count_to(step);
    solver().end_messages();
    if (step >= balance_.next() || traffic_.due()) return false;
    stage_->due = next_ending();
    const bool stops = stage_->due == Ending::interrupted || stage_->due == Ending::max_steps;
    const bool ends = stage_->due != Ending::none && (course_.is_last() || stops);
    if (core::any(ranks(), checkpoints_.due()) || (checkpoints_.wanted() && ends)) {
      take_time();
      const Stopwatch watch;
      checkpoints_.write(plan_, options_.threads, state_, solver());
      state_.costs.add("checkpoint", watch.seconds(), 1);
    }
    return true;
  }

  /// Outputs, checks, and whether the stage ends here.
  bool after_forces(long step, bool) override {
    const Stopwatch watch;
    course_.count_to(step);
    solver().end_messages();
    if (fails(monitor::check_nodes(solver(), scene().checks.node_step, setting()))) return false;
    if (checkpoints_.pending()) {
      observe::Observer look = state_.observer;  // one that leaves no trace
      checkpoints_.settle(!monitor::check_state(look, solver(), setting(), plan_));
    }
    // The end of a stage has been written; the beginning of the next is the same instant.
    const bool written = step == 0 && state_.steps > 0;
    const bool cells_due = !written && (state_.steps == 0 || stage_->cells.due(step));
    const bool fields_due = !written && !scene().output.fields.never() && stage_->fields.due(step);
    const bool check_due = step % scene().checks.every_steps == 0;
    const bool last = stage_->due != Ending::none;
    const bool output_due = cells_due || fields_due || last;
    if (output_due || check_due) {
      const core::FluidMeasures<D> fluid = state_.observer.measure_fluid(solver().fluid(), setting(), output_due);
      if (fails(monitor::check_state(state_.observer, solver(), fluid, setting(), plan_))) return false;
      if (check_due && ranks().several()) balance_.look(ranks(), computed_s(), step, options_.cut_at_checks);
      if (output_due && !write(fluid, fields_due || (last && !scene().output.fields.never()))) return false;
      const auto* const tasks = solver().cell_tasks();
      state_.momentum_residual = std::max(
          state_.momentum_residual,
          observe::Observer::momentum_residual(
              engine_.cells(), tasks != nullptr ? tasks->force_from_outside() : std::array<double, 3>{}, ranks()));
      if (ranks().first()) progress_.update(progress());
      state_.costs.add("observe and check", watch.seconds(), 1);
    }
    course_.look(solver(), output_due);
    const long check = (step / scene().checks.every_steps + 1) * scene().checks.every_steps;
    long next = std::min(
        {stage_->cells.next(step), stage_->fields.next(step), check, course_.next(), balance_.next(), traffic_.next()});
    if (options_.max_steps >= 0) next = std::min(next, options_.max_steps - state_.steps_before);
    stepper_.attend_next(next);
    stage_->ended = stage_->due;
    return !last;
  }

  /// What ends the stage before the forces of this step.
  [[nodiscard]] Ending next_ending() {
    const Ending by_scene = course_.end(solver());
    if (core::any(ranks(), interrupted())) return Ending::interrupted;
    if (by_scene != Ending::none) return by_scene;
    if (options_.max_steps >= 0 && state_.steps >= options_.max_steps) return Ending::max_steps;
    return Ending::none;
  }

  /// Whether all ranks have found a failure, the same, with which the run ends.
  [[nodiscard]] bool fails(std::optional<monitor::Failure> found) {
    if (!found) return false;
    course_.date(*found);
    log("diverged", {{"reason", found->reason}, {"step", found->step}, {"message", found->message}});
    summary_.failure = std::move(found);
    stage_->ended = Ending::failed;
    return true;
  }

  /// Writes the present state, of whose fluid this has been measured, unless it has gained energy that nothing gave it:
  /// then the run fails, and false is returned.
  bool write(const core::FluidMeasures<D>& fluid, bool with_fields) {
    observe::Snapshot snapshot = state_.observer.observe(solver(), fluid, setting(), with_fields);
    if (scene().domain.is_open()) traffic_.measure();
    if (ranks().first()) {
      course_.date(snapshot);
      if (scene().domain.is_open()) state_.traffic.cells.tell(snapshot);
      const units::LatticeUnits& units = setting().units;
      state_.energy.follow(
          snapshot, setting().is_driven() || solver().setup().external.any() || setting().stage->changes_strengths(),
          units.to_si(solver().slight_energy(), units::dimension::energy_per_depth) /
              (scene().domain.node_count() / scene().domain.nodes[0] / scene().domain.nodes[1]));
    }
    if (fails(monitor::check_energy(state_.energy, engine_.cells(), ranks(), plan_, setting()))) return false;
    if (ranks().first()) {
      state_.history.follow(snapshot);
      state_.rheology.follow(snapshot);
      state_.profiles.follow(snapshot);
      if (directory_ != nullptr) directory_->write(snapshot);
    } else {
      observe::give_all(snapshot.membranes.fields);
      observe::give_all(snapshot.fields.fields);
      observe::give_all(snapshot.fields.on_walls);
    }
    return true;
  }

  ProgressState progress() {
    double before = 0, all = 0;
    for (const scene::StageSetting& s : plan_.stages) {
      if (s.index < setting().index) before += static_cast<double>(s.max_steps);
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
            setting().stage->name,
            state_.strain_at(setting()),
            state_.observer.mach_max(),
            state_.observer.area_drift_max(),
            summary_.plan.attracting.empty() ? -1 : state_.history.rouleaux(),
            left,
            scene().domain.words().content};
  }

  /// Adds to the summary what is known behind the last step.
  void summarise() {
    Summary& s = summary_;
    s.status = s.failure ? "diverged" : (stage_->ended == Ending::interrupted ? "interrupted" : "completed");
    state_.report(s);
    s.mlups = s.steps_per_s * scene().domain.node_count() / 1e6;
    s.peak_rss_bytes = 0;
    for (const std::vector<long>& of_rank : core::all_of(ranks(), std::vector<long>{peak_memory_bytes()}))
      s.peak_rss_bytes += of_rank.front();
    s.checkpoint_step = checkpoints_.kept();
    if (observe::has_traffic(scene()))
      s.cell_traffic = state_.traffic.cells.summary(scene().domain.in_plane() ? "m2" : "m3"),
      s.cell_traffic["cells_due"] = traffic_.due_by(state_.time);
    s.area_leakage_max = observe::Observer::area_leakage(engine_.cells(), ranks());
  }

  struct Stage {
    scene::OutputSchedule cells, fields;
    Ending due = Ending::none;    ///< what ends it before the next step
    Ending ended = Ending::none;  ///< what has ended it
  };

  const plan::Plan& plan_;
  const RunOptions& options_;
  files::RunDirectory* directory_;  ///< null on all ranks but one
  RunState state_;
  Engine<D> engine_;
  StageCourse course_;
  Traffic<D> traffic_;
  Progress progress_;
  Checkpoints checkpoints_;
  Summary summary_;
  Stepper stepper_{*this};
  Balance balance_;
  std::optional<Stage> stage_;  ///< the present one
  Stopwatch clock_;
};

}  // namespace

Summary simulate(const plan::Plan& plan, const plan::PlanReport& report, const RunOptions& options,
                 files::RunDirectory* directory, const Ranks& ranks, const std::vector<int>& owner) {
  try {
    return scene::in_dimension(plan.scene->domain.dimension(), [&]<int D>(std::integral_constant<int, D>) {
      const auto* given = std::get_if<core::Ranks<D>>(&ranks);
      return Simulation<D>(plan, report, options, directory, given != nullptr ? *given : core::Ranks<D>{}, owner).run();
    });
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
