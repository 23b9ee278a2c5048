#include "rank_costs.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iomanip>
#include <set>
#include <sstream>
#include <type_traits>
#include <utility>

#include "base/text.hpp"
#include "core/domain/halo.hpp"
#include "core/fluid/lattice.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/rounding.hpp"
#include "core/solver/ghost_cells.hpp"
#include "plan/constants.hpp"
#include "plan/estimate.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "shape/random_cells.hpp"

namespace rouleau::plan {

namespace {

/// Bytes that a rank takes besides its block: measured (docs/results/scaling-2026-11.md).
namespace memory {
constexpr double of_process = 30e6;   ///< the program, its libraries and MPI
constexpr double of_each_cell = 600;  ///< of the scene: as it was read, where it begins, what lists of it are empty
/// On the first rank, which writes: what is measured of each cell, and what becomes of those that are remembered, which
/// are ten thousand at most (observe::most_cells_remembered).
constexpr double of_writer(double cells) { return 10e6 + 1200 * cells + 1300 * std::min(cells, 1e4); }
/// Of a rank's own nodes and those of its ghosts, of which surfaces keep no lists. `cells`: as many have these nodes.
constexpr double of_known(int dimension, double own, double ghosts, double cells) {
  constexpr double of_own[2] = {250, 1200}, of_ghost[2] = {250, 250}, of_cell[2] = {5000, 0};
  return of_own[dimension - 2] * own + of_ghost[dimension - 2] * ghosts + of_cell[dimension - 2] * cells;
}
}  // namespace memory

template <int D>
using SetOf = std::conditional_t<D == 2, core::D2Q9, core::D3Q19>;

/// The ranks whose blocks lie within the reach of stencils of a rank's own, itself included, across periodic borders
/// too.
template <int D>
std::vector<int> ranks_near(const core::Decomposition<D>& blocks, int rank) {
  const core::Domain<D> domain = blocks.domain(rank);
  core::BoundingBox<D> box;
  for (int k = 0; k < D; ++k) box.least[k] = domain.block.begin[k], box.most[k] = domain.block.end[k] - 1;
  std::set<int> near;
  core::for_nodes_near(box, core::Field<float, D>::halo, 1, domain, [&](const core::Box<D>& nodes) {
    const std::vector<int> met = blocks.meeting(nodes);
    near.insert(met.begin(), met.end());
  });
  return {near.begin(), near.end()};
}

template <int D>
double volume(const core::Box<D>& box) {
  double product = 1;
  for (int k = 0; k < D; ++k) product *= std::max(0, box.size(k));
  return product;
}

/// Calls function(nodes, out, other) with the nodes that core::for_halo_nodes goes through, in boxes, each with the
/// rank that owns them, one of those near.
template <int D, class Function>
void for_halo_boxes(const core::Decomposition<D>& blocks, int rank, const std::vector<int>& near, int below, int above,
                    Function function) {
  const core::Domain<D> domain = blocks.domain(rank);
  const int sides = D == 2 ? 9 : 27;
  for (int side = 0; side < sides; ++side) {
    core::Box<D> nodes;
    std::array<int, D> out, first, last;  // first, last: periods from the lattice to the images that the nodes are of
    bool foreign = false;
    for (int k = 0, rest = side; k < D; ++k, rest /= 3) {
      out[k] = rest % 3 - 1;
      const int begin = domain.block.begin[k], end = domain.block.end[k], size = domain.size[k];
      nodes.begin[k] = out[k] < 0 ? begin - below : (out[k] == 0 ? begin : end);
      nodes.end[k] = out[k] < 0 ? begin : (out[k] == 0 ? end : end + above);
      first[k] = domain.periodic[k] ? (nodes.begin[k] + size * below) / size - below : 0;
      last[k] = domain.periodic[k] ? (nodes.end[k] - 1 + size * below) / size - below : 0;
      foreign = foreign || (out[k] != 0 && !domain.wraps(k));
    }
    if (!foreign) continue;
    std::array<int, D> period = first;
    int carried = 0;
    do {
      for (const int other : near) {
        core::Box<D> owned = blocks.domain(other).block;
        for (int k = 0; k < D; ++k)
          owned.begin[k] += period[k] * domain.size[k], owned.end[k] += period[k] * domain.size[k];
        if (owned.meets(nodes)) function(owned.common(nodes), out, other);
      }
      for (carried = 0; carried < D && ++period[carried] > last[carried]; ++carried) period[carried] = first[carried];
    } while (carried < D);
  }
}

/// Populations that cross the border to nodes of the halo that lie on one side of a block: as core/fluid/fluid.cpp has
/// them.
template <int D>
double crossing(const core::Box<D>& block, const core::Box<D>& nodes, const std::array<int, D>& out) {
  double count = 0;
  for (int q = 1; q < SetOf<D>::velocity_count; ++q) {
    bool leaves = true;
    core::Box<D> to = block;
    for (int k = 0; k < D; ++k) {
      const int c = SetOf<D>::velocity[q][k];
      leaves = leaves && (out[k] == 0 || c == out[k]);
      to.begin[k] += c, to.end[k] += c;
    }
    if (leaves) count += volume(to.common(nodes));
  }
  return count;
}

template <int D>
void add_halos(const Plan& plan, const core::Decomposition<D>& blocks, std::vector<RankCost>& ranks) {
  const double number = plan.scene->numerics.precision == scene::Precision::f64 ? 8 : 4;
  const int above = core::stencil_above(kernel_named(plan.scene->numerics.kernel).kind);
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const core::Box<D> block = blocks.domain(rank).block;
    const std::vector<int> near = ranks_near(blocks, rank);
    const auto send = [&](double RankCost::*bytes, int from, int to, double count) {
      ranks[from].*bytes += count;
      ranks[to].received_bytes += count;
    };
    std::set<int> neighbours;
    const auto count_populations = [&](const core::Box<D>& nodes, const std::array<int, D>& out, int other) {
      const double bytes = crossing<D>(block, nodes, out) * number;
      if (other != rank) neighbours.insert(other);
      send(&RankCost::population_bytes, rank, other, bytes / 2);  // home after odd steps,
      send(&RankCost::population_bytes, other, rank, bytes / 2);  // out after even ones
    };
    for_halo_boxes(blocks, rank, near, 1, 1, count_populations);
    ranks[rank].neighbours = static_cast<long>(neighbours.size());
    ranks[rank].messages = ranks[rank].neighbours;
    ranks[rank].waits = 1;
    if (!plan.has_cells) continue;
    ranks[rank].messages *= 2;
    const auto count_velocities = [&](const core::Box<D>& nodes, const std::array<int, D>&, int other) {
      send(&RankCost::velocity_bytes, other, rank, volume(nodes) * D * number);
    };
    for_halo_boxes(blocks, rank, near, above - 1, above, count_velocities);
  }
}

/// A cell and a rank, or two ranks.
using Pairs = std::vector<std::pair<int, int>>;
void make_unique(Pairs& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

template <int D>
void add_cells(const Plan& plan, const core::Decomposition<D>& blocks, std::vector<RankCost>& ranks) {
  using Ghosts = core::GhostCells<D>;
  const core::Domain<D> domain = blocks.domain(0);
  const core::GhostReach reach = core::ghost_reach(make_solver_setup<D>(plan, 0, {}));  // walls have no part in it
  constexpr double word = sizeof(double), of_node = D * word;
  std::vector<core::BoundingBox<D>> boxes;
  std::vector<int> owner, nodes;
  Pairs known;        // cells, and ranks that are told where they are
  Pairs spread, act;  // ranks that speak of forces and velocities, and of reactions
  for_each_cell<D>(*plan.scene, scene::lattice_spacing(*plan.scene), [&](std::size_t c, const core::Cells<D>& cell) {
    const core::BoundingBox<D> box = core::box_of<D>(cell, 0);
    const int rank = Ghosts::owner_by_place(box, blocks);
    RankCost& own = ranks[rank];
    ++own.cells;
    own.membrane_nodes += cell.node_count();
    bool crosses = false;
    for (const int other : Ghosts::reached_by(box, blocks, reach.lattice)) {
      if (other == rank) continue;
      crosses = true;
      known.emplace_back(static_cast<int>(c), other);
      spread.emplace_back(rank, other), spread.emplace_back(other, rank);
      own.force_bytes += cell.node_count() * of_node;
      ranks[other].received_bytes += cell.node_count() * of_node;
    }
    const core::Box<D> block = blocks.domain(rank).block;
    const auto& places = cell.position;
    for (int i = 0; i < cell.node_count() && crosses; ++i) {
      // Whose block has the stencil's first node, sends the node's velocity.
      std::array<int, D> node;
      for (int k = 0; k < D; ++k) node[k] = domain.wrapped(k, core::floor_int(places[k][i]));
      if (*std::min_element(node.begin(), node.end()) < 0 || block.contains(node)) continue;
      ranks[blocks.owner(node)].node_velocity_bytes += of_node;
      own.received_bytes += of_node;
    }
    boxes.push_back(box);
    owner.push_back(rank);
    nodes.push_back(cell.node_count());
  });
  Ghosts::for_touching(
      boxes, domain, reach.contact, [](int) { return true; },
      [&](int c, int other) {
        if (owner[c] == owner[other]) return;
        known.emplace_back(c, owner[other]);
        act.emplace_back(owner[c], owner[other]);
      });
  for (Pairs* pairs : {&known, &spread, &act}) make_unique(*pairs);
  for (const auto& [c, rank] : known) {
    const double bytes = nodes[c] * of_node + word;
    RankCost& own = ranks[owner[c]];
    own.position_bytes += bytes;
    own.sharing_s += nodes[c] * cost_of_sharing[D - 2].shown_s;
    ranks[rank].received_bytes += bytes;
    ranks[rank].ghost_nodes += nodes[c];
  }
  // A message to each in each round, and the ranks wait once for each round: for positions, forces and velocities,
  // reactions.
  Pairs tell = spread;
  tell.insert(tell.end(), act.begin(), act.end());
  make_unique(tell);
  for (const auto& [of, rounds] : {std::pair{&tell, 1}, std::pair{&spread, 2}, std::pair{&act, 1}}) {
    int last = -1;
    for (const auto& [rank, other] : *of) {
      ranks[rank].messages += rounds;
      if (rank != last) ranks[rank].waits += rounds;
      last = rank;
    }
  }
  long agreements = 0;  // rounds in which all ranks agree
  for (int far = 1; far < blocks.ranks(); far *= 2) ++agreements;
  for (RankCost& rank : ranks) {
    rank.messages += agreements;
    rank.waits += agreements;
    const double agreed = static_cast<double>(agreements) * 4 * word;
    rank.position_bytes += agreed;
    rank.received_bytes += agreed;
    rank.ghosts_s = static_cast<double>(rank.ghost_nodes) * cost_of_sharing[D - 2].ghost_s;
    rank.sharing_s += rank.ghosts_s;
  }
}

template <int D>
std::vector<RankCost> costs_of(const Plan& plan, const core::Decomposition<D>& blocks) {
  const scene::Scene& scene = *plan.scene;
  std::vector<RankCost> ranks(static_cast<std::size_t>(blocks.ranks()));
  add_halos(plan, blocks, ranks);
  if (plan.has_cells) add_cells(plan, blocks, ranks);
  const double lattice = estimate(plan).memory_bytes - membrane_memory(scene);
  const double word = scene.numerics.precision == scene::Precision::f64 ? 8 : 4;
  const MembraneScheme scheme = membrane_scheme(plan);
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const core::Box<D> block = blocks.domain(rank).block;
    RankCost& cost = ranks[rank];
    cost.nodes = static_cast<long>(core::row_count(block)) * block.size(0);
    const double nodes = static_cast<double>(cost.nodes), all = static_cast<double>(blocks.domain(rank).nodes());
    const auto own = static_cast<double>(cost.membrane_nodes), ghosts = static_cast<double>(cost.ghost_nodes),
               cells = static_cast<double>(shape::cells_at_once(scene).size());
    cost.memory_bytes = memory::of_process + lattice * nodes / all;
    if (plan.has_cells) {
      const double known = (own + ghosts) * cells / membrane_nodes(scene);
      cost.memory_bytes += memory::of_known(D, own, ghosts, known) + cells * memory::of_each_cell;
    }
    if (rank == 0) cost.memory_bytes += memory::of_writer(cells);
    cost.rows_s = (core::row_count(block) - nodes / blocks.domain(rank).size[0]) * cost_of_sharing[D - 2].row_s;
    cost.sharing_s += cost.lattice_bytes() / word * cost_of_sharing[D - 2].number_s + cost.rows_s;
    cost.step_s = step_cost(nodes, own, scene.numerics.precision, D, scheme);
    cost.membranes_s = cost.step_s - step_cost(nodes, 0, scene.numerics.precision, D, scheme);
  }
  return ranks;
}

/// A number of a rank, as people read it.
struct Row {
  const char* name;
  std::function<double(const RankCost&)> value;
  int decimals;
};

const std::vector<Row>& rows() {
  const auto whole = [](long RankCost::*count) {
    return [count](const RankCost& rank) { return static_cast<double>(rank.*count); };
  };
  const auto scaled = [](double RankCost::*amount, double by) {
    return [amount, by](const RankCost& rank) { return rank.*amount * by; };
  };
  static const std::vector<Row> table{
      {"nodes of the block", whole(&RankCost::nodes), 0},
      {"cells", whole(&RankCost::cells), 0},
      {"membrane nodes", whole(&RankCost::membrane_nodes), 0},
      {"membrane nodes of ghosts", whole(&RankCost::ghost_nodes), 0},
      {"neighbours", whole(&RankCost::neighbours), 0},
      {"messages of a step", whole(&RankCost::messages), 0},
      {"populations, kB a step", scaled(&RankCost::population_bytes, 1e-3), 2},
      {"velocities, kB", scaled(&RankCost::velocity_bytes, 1e-3), 2},
      {"positions of cells, kB", scaled(&RankCost::position_bytes, 1e-3), 2},
      {"forces of cells, kB", scaled(&RankCost::force_bytes, 1e-3), 2},
      {"velocities of cells, kB", scaled(&RankCost::node_velocity_bytes, 1e-3), 2},
      {"received, kB", scaled(&RankCost::received_bytes, 1e-3), 2},
      {"memory, MB", scaled(&RankCost::memory_bytes, 1e-6), 2},
      {"a step's computing, us", scaled(&RankCost::step_s, 1e6), 2},
      {"sharing it with others, us", scaled(&RankCost::sharing_s, 1e6), 2},
  };
  return table;
}

std::string in_line(const Row& row, const std::vector<double>& values) {
  std::ostringstream line;
  line << "  " << std::left << std::setw(34) << row.name << std::right << std::fixed << std::setprecision(row.decimals);
  for (const double value : values) line << ' ' << std::setw(12) << value;
  line << '\n';
  return line.str();
}

}  // namespace

std::vector<RankCost> rank_costs(const Plan& plan, const Blocks& blocks) {
  return std::visit([&](const auto& of_lattice) { return costs_of(plan, of_lattice); }, blocks);
}

double balance(const std::vector<RankCost>& ranks) {
  double sum = 0, most = 0;
  for (const RankCost& rank : ranks) {
    sum += rank.step_s;
    most = std::max(most, rank.step_s);
  }
  return sum / static_cast<double>(ranks.size()) / most;
}

std::string to_text(const std::vector<RankCost>& ranks) {
  std::string out = "\n" + std::to_string(ranks.size()) +
                    " ranks                                   least         mean         most\n";
  for (const Row& row : rows()) {
    double least = row.value(ranks.front()), most = least, sum = 0;
    for (const RankCost& rank : ranks) {
      least = std::min(least, row.value(rank));
      most = std::max(most, row.value(rank));
      sum += row.value(rank);
    }
    out += in_line(row, {least, sum / static_cast<double>(ranks.size()), most});
  }
  return out + "  balance " + decimals(balance(ranks), 2) + ": the ranks' mean computing time over the largest\n";
}

std::string to_text(const RankCost& cost, int rank, const Blocks& blocks) {
  std::string out = "\nRank " + std::to_string(rank) + ":";
  std::visit(
      [&](const auto& of_lattice) {
        const auto block = of_lattice.domain(rank).block;
        for (std::size_t k = 0; k < block.begin.size(); ++k)
          out += (k == 0 ? " nodes " : ", ") + std::to_string(block.begin[k]) + " to " +
                 std::to_string(block.end[k] - 1) + " along " + "xyz"[k];
      },
      blocks);
  out += "\n";
  for (const Row& row : rows()) out += in_line(row, {row.value(cost)});
  return out;
}

}  // namespace rouleau::plan
