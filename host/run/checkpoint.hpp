// The state of a run in its checkpoint: fluid, membranes and what the run has counted and followed so far.
//
// A checkpoint is taken between two steps, before the forces of the next one. What can be computed again from positions
// and populations is left out, except where it lags behind them: viscosities are renewed only when nodes have moved.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "core/solver/any_solver.hpp"
#include "files/checkpoint_file.hpp"
#include "files/run_directory.hpp"
#include "json/json.hpp"
#include "run_state.hpp"

namespace rouleau::run {

/// The checkpoints of a run: when one is due, and the two steps in which it is made.
class Checkpoints {
 public:
  /// `directory`: null on ranks that do not write, which take part in everything else.
  Checkpoints(const scene::Scene& scene, files::RunDirectory* directory)
      : seconds_(scene.output.checkpoint_seconds), to_(directory) {}

  /// Whether the scene wants any.
  [[nodiscard]] bool wanted() const { return seconds_.has_value(); }
  /// Whether the scene's time between two has passed.
  [[nodiscard]] bool due() const {
    return wanted() && std::chrono::duration<double>(Clock::now() - last_).count() >= *seconds_;
  }
  /// Writes the file, beside the last one. All ranks together, between two steps whose messages have been taken.
  template <int D>
  void write(const plan::Plan& plan, int threads, const RunState& state, core::AnySolver<D>& solver);
  [[nodiscard]] bool pending() const { return pending_; }
  /// The file takes its place if the state has been found sound. One that is not is left to the next regular check:
  /// when checkpoints are written must not change what becomes of a run.
  void settle(bool sound);
  /// Step of the checkpoint that the directory has, if it has one.
  [[nodiscard]] std::optional<long> kept() const { return kept_; }
  /// The run goes on from the directory's checkpoint.
  void go_on_from(long step) { kept_ = step; }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double> seconds_;
  files::RunDirectory* to_;
  bool pending_ = false;
  std::unique_ptr<files::CheckpointWriter> writer_;
  long step_ = 0;  ///< of the pending one
  std::optional<long> kept_;
  Clock::time_point last_ = Clock::now();
};

/// What a checkpoint holds beside the run's state and the membranes.
struct Restored {
  core::SolverState solver;        ///< which keeps the file open
  files::DirectoryMark directory;  ///< how far the files of the directory had come
};
/// Tells the cells this rank's part in them (GhostCells::set_parts), by their boxes where it needs these.
template <int D>
using TakePart = std::function<void(const std::function<std::vector<core::BoundingBox<D>>()>& read_boxes)>;
/// Into the state and the cells of the same scene; `block`: of the lattice, that the solver will compute; `take_part`:
/// null where this rank has all cells. No memory is taken for what others alone know of cells. Throws
/// Error(input_output) where the checkpoint does not fit.
template <int D>
Restored restore(const std::shared_ptr<const files::CheckpointReader>& reader, const plan::Plan& plan,
                 const core::Box<D>& block, RunState& state, typename core::AnySolver<D>::Cells& cells,
                 const TakePart<D>& take_part = {});

}  // namespace rouleau::run
