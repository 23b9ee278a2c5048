#include "window.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/fluid/node_mask.hpp"
#include "core/solver/ghost_cells.hpp"
#include "plan/solver_setup.hpp"

namespace rouleau::bench {

namespace {

constexpr double clear = 6;  ///< spacings between cells and an end of the window that the scene does not have
constexpr int most_blocks = 48;

/// How far from a block the cells may reach that its rank hears of.
template <int D>
double margin_of(const core::GhostReach& reach, double longest_cell) {
  const double skin = core::GhostCells<D>::skin;
  const double of_lattice = reach.lattice + skin + core::NodeMask::nodes_per_bit + longest_cell;
  const double of_cells = reach.contact > 0 ? 1.5 * longest_cell + reach.contact + 2 * skin : 0;
  return std::max(of_lattice, of_cells) + clear + 2;
}

/// Whether it ends before the lattice does.
template <int D>
bool cut_off(const core::Box<D>& window, const core::Domain<D>& lattice, int axis) {
  return window.size(axis) < lattice.size[axis];
}

/// Along the first axis it begins at a whole group of nodes, as what cells are near goes by them.
template <int D>
core::Box<D> box_around(const core::Domain<D>& lattice, const core::Box<D>& block, double margin) {
  const double grain = core::NodeMask::nodes_per_bit;
  core::Box<D> window;
  for (int k = 0; k < D; ++k) {
    window.begin[k] = static_cast<int>(std::floor((block.begin[k] - margin) / grain) * grain);
    window.end[k] = static_cast<int>(std::ceil((block.end[k] + margin) / grain) * grain);
    if (lattice.walled(k)) {
      window.begin[k] = std::max(window.begin[k], 0), window.end[k] = std::min(window.end[k], lattice.size[k]);
    } else if (window.size(k) >= lattice.size[k]) {
      window.begin[k] = 0, window.end[k] = lattice.size[k];
    }
  }
  return window;
}

template <int D>
core::Box<D> moved(core::Box<D> box, const std::array<int, D>& by) {
  for (int k = 0; k < D; ++k) box.begin[k] += by[k], box.end[k] += by[k];
  return box;
}

/// The blocks of the scene, as far as they lie in the window, that of the rank first.
template <int D>
std::vector<core::Box<D>> blocks_within(const core::Decomposition<D>& blocks, int rank, const core::Box<D>& window) {
  const core::Domain<D> lattice = blocks.domain(rank);
  std::vector<core::Box<D>> parts{lattice.block};
  int images = 1;
  for (int k = 0; k < D; ++k) images *= 3;
  for (int image = 0; image < images; ++image) {
    std::array<int, D> shift, back;
    bool there = true, itself = true;
    for (int k = 0, digits = image; k < D; ++k, digits /= 3) {
      const int periods = (digits % 3 + 1) % 3 - 1;
      there = there && (periods == 0 || (lattice.periodic[k] && cut_off(window, lattice, k)));
      itself = itself && periods == 0;
      shift[k] = periods * lattice.size[k], back[k] = -shift[k];
    }
    if (!there) continue;
    const core::Box<D> seen = moved<D>(window, back);
    for (const int other : blocks.meeting(seen)) {
      if (other != rank || !itself) parts.push_back(moved<D>(blocks.domain(other).block.common(seen), shift));
    }
  }
  return parts;
}

/// The block, and what is beside it across each side, edge and corner.
template <int D>
std::vector<core::Box<D>> sides_of(const core::Box<D>& block, const core::Box<D>& window) {
  std::vector<core::Box<D>> parts{window};
  for (int k = 0; k < D; ++k) {
    std::vector<core::Box<D>> sliced;
    const int cuts[] = {window.begin[k], block.begin[k], block.end[k], window.end[k]};
    for (core::Box<D> part : parts) {
      for (int i = 0; i < 3; ++i) {
        part.begin[k] = cuts[i], part.end[k] = cuts[i + 1];
        if (part.size(k) > 0) sliced.push_back(part);
      }
    }
    parts = std::move(sliced);
  }
  std::iter_swap(parts.begin(), std::find(parts.begin(), parts.end(), block));
  return parts;
}

/// How far a cell lies from a block along some axis; 0: its box meets it.
template <int D>
double distance(const core::BoundingBox<D>& cell, const core::Box<D>& block) {
  double far = 0;
  for (int k = 0; k < D; ++k) far = std::max({far, block.begin[k] - cell.most[k], cell.least[k] - block.end[k]});
  return far;
}

/// Adds the cell that is the only one of `one`, moved.
template <int D>
void append(core::Cells<D>& cells, const core::Cells<D>& one, const std::array<double, D>& by) {
  core::CellRange range = one.cells.front();
  range.first = cells.node_count();
  cells.cells.push_back(range);
  for (int k = 0; k < D; ++k) {
    for (const double place : one.position[k]) cells.position[k].push_back(place + by[k]);
    for (auto* arrays : {&cells.force, &cells.velocity}) (*arrays)[k].resize(cells.position[k].size(), 0.0);
  }
}

/// By how much to move a cell so that it lies in the window; none where it does not.
template <int D>
std::optional<std::array<double, D>> into(const core::Box<D>& window, const core::Domain<D>& lattice,
                                          const core::BoundingBox<D>& cell) {
  std::array<double, D> by;
  for (int k = 0; k < D; ++k) {
    const int size = lattice.size[k];
    const bool below = cut_off(window, lattice, k) && (lattice.periodic[k] || window.begin[k] > 0),
               above = cut_off(window, lattice, k) && (lattice.periodic[k] || window.end[k] < size);
    double shift = 0;
    if (lattice.periodic[k] && below) shift = std::ceil((window.begin[k] + clear - cell.least[k]) / size) * size;
    if (below && cell.least[k] + shift < window.begin[k] + clear) return {};
    if (above && cell.most[k] + shift > window.end[k] - 1 - clear) return {};
    by[k] = shift - window.begin[k];
  }
  return by;
}

}  // namespace

template <int D>
Window<D> window_around(const plan::Plan& plan, const core::Decomposition<D>& blocks, int rank) {
  const scene::Scene& scene = *plan.scene;
  const double spacing = scene::lattice_spacing(scene);
  const core::Domain<D> lattice = blocks.domain(rank);
  auto setup = plan::make_solver_setup<D>(plan, 0);

  std::vector<core::BoundingBox<D>> boxes;
  double longest = 0;
  plan::for_each_cell<D>(scene, spacing, [&](std::size_t, const core::Cells<D>& cell) {
    boxes.push_back(core::box_of<D>(cell, 0));
    for (int k = 0; k < D; ++k) longest = std::max(longest, boxes.back().most[k] - boxes.back().least[k]);
  });
  const core::Box<D> box = box_around(lattice, lattice.block, margin_of<D>(core::ghost_reach(setup), longest));

  std::vector<core::Box<D>> parts = blocks_within(blocks, rank, box);
  const bool merged = parts.size() > most_blocks;
  if (merged) parts = sides_of(lattice.block, box);
  std::array<int, D> home, size;
  for (int k = 0; k < D; ++k) home[k] = -box.begin[k], size[k] = box.size(k);
  for (core::Box<D>& part : parts) part = moved<D>(part, home);
  // What all find out together goes over the first rank, and hardly over the others: the block's is one of these.
  const int own = parts.size() > 1 ? 1 : 0;
  std::swap(parts.front(), parts[own]);
  const core::Box<D> block = parts[own];
  const core::Domain<D> domain(size, lattice.periodic);

  typename Window<D>::Flow flow;
  if (lattice.walled(1) && !scene.domain.tube_radius)
    flow = {.of_scene = core::channel_flow(setup), .bottom = static_cast<double>(box.begin[1])};
  const auto speed = [&](const core::BoundingBox<D>& cell) {
    const double bottom = box.begin[1];
    return std::max(std::abs(flow.velocity(cell.least[1] - bottom)), std::abs(flow.velocity(cell.most[1] - bottom)));
  };
  double fastest = 0, here = 0, farthest = 0;
  int runner = -1;
  core::Cells<D> cells;
  plan::for_each_cell<D>(scene, spacing, [&](std::size_t c, const core::Cells<D>& cell) {
    cells.types = cell.types;
    fastest = std::max(fastest, speed(boxes[c]));
    const auto by = into(box, lattice, boxes[c]);
    if (!by) return;
    here = std::max(here, speed(boxes[c]));
    append<D>(cells, cell, *by);
    const int last = cells.cell_count() - 1;
    const double far = distance<D>(core::box_of<D>(cells, last), block);
    if (far > farthest) farthest = far, runner = last;
  });
  if (!(fastest > 1.1 * here)) runner = -1;

  setup.domain = domain;
  setup.region = nullptr;
  setup.solid = nullptr;
  setup.layers.clear();
  setup.oscillation = {};
  setup.mean_velocity = 0;
  setup.developed = false;
  setup.walls = {flow.velocity(-0.5), flow.velocity(size[1] - 0.5)};
  if (scene.domain.tube_radius || !(lattice.walled(1) || lattice.walled(D - 1))) setup.wall_interactions.clear();

  return {.blocks = {domain, std::move(parts)},
          .rank = own,
          .merged = merged,
          .cells = std::move(cells),
          .setup = std::move(setup),
          .fastest = fastest,
          .runner = runner,
          .flow = flow};
}

template Window<2> window_around(const plan::Plan&, const core::Decomposition<2>&, int);
template Window<3> window_around(const plan::Plan&, const core::Decomposition<3>&, int);

}  // namespace rouleau::bench
