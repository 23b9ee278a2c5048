// The simulator: fluid, membranes and what couples them, stepped by any number of workers.
#pragma once

#include <memory>
#include <optional>

#include "any_solver.hpp"
#include "cell_tasks.hpp"
#include "core/fluid/fluid.hpp"
#include "schedule.hpp"

namespace rouleau::core {

/// T: of the populations; Set: D2Q9 or D3Q19.
template <class T, class Set = D2Q9>
class Solver final : public AnySolver<Set::dimension> {
  using Any = AnySolver<Set::dimension>;

 public:
  static constexpr int dimension = Set::dimension;
  using typename Any::Cells, typename Any::Setup;
  using CellTasks = core::CellTasks<T, dimension>;

  /// The fluid is at rest until start(); `cells` must outlive the solver. Throws std::invalid_argument for a setup
  /// without nodes or collision operator, and for cells with what their dimension does not have.
  /// `ranks`: who computes the other blocks, if the domain's block is not the whole lattice.
  /// `ghosts`: of these ranks, with at least ghost_reach(setup): what this one is to know of the cells, of which no
  /// more is read; none: it is given all of every cell, and owners are found by place.
  Solver(Setup setup, Cells& cells, const Ranks<dimension>& ranks = {},
         std::optional<GhostCells<dimension>> ghosts = {});

  void start(Any* former = nullptr) override;
  void start(SolverState state) override;
  void renew_cells(std::optional<GhostCells<dimension>> ghosts) override;

  [[nodiscard]] Fluid<T, Set>& fluid() override { return fluid_; }
  [[nodiscard]] const Fluid<T, Set>& fluid() const override { return fluid_; }
  [[nodiscard]] CellTasks* cell_tasks() override { return cell_tasks_.get(); }
  [[nodiscard]] const CellTasks* cell_tasks() const override { return cell_tasks_.get(); }

 private:
  void make_passes();
  /// How this step cuts rows.
  [[nodiscard]] RowBands bands() const;
  /// The fluid is driven as an oscillation wants it in the step that begins after so many.
  void oscillate(long steps);
  /// The force that keeps the mean velocity, from what this is now.
  void keep_mean_velocity();
  void run(Task task, Worker worker);
  void run_rows(Task task, Range rows);

  using Any::setup_, Any::cells_, Any::flow_control_, Any::passes_;
  Fluid<T, Set> fluid_;
  std::unique_ptr<CellTasks> cell_tasks_;
  long steps_ = 0;  ///< taken since start()
};

extern template class Solver<float>;
extern template class Solver<double>;
extern template class Solver<float, D3Q19>;
extern template class Solver<double, D3Q19>;

}  // namespace rouleau::core
