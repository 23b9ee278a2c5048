#include "rank_bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "core/solver/solver.hpp"
#include "measure.hpp"
#include "plan/read_scene.hpp"
#include "run/stepper.hpp"
#include "window.hpp"

namespace rouleau::bench {

namespace {

/// Of this thread, s: waiting takes none.
double processor_time() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What asking twice takes, s.
double time_to_ask() {
  constexpr int times = 2000;
  const double begin = processor_time();
  for (int i = 0; i < times; ++i) static_cast<void>(processor_time());
  return (processor_time() - begin) / times;
}

/// What a rank has received, in its order.
struct Received {
  struct Entry {
    int from;
    core::Message message;
  };
  std::vector<Entry> all;
  std::vector<std::size_t> before_step;  ///< so many
};

/// Writes down what comes.
class Recorder final : public core::Transport {
 public:
  Recorder(core::Transport& end, Received& received) : end_(end), received_(received) {}
  [[nodiscard]] int rank() const override { return end_.rank(); }
  [[nodiscard]] int ranks() const override { return end_.ranks(); }
  void send(int to, core::Message message) override { end_.send(to, std::move(message)); }
  [[nodiscard]] core::Message receive(int from) override {
    core::Message message = end_.receive(from);
    received_.all.push_back({from, message});
    return message;
  }
  void abandon() noexcept override { end_.abandon(); }

 private:
  core::Transport& end_;
  Received& received_;
};

/// Gives what was written down. What is sent goes nowhere.
class Player final : public core::Transport {
 public:
  Player(int rank, int ranks, const Received& received) : rank_(rank), ranks_(ranks), received_(received) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int ranks() const override { return ranks_; }
  void send(int, core::Message message) override { bytes += static_cast<double>(message.size()); }
  [[nodiscard]] core::Message receive(int from) override {
    if (ready_.empty() || ready_.front().from != from)
      throw std::logic_error("the rank alone does not wait for what it has waited for among others");
    core::Message message = std::move(ready_.front().message);
    ready_.pop_front();
    return message;
  }
  void abandon() noexcept override {}
  /// Copies what will be received before step `step`, as a network would bring it.
  void bring_until(std::size_t step) {
    const std::size_t until = step < received_.before_step.size() ? received_.before_step[step] : received_.all.size();
    while (next_ < until) ready_.push_back(received_.all[next_++]);
  }
  double bytes = 0;  ///< that were sent so far

 private:
  int rank_, ranks_;
  const Received& received_;
  std::size_t next_ = 0;
  std::deque<Received::Entry> ready_;
};

constexpr const char *lattice_messages = "messages of the lattice", *cell_messages = "messages about cells";

/// Processor time and bytes of the passes of some steps.
class Costs {
 public:
  explicit Costs(const Player* player) : player_(player) {}

  struct Part {
    std::string name;
    double seconds = 0, bytes = 0;
  };
  /// Those of a solver, timed.
  template <class T, class Set>
  core::StepPasses timed(core::Solver<T, Set>& solver);
  void forget() {
    for (Part& part : parts_) part.seconds = part.bytes = 0;
  }
  [[nodiscard]] const std::deque<Part>& parts() const { return parts_; }

 private:
  Part& part(const std::string& name) {
    for (Part& part : parts_) {
      if (part.name == name) return part;
    }
    return parts_.emplace_back(Part{name});
  }
  template <class Function>
  void time(Part& part, Function function) {
    const double sent = player_ != nullptr ? player_->bytes : 0, begin = processor_time();
    function();
    part.seconds += processor_time() - begin - asking_;
    part.bytes += (player_ != nullptr ? player_->bytes : 0) - sent;
  }

  const Player* player_;
  double asking_ = time_to_ask();
  std::deque<Part> parts_;  // they stay where they are
};

template <class T, class Set>
core::StepPasses Costs::timed(core::Solver<T, Set>& solver) {
  const bool ranks = solver.ranks().several();
  core::StepFeatures features{.viscosity_contrast = solver.fluid().setting().viscosity_contrast,
                              .moving_frame = solver.setup().follow_cells,
                              .ranks = ranks};
  solver.cell_tasks()->describe(features);
  const core::Schedule schedule = core::make_schedule(features);
  core::StepPasses passes = solver.passes();
  if (schedule.steps.size() != passes.passes.size()) throw std::logic_error("a solver's step is not the schedule's");
  for (std::size_t i = 0; i < passes.passes.size(); ++i) {
    core::Pass& pass = passes.passes[i];
    const core::Task task = schedule.steps[i].task;
    const bool of_lattice = task == core::Task::send_halo || task == core::Task::receive_halo;
    Part& own = part(of_lattice ? lattice_messages : pass.name == "ranks" ? cell_messages : pass.name);
    if (pass.run_rows) {
      pass.run_rows = [this, &own, run = std::move(pass.run_rows)](Range rows) { time(own, [&] { run(rows); }); };
    } else {
      pass.run = [this, &own, run = std::move(pass.run)](Worker worker) { time(own, [&] { run(worker); }); };
    }
    if (pass.after_ends) {
      Part& ends = part(lattice_messages);
      pass.after_ends = [this, &ends, run = std::move(pass.after_ends)] { time(ends, run); };
    }
  }
  return passes;
}

/// A window's fluid and cells in one piece, or one rank's part in them.
template <class T, class Set>
class Part : run::StepHooks {
 public:
  static constexpr int D = Set::dimension;

  Part(const Window<D>& window, const core::Ranks<D>& ranks)
      : runner_(ranks.several() ? window.runner : -1),
        speed_(window.fastest),
        cells_(window.cells),
        solver_(setup_of(window, ranks), cells_, ranks) {
    solver_.start();
    solver_.fluid().set_profile([&](double y) { return window.flow.velocity(y); },
                                [&](double y) { return window.flow.slope(y); });
    passes_ = with_runner(solver_.passes());
    stepper_.attend_next(run::Stepper::never);
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  [[nodiscard]] core::Solver<T, Set>& solver() { return solver_; }
  [[nodiscard]] const core::Cells<D>& cells() const { return cells_; }
  /// The runner moves before its nodes are located: who reads their velocities goes by that, here and on other ranks.
  [[nodiscard]] core::StepPasses with_runner(core::StepPasses passes) {
    if (runner_ < 0) return passes;
    core::Pass& locate = passes.passes[passes.passes.size() - 2];
    locate.run = [this, run = std::move(locate.run)](Worker worker) {
      if (cells_.owns(runner_)) move_runner();
      run(worker);
    };
    return passes;
  }
  void step(const core::StepPasses& passes) { step_ = stepper_.take(passes, step_, step_ + 1, 1); }
  void step() { step(passes_); }

 private:
  static core::BasicSolverSetup<D> setup_of(const Window<D>& window, const core::Ranks<D>& ranks) {
    core::BasicSolverSetup<D> setup = window.setup;
    if (ranks.several()) setup.domain = ranks.blocks->domain(ranks.transport->rank());
    return setup;
  }

  bool before_forces(long) override { return true; }
  bool after_forces(long, bool) override { return true; }
  [[nodiscard]] bool wants_a_look() const override { return false; }

  void move_runner() {
    constexpr double way = 3;  // spacings, there and back
    const long there = std::lround(std::ceil(way / speed_));
    const double by = moves_++ / there % 2 == 0 ? speed_ : -speed_;
    for (int i = cells_.cells[runner_].first; i < cells_.cells[runner_].end(); ++i) cells_.position[0][i] += by;
    cells_.largest_step[runner_] += speed_;
  }

  int runner_;
  double speed_;
  long step_ = 0, moves_ = 0;
  core::Cells<D> cells_;
  core::Solver<T, Set> solver_;
  core::StepPasses passes_;
  run::Stepper stepper_{*this};
};

/// What a rank has come to.
template <class T>
struct Outcome {
  std::vector<char> owned;     ///< of each cell
  std::vector<double> places;  ///< of the nodes of these
  std::vector<T> populations;  ///< of the block
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// The same of the cells and of the block that are another's; empty: its own.
template <class T, class Set>
Outcome<T> outcome(Part<T, Set>& part, const core::Box<Set::dimension>& block, const std::vector<char>& owned = {}) {
  constexpr int D = Set::dimension;
  Outcome<T> out{.owned = owned, .places = {}, .populations = {}};
  const core::Cells<D>& cells = part.cells();
  for (int c = 0; c < cells.cell_count(); ++c) {
    if (owned.empty()) out.owned.push_back(cells.owns(c) ? 1 : 0);
    if (out.owned[c] == 0) continue;
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      const auto& places = cells.position;
      for (int k = 0; k < D; ++k) out.places.push_back(places[k][i]);
    }
  }
  core::Fluid<T, Set>& fluid = part.solver().fluid();
  fluid.settle();
  std::vector<double> populations;
  for (int q = 0; q < Set::velocity_count; ++q) {
    fluid.copy_populations(q, populations);
    core::for_common_rows(fluid.setting().domain.block, block, [&](std::ptrdiff_t at, int count) {
      out.populations.insert(out.populations.end(), populations.begin() + at, populations.begin() + at + count);
    });
  }
  return out;
}

/// What one rank is told in some steps that all ranks of a window take, and what it comes to.
template <class T>
struct Recording {
  Received received;
  Outcome<T> outcome;
  long ghost_nodes = 0;  ///< that it knows of in the beginning
  double farthest = 0;   ///< that one of its nodes moves in the last step, spacings
};

template <int D>
long known_of_others(const core::Cells<D>& cells) {
  long nodes = 0;
  for (int c = 0; c < cells.cell_count(); ++c) nodes += cells.is(c, core::Whose::others) ? cells.cells[c].count : 0;
  return nodes;
}

template <class T, class Set>
Recording<T> record(const Window<Set::dimension>& window, std::size_t steps) {
  constexpr int D = Set::dimension;
  Recording<T> recording;
  const auto ends = core::make_loopback(window.blocks.ranks());
  std::mutex one_at_a_time;  // while every rank has all cells
  const auto take_steps = [&](int rank) {
    const bool own = rank == window.rank;
    Recorder recorder(*ends[rank], recording.received);
    core::Transport& end = own ? static_cast<core::Transport&>(recorder) : *ends[rank];
    std::unique_ptr<Part<T, Set>> part;
    {
      const std::lock_guard lock(one_at_a_time);
      part = std::make_unique<Part<T, Set>>(window, core::Ranks<D>{&window.blocks, &end});
    }
    if (own) recording.ghost_nodes = known_of_others<D>(part->cells());
    for (std::size_t i = 0; i < steps; ++i) {
      if (own) recording.received.before_step.push_back(recording.received.all.size());
      part->step();
    }
    if (own) recording.received.before_step.push_back(recording.received.all.size());
    part->solver().end_messages();
    if (!own) return;
    recording.outcome = outcome(*part, window.blocks.domain(rank).block);
    for (int c = 0; c < part->cells().cell_count(); ++c) {
      if (!part->cells().owns(c)) continue;
      const double step = part->cells().largest_step[c];
      if (!(step <= recording.farthest)) recording.farthest = step;
      if (!core::box_of<D>(part->cells(), c).usable()) recording.farthest = NAN;
    }
  };
  std::vector<std::exception_ptr> thrown(ends.size());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < window.blocks.ranks(); ++rank) {
    threads.emplace_back([&, rank] {
      try {
        take_steps(rank);
      } catch (const core::RankLost&) {  // the one that was lost says why
      } catch (...) {
        thrown[rank] = std::current_exception();
        ends[rank]->abandon();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
  return recording;
}

/// A rank that takes the steps of a recording alone.
template <class T, class Set>
class Replay {
 public:
  static constexpr int D = Set::dimension;

  Replay(const Window<D>& window, const Received& received)
      : player_(window.rank, window.blocks.ranks(), received), part_(window, {&window.blocks, &player_}) {}
  /// Calls function() for each step, after what it will receive has been brought.
  template <class Function>
  void for_steps(std::size_t first, std::size_t last, Function function) {
    for (std::size_t i = first; i < last; ++i) player_.bring_until(i + 1), function();
  }
  void end() { player_.bring_until(-1), part_.solver().end_messages(); }
  [[nodiscard]] Part<T, Set>& part() { return part_; }
  [[nodiscard]] const Player& player() const { return player_; }

 private:
  Player player_;
  Part<T, Set> part_;
};

constexpr std::size_t first_steps = 4;  // are left out: memory, lists
constexpr int replays = 5;

/// Time of a step and its parts: medians over the rounds.
struct StepTimes {
  std::vector<double> whole;
  std::vector<std::pair<std::string, std::vector<double>>> parts;
  double cell_bytes = 0;  ///< sent about cells

  void add(const Costs& costs, double steps) {
    for (const auto& part : costs.parts()) {
      auto at = std::find_if(parts.begin(), parts.end(), [&](const auto& known) { return known.first == part.name; });
      if (at == parts.end()) at = parts.insert(parts.end(), {part.name, {}});
      at->second.push_back(part.seconds / steps);
      if (part.name == cell_messages) cell_bytes = part.bytes / steps;
    }
  }
  [[nodiscard]] double of(const std::string& name) const {
    for (const auto& [known, seconds] : parts) {
      if (known == name) return median(seconds);
    }
    return 0;
  }
};

template <class T, class Set>
void time_alone(const Window<Set::dimension>& window, const Received& received, std::size_t steps, StepTimes& times) {
  {
    Replay<T, Set> replay(window, received);
    replay.for_steps(0, first_steps, [&] { replay.part().step(); });
    double seconds = 0;
    replay.for_steps(first_steps, steps, [&] {
      const double begin = processor_time();
      replay.part().step();
      seconds += processor_time() - begin;
    });
    times.whole.push_back(seconds / static_cast<double>(steps - first_steps));
  }
  Replay<T, Set> replay(window, received);
  Costs costs(&replay.player());
  const core::StepPasses passes = replay.part().with_runner(costs.timed(replay.part().solver()));
  replay.for_steps(0, first_steps, [&] { replay.part().step(passes); });
  costs.forget();
  replay.for_steps(first_steps, steps, [&] { replay.part().step(passes); });
  times.add(costs, static_cast<double>(steps - first_steps));
}

/// The whole window by one process.
template <class T, class Set>
void time_in_one_piece(const Window<Set::dimension>& window, std::size_t steps, StepTimes& times) {
  Part<T, Set> part(window, {});
  Costs costs(nullptr);
  const core::StepPasses passes = costs.timed(part.solver());
  for (std::size_t i = 0; i < first_steps; ++i) part.step(passes);
  costs.forget();
  for (std::size_t i = first_steps; i < steps; ++i) part.step(passes);
  times.add(costs, static_cast<double>(steps - first_steps));
}

/// How many steps: by the time that a round may take and by what can be remembered of messages.
template <class T, class Set>
std::size_t steps_of(const Window<Set::dimension>& window, const plan::RankCost& cost, double seconds) {
  constexpr double memory = 256e6, tried = 3;
  Part<T, Set> part(window, {});
  for (std::size_t i = 0; i < first_steps; ++i) part.step();
  const double begin = processor_time();
  for (int i = 0; i < tried; ++i) part.step();
  const double step = (processor_time() - begin) / tried;
  const double most = std::min({seconds / 2 / step, memory / std::max(cost.received_bytes, 1.0), 400.0});
  return first_steps + std::max<std::size_t>(8, static_cast<std::size_t>(most));
}

/// Passes that have nothing to do with ghosts, but for lists of what is near; the others' cost is shared with them.
bool is_own(const std::string& pass) {
  return pass == "fluid" || pass == "membrane" || pass == "interaction" || pass == "corrections";
}

std::string size_text(const std::array<int, 2>& size) {
  return std::to_string(size[0]) + " x " + std::to_string(size[1]);
}
std::string size_text(const std::array<int, 3>& size) {
  return size_text(std::array{size[0], size[1]}) + " x " + std::to_string(size[2]);
}

template <class T, class Set>
void print_costs(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks, int rank,
                 const plan::RankCost& cost, double seconds) {
  constexpr int D = Set::dimension;
  const Window<D> window = window_around(plan, blocks, rank);
  std::printf("\nRank %d of %d with its cells: its steps among %d %s, taken again alone; processor time of a step\n",
              rank, blocks.ranks(), window.blocks.ranks() - 1,
              window.merged ? "merged neighbours" : "blocks around it");
  if (window.cells.cells.empty()) {
    std::printf("  no cell is near this block\n");
    return;
  }
  const std::size_t steps = steps_of<T, Set>(window, cost, seconds);
  const Recording<T> recording = record<T, Set>(window, steps);
  if (!std::isfinite(recording.farthest))
    throw Error(Cause::bad_input, "the cells of rank " + std::to_string(rank) + " have no places after " +
                                      std::to_string(steps) + " steps: the scene does not stay stable");
  StepTimes own, all;
  for (int round = 0; round < replays; ++round) {
    time_in_one_piece<T, Set>(window, steps, all);
    time_alone<T, Set>(window, recording.received, steps, own);
  }
  std::printf(
      "  window of %s nodes with %d cells, %zu steps, %zu left out; the fastest node goes %.2g spacings a step\n",
      size_text(window.setup.domain.size).c_str(), window.cells.cell_count(), steps, first_steps, recording.farthest);
  std::printf("  %ld cells of its own with %ld nodes%s; %ld nodes of ghosts (rouleau plan: %ld)\n", cost.cells,
              cost.membrane_nodes, cost.cells == 0 ? ": it owns none" : "", recording.ghost_nodes, cost.ghost_nodes);
  if (window.runner >= 0)
    std::printf("  one cell far from the block goes to and fro at %.2g spacings a step, as fast as cells elsewhere\n",
                window.fastest);
  if (plan.scene->domain.tube_radius) std::printf("  the wall of the tube is left out\n");
  if (!plan.scene->fluid.layers.empty()) std::printf("  layers of the fluid are left out\n");

  // Ghosts: what the rank takes beyond its share of the window by one process, of the lattice or of the cells' nodes.
  const double of_lattice = static_cast<double>(cost.nodes) / static_cast<double>(window.setup.domain.nodes());
  const double of_cells = static_cast<double>(cost.membrane_nodes) / window.cells.node_count();
  std::printf("  %-46s %12s %12s of the window by one process\n", "us", "this rank", "its share");
  double own_part = 0, ghosts = 0;
  for (const auto& [name, times] : own.parts) {
    if (name == lattice_messages || name == cell_messages) continue;
    const double mine = median(times), share = all.of(name) * (name == "fluid" ? of_lattice : of_cells);
    std::printf("  %-46s %12.2f %12.2f\n", name.c_str(), mine * 1e6, share * 1e6);
    own_part += is_own(name) ? mine : share;
    ghosts += is_own(name) ? 0 : mine - share;
  }
  const double lattice = own.of(lattice_messages), cells = own.of(cell_messages);
  for (const char* name : {lattice_messages, cell_messages}) std::printf("  %-46s %12.2f\n", name, own.of(name) * 1e6);
  const double whole = median(own.whole);
  std::printf("  %-46s %12.2f\n", "whole step", whole * 1e6);

  const double word = plan.scene->numerics.precision == scene::Precision::f64 ? 8 : 4;
  const plan::CostOfSharing by = plan::cost_of_sharing[D - 2];
  const double plan_lattice = cost.lattice_bytes() / word * by.number_s,
               plan_ghosts = static_cast<double>(cost.ghost_nodes) * by.ghost_s,
               plan_shown = cost.sharing_s - cost.rows_s - plan_lattice - plan_ghosts;
  std::printf("  %-46s %12s %12s\n", "us", "this rank", "rouleau plan");
  const auto beside = [](const char* what, double measured, double expected) {
    std::printf("  %-46s %12.2f %12.2f\n", what, measured * 1e6, expected * 1e6);
  };
  beside("its own block and cells", own_part, cost.step_s + cost.rows_s);
  beside("ghosts, packing and unpacking of cells", ghosts + cells, plan_ghosts + plan_shown);
  beside("packing and unpacking of the lattice", lattice, plan_lattice);
  beside("whole step without a network", whole, cost.step_s + cost.sharing_s);
  std::printf("  %-46s %12.2f %12.2f kB\n", "sent about cells", own.cell_bytes / 1e3, cost.membrane_bytes() / 1e3);
}

template <class Set>
void print_costs(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks, int rank,
                 const plan::RankCost& cost, double seconds) {
  if (plan.scene->numerics.precision == scene::Precision::f64)
    return print_costs<double, Set>(plan, blocks, rank, cost, seconds);
  print_costs<float, Set>(plan, blocks, rank, cost, seconds);
}

template <class T, class Set>
void check(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks, int rank,
           const plan::RankCost& cost, bool crosses) {
  constexpr int D = Set::dimension;
  constexpr std::size_t steps = 12;
  const auto require = [](bool holds, const std::string& otherwise) {
    if (!holds) throw std::runtime_error("one rank with its cells: " + otherwise);
  };
  Window<D> window = window_around(plan, blocks, rank);
  window.runner = -1;  // one process does not hear of it in time
  const core::Box<D> block = window.blocks.domain(window.rank).block;
  const Recording<T> recording = record<T, Set>(window, steps);
  const long own = std::count(recording.outcome.owned.begin(), recording.outcome.owned.end(), 1);
  require(own == cost.cells, "it owns " + std::to_string(own) + " cells, expected are " + std::to_string(cost.cells));
  require(recording.ghost_nodes == cost.ghost_nodes, "it knows " + std::to_string(recording.ghost_nodes) +
                                                         " nodes of others, expected are " +
                                                         std::to_string(cost.ghost_nodes));
  require(!crosses || cost.ghost_nodes > 0, "no cell crosses its border");
  require(own == 0 || recording.farthest > 0, "nothing moves");

  Part<T, Set> one(window, {});
  for (std::size_t i = 0; i < steps; ++i) one.step();
  require(outcome(one, block, recording.outcome.owned) == recording.outcome, "it is not what one process computes");

  Replay<T, Set> replay(window, recording.received);
  replay.for_steps(0, steps, [&] { replay.part().step(); });
  replay.end();
  require(outcome(replay.part(), block) == recording.outcome, "alone it is not what it was among others");
}

}  // namespace

void rank_table(const plan::Plan& plan, const plan::Blocks& blocks, int rank, const plan::RankCost& cost,
                double seconds) {
  if (const auto* plane = std::get_if<core::Decomposition<2>>(&blocks)) {
    print_costs<core::D2Q9>(plan, *plane, rank, cost, seconds);
  } else {
    print_costs<core::D3Q19>(plan, std::get<core::Decomposition<3>>(blocks), rank, cost, seconds);
  }
}

void check_rank() {
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const auto with_plan = [&](const char* file, const std::vector<std::string>& changes, int ranks, auto function) {
    const scene::Scene scene = plan::read_scene(file, changes);
    const plan::Plan plan = plan::make_plan(scene, catalog);
    const plan::Blocks blocks = plan::make_blocks(plan, ranks);
    function(plan, blocks, plan::rank_costs(plan, blocks));
  };
  // Cells near a wall and over the periodic border, of a lattice that is larger than the window.
  with_plan(ROULEAU_SCENES "/four-cells-shear.json",
            {"/domain/size=[\"75.264 um\", \"100.352 um\"]", "/domain/nodes=[384, 512]",
             R"(/stages=[{"name": "shear", "shear_rate": "50 1/s", "strain": 5, "start": "developed"}])",
             R"(/cells=[{"type": "rbc", "row": {"count": 4, "spacing": "3.52 um", "axis": "x", "angle": "90 deg",
                 "center": ["1 um", "5 um"]}}])"},
            24, [](const plan::Plan& plan, const plan::Blocks& blocks, const std::vector<plan::RankCost>& costs) {
              const auto& plane = std::get<core::Decomposition<2>>(blocks);
              for (int rank = 0; rank < plane.ranks(); ++rank) {
                if (costs[rank].ghost_nodes > 0) check<double, core::D2Q9>(plan, plane, rank, costs[rank], true);
              }
            });
  with_plan(ROULEAU_SCENES "/doublet-3d.json", {"/cells/0/row/center=[\"11.5 um\", \"0.4 um\", \"11.8 um\"]"}, 8,
            [](const plan::Plan& plan, const plan::Blocks& blocks, const std::vector<plan::RankCost>& costs) {
              check<float, core::D3Q19>(plan, std::get<core::Decomposition<3>>(blocks), 0, costs[0], true);
            });
  std::printf("  one rank with its cells computes what one process does, and alone the same again, bit by bit\n");
}

}  // namespace rouleau::bench
