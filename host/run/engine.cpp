#include "engine.hpp"

#include <utility>

#include "plan/placed_cells.hpp"
#include "plan/ranks/blocks.hpp"
#include "scene/lattice.hpp"

namespace rouleau::run {

template <int D>
core::Domain<D> Engine<D>::domain() const {
  return ranks_.several() ? ranks_.blocks->domain(ranks_.transport->rank()) : scene::lattice_domain<D>(*plan_.scene);
}

template <int D>
auto Engine<D>::boxes_of_all() -> Boxes {
  return ranks_.several() && plan_.has_cells ? solver_->cell_tasks()->boxes_of_all() : Boxes{};
}

template <int D>
auto Engine<D>::prepare(int stage, const Boxes& boxes, std::vector<int> owner) const -> Start {
  Start start{plan::make_solver_setup<D>(plan_, stage, walls_), {}, {}};
  start.setup.domain = domain();
  if (ranks_.several() && plan_.has_cells)
    start.part.emplace(ranks_, boxes, core::ghost_reach(start.setup), std::move(owner));
  return start;
}

template <int D>
auto Engine<D>::place_cells(observe::Observer& observer) -> Start {
  const scene::Scene& scene = *plan_.scene;
  if (!plan_.has_cells) return prepare(0, {}, {});
  if (!ranks_.several()) {
    cells_ = plan::make_cells<D>(scene);
    observer.begin_with(cells_);
    return prepare(0, {}, {});
  }
  Boxes boxes;
  boxes.reserve(scene.cells.size());
  plan::for_each_cell<D>(scene, scene::lattice_spacing(scene), [&](std::size_t, const Cells& cell) {
    boxes.push_back(core::box_of<D>(cell, 0));
    observer.begin_with(cell);
  });
  Start start = prepare(0, boxes, owner_);
  cells_ = plan::make_known_cells<D>(scene, [&](int cell) { return start.part->knows(cell); });
  return start;
}

template <int D>
auto Engine<D>::restore_cells(const std::shared_ptr<const files::CheckpointReader>& reader, RunState& state,
                              files::DirectoryMark& mark) -> Start {
  const scene::Scene& scene = *plan_.scene;
  // Room for them; who has an array of cells that are there already keeps it.
  if (cells_.cells.empty()) cells_ = plan::make_known_cells<D>(scene, [](int) { return false; });
  // Which node of a surface tells its tank treading follows from how it was placed, and from nothing else.
  if constexpr (D == 3)
    plan::for_each_cell<D>(scene, scene::lattice_spacing(scene),
                           [&](std::size_t, const Cells& cell) { state.observer.begin_with(cell); });
  std::optional<Start> start;
  TakePart<D> take_part;
  if (ranks_.several() && plan_.has_cells) {
    take_part = [&](const Boxes& boxes) {
      start = prepare(state.stage, boxes, owner_);
      start->part->set_parts(cells_);
    };
  }
  Restored restored = restore<D>(reader, plan_, domain().block, state, cells_, take_part);
  if (!start) start = prepare(state.stage, {}, {});
  start->state = std::move(restored.solver);
  mark = std::move(restored.directory);
  return *std::move(start);
}

template <int D>
void Engine<D>::begin(Start start) {
  const bool single = plan_.scene->numerics.precision == scene::Precision::f32;
  auto next = core::make_solver<D>(single, std::move(start.setup), cells_, ranks_, std::move(start.part));
  if (start.state) {
    next->start(*std::move(start.state));
  } else {
    next->start(solver_.get());
  }
  solver_ = std::move(next);
}

template <int D>
void Engine<D>::begin_stage(int stage) {
  Start start = prepare(stage, boxes_of_all(), owner_);
  if (start.part) solver_->cell_tasks()->pass_on(*start.part);
  begin(std::move(start));
}

template <int D>
void Engine<D>::cut_again(int stage, long stage_step, const std::vector<double>& seconds) {
  const core::Ranks<D> before = ranks_;
  auto blocks = std::make_unique<const core::Decomposition<D>>(plan::cut_again<D>(plan_, before, cells_, seconds));
  const Boxes boxes = boxes_of_all();
  ranks_.blocks = blocks.get();
  core::AnyFluid<D>& fluid = solver_->fluid();
  fluid.settle();
  Start start = prepare(stage, boxes, {});
  start.state = core::SolverState{.populations =
                                      [&](int q) {
                                        std::vector<double> values;
                                        fluid.copy_populations(q, values);
                                        return core::rearrange(before, *blocks, values);
                                      },
                                  .walls_have_acted = fluid.walls_have_acted(),
                                  .steps = stage_step};
  if (const auto& control = solver_->flow_control()) start.state->flow_control = control->state();
  if (start.part) start.state->viscosity = solver_->cell_tasks()->pass_on(*start.part);
  begin(std::move(start));
  blocks_ = std::move(blocks);
}

template class Engine<2>;
template class Engine<3>;

}  // namespace rouleau::run
