#include "engine.hpp"

#include <algorithm>
#include <numeric>
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
std::vector<int> Engine<D>::present() const {
  std::vector<int> there;
  const core::GhostCells<D>* const ghosts = solver_->ghosts();
  for (int c = 0; c < cells_.cell_count(); ++c)
    if (ghosts != nullptr ? ghosts->owner(c) != core::GhostCells<D>::nobody : cells_.knows(c)) there.push_back(c);
  return there;
}

template <int D>
std::vector<int> Engine<D>::owners(const Boxes& boxes, const std::vector<int>& there,
                                   const std::vector<int>& given) const {
  if (!ranks_.several() || !plan_.scene->domain.openings) return given;
  std::vector<int> all(boxes.size(), core::GhostCells<D>::nobody);
  for (const int c : there) {
    all[c] =
        c < static_cast<int>(given.size()) ? given[c] : core::GhostCells<D>::owner_by_place(boxes[c], *ranks_.blocks);
  }
  return all;
}

template <int D>
auto Engine<D>::place_cells(observe::Observer& observer) -> Start {
  const scene::Scene& scene = *plan_.scene;
  if (!plan_.has_cells) return prepare(0, {}, {});
  if (!ranks_.several() && !scene.domain.openings) {
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
  boxes.resize(scene.cells.size(), core::BoundingBox<D>::unknown());
  std::vector<int> there(scene.placed().size());
  std::iota(there.begin(), there.end(), 0);
  Start start = prepare(0, boxes, owners(boxes, there, owner_));
  cells_ = plan::make_known_cells<D>(
      scene, [&](int cell) { return start.part ? start.part->knows(cell) : cell < static_cast<int>(there.size()); });
  if (!start.part) cells_.keep_only(std::move(there));
  return start;
}

template <int D>
auto Engine<D>::restore_cells(const std::shared_ptr<const files::CheckpointReader>& reader, RunState& state,
                              files::DirectoryMark& mark) -> Start {
  const scene::Scene& scene = *plan_.scene;
  // Room for them; who has an array of cells that are there already keeps it.
  if (cells_.cells.empty()) cells_ = plan::make_known_cells<D>(scene, [](int) { return false; });
  std::optional<Start> start;
  TakePart<D> take_part;
  if (ranks_.several() && plan_.has_cells) {
    take_part = [&](const auto& read_boxes) {
      const Boxes boxes = read_boxes();
      start = prepare(state.stage, boxes, owners(boxes, state.traffic.cells.there(), owner_));
      start->part->set_parts(cells_);
    };
  } else if (observe::has_traffic(scene)) {
    take_part = [&](const auto&) { cells_.keep_only(state.traffic.cells.there()); };
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
  if (start.state)
    next->start(*std::move(start.state));
  else
    next->start(solver_.get());
  solver_ = std::move(next);
}

template <int D>
void Engine<D>::begin_stage(int stage) {
  const Boxes boxes = boxes_of_all();
  Start start = prepare(stage, boxes, owners(boxes, present(), owner_));
  if (start.part) solver_->cell_tasks()->pass_on(*start.part);
  begin(std::move(start));
}

template <int D>
void Engine<D>::change_cells(const std::vector<int>& gone, const std::vector<Arrival>& come) {
  // Checkpoints hold what is left of them, which is the same on all ranks.
  for (const int c : gone) {
    const core::CellRange& cell = cells_.cells[c];
    cells_.largest_step[c] = 0;
    if (!cells_.area_leakage.empty()) cells_.area_leakage[c] = 0;
    for (auto* of_nodes : {&cells_.position, &cells_.velocity, &cells_.force})
      for (int k = 0; k < D; ++k) std::fill_n((*of_nodes)[k].begin() + cell.first, cell.count, 0.0);
  }
  for (const Arrival& arrival : come) {
    const core::CellRange& cell = cells_.cells[arrival.cell];
    for (int k = 0; k < D; ++k) {
      std::copy_n(arrival.nodes.position[k].begin(), cell.count, cells_.position[k].begin() + cell.first);
      for (auto* of_nodes : {&cells_.velocity[k], &cells_.force[k]})
        std::fill_n(of_nodes->begin() + cell.first, cell.count, 0.0);
    }
    for (core::ElementState& state : cells_.state)
      std::fill_n(state.value.begin() + cell.first, cell.count, state.initial);
  }
  if (const core::GhostCells<D>* const ghosts = solver_->ghosts()) {
    Boxes boxes = boxes_of_all();
    std::vector<int> owner(cells_.cells.size());
    for (int c = 0; c < cells_.cell_count(); ++c) owner[c] = ghosts->owner(c);
    for (const int c : gone) owner[c] = core::GhostCells<D>::nobody;
    for (const Arrival& arrival : come) {
      boxes[arrival.cell] = core::box_of<D>(arrival.nodes, 0);
      owner[arrival.cell] = core::GhostCells<D>::owner_by_place(boxes[arrival.cell], *ranks_.blocks);
    }
    core::GhostCells<D> part(ranks_, boxes, core::ghost_reach(solver_->setup()), std::move(owner));
    solver_->cell_tasks()->pass_on(part);
    solver_->renew_cells(std::move(part));
    return;
  }
  std::vector<int> there = present();
  std::erase_if(there, [&](int c) { return std::find(gone.begin(), gone.end(), c) != gone.end(); });
  for (const Arrival& arrival : come) there.push_back(arrival.cell);  // the last that there are
  cells_.keep_only(std::move(there));
  solver_->renew_cells({});
}

template <int D>
void Engine<D>::cut_again(int stage, long stage_step, const std::vector<double>& seconds) {
  const core::Ranks<D> before = ranks_;
  auto blocks = std::make_unique<const core::Decomposition<D>>(plan::cut_again<D>(plan_, before, cells_, seconds));
  const Boxes boxes = boxes_of_all();
  ranks_.blocks = blocks.get();
  core::AnyFluid<D>& fluid = solver_->fluid();
  fluid.settle();
  Start start = prepare(stage, boxes, owners(boxes, present(), {}));
  start.state = core::SolverState{.populations =
                                      [&](int q) {
                                        std::vector<double> values;
                                        fluid.copy_populations(q, values);
                                        return core::rearrange(before, *blocks, values);
                                      },
                                  .walls_have_acted = fluid.walls_have_acted(),
                                  .links = fluid.link_memory(),
                                  .steps = stage_step};
  if (const auto& control = solver_->flow_control()) start.state->flow_control = control->state();
  if (start.part) start.state->viscosity = solver_->cell_tasks()->pass_on(*start.part);
  begin(std::move(start));
  blocks_ = std::move(blocks);
}

template class Engine<2>;
template class Engine<3>;

}  // namespace rouleau::run
