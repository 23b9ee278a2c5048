#include "rank_costs.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <rouleau/d2q9.hpp>
#include <set>

#include "core/domain/halo.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/rounding.hpp"
#include "core/solver/cell_exchange.hpp"
#include "estimate.hpp"
#include "solver_setup.hpp"

namespace rouleau::plan {

namespace {

using Blocks = core::Decomposition<2>;

/// What the cut costs, s: measured (docs/scaling.md).
namespace cost_of_sharing {
constexpr double number = 5e-9;     ///< that goes to a neighbour: packing it, and unpacking one
constexpr double beside = 65e-9;    ///< a membrane node of another rank's cell that shares rows: spreading tries it
constexpr double anywhere = 23e-9;  ///< any membrane node: finding, packing and unpacking it
}  // namespace cost_of_sharing

/// The ranks whose blocks lie within two nodes of a rank's own, itself included, across periodic borders too.
std::vector<int> ranks_near(const Blocks& blocks, int rank) {
  const core::Domain<2> domain = blocks.domain(rank);
  constexpr int reach = 2;
  std::set<int> near;
  const auto shifts = [&](int k) { return domain.periodic[k] ? std::vector<int>{-1, 0, 1} : std::vector<int>{0}; };
  for (const int y : shifts(1)) {
    for (const int x : shifts(0)) {
      core::Box<2> box = domain.block;
      for (int k = 0; k < 2; ++k) {
        const int shift = (k == 0 ? x : y) * domain.size[k];
        box.begin[k] += shift - reach, box.end[k] += shift + reach;
      }
      const std::vector<int> met = blocks.meeting(box);
      near.insert(met.begin(), met.end());
    }
  }
  return {near.begin(), near.end()};
}

/// Populations of a halo node that cross the border: as core/fluid/fluid.cpp has them.
int crossing(const core::Domain<2>& domain, const std::array<int, 2>& node, const std::array<int, 2>& out) {
  int count = 0;
  for (int q = 1; q < 9; ++q) {
    const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
    const bool leaves = (out[0] == 0 || cx == out[0]) && (out[1] == 0 || cy == out[1]);
    if (leaves && domain.block.contains({node[0] - cx, node[1] - cy})) ++count;
  }
  return count;
}

void add_halos(const Plan& plan, const Blocks& blocks, std::vector<RankCost>& ranks) {
  const double number = plan.scene->numerics.precision == scene::Precision::f64 ? 8 : 4;
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const core::Domain<2> domain = blocks.domain(rank);
    const std::vector<int> near = ranks_near(blocks, rank);
    const auto owner = [&](std::array<int, 2> node) {
      for (int k = 0; k < 2; ++k) node[k] = domain.wrapped(k, node[k]);
      return *std::find_if(near.begin(), near.end(), [&](int r) { return blocks.domain(r).block.contains(node); });
    };
    const auto send = [&](double RankCost::*bytes, int from, int to, double count) {
      ranks[from].*bytes += count;
      ranks[to].received_bytes += count;
    };
    std::set<int> neighbours;
    core::for_halo_nodes(domain, 1, 1, [&](const std::array<int, 2>& node, const std::array<int, 2>& out) {
      const double bytes = crossing(domain, node, out) * number;
      const int other = owner(node);
      if (other != rank) neighbours.insert(other);
      send(&RankCost::population_bytes, rank, other, bytes / 2);  // home after odd steps,
      send(&RankCost::population_bytes, other, rank, bytes / 2);  // out after even ones
    });
    ranks[rank].neighbours = static_cast<long>(neighbours.size());
    ranks[rank].messages = ranks[rank].neighbours;
    ranks[rank].waits = 1;
    if (!plan.has_cells) continue;
    ranks[rank].messages *= 2;
    core::for_halo_nodes(domain, 1, 2, [&](const std::array<int, 2>& node, const std::array<int, 2>&) {
      send(&RankCost::velocity_bytes, owner(node), rank, 2 * number);
    });
  }
}

/// How many membrane nodes have cells that meet each row: what spreading goes through in the blocks of these rows.
class RowsOfCells {
 public:
  explicit RowsOfCells(const core::Domain<2>& domain)
      : domain_(domain), first_(static_cast<std::size_t>(domain.size[1])), change_(first_) {}
  void add(int first, int last, int nodes) {
    const int height = domain_.size[1];
    if (last - first >= height - 1) return everywhere_ += nodes, void();
    first = domain_.periodic[1] ? domain_.wrapped(1, first) : std::clamp(first, 0, height - 1);
    last = domain_.periodic[1] ? domain_.wrapped(1, last) : std::clamp(last, 0, height - 1);
    first_[first] += nodes;
    change_[first] += nodes;
    if (last + 1 < height) change_[last + 1] -= nodes;
    if (last < first) change_[0] += nodes;
  }
  void finish() {
    for (std::size_t y = 1; y < change_.size(); ++y) change_[y] += change_[y - 1], first_[y] += first_[y - 1];
  }
  [[nodiscard]] double nodes(int begin, int end) const {
    return static_cast<double>(everywhere_ + change_[begin] + first_[end - 1] - first_[begin]);
  }

 private:
  core::Domain<2> domain_;
  std::vector<long> first_;  ///< nodes of the cells that begin in a row; by finish() up to it
  std::vector<long>
      change_;  ///< nodes of the cells that meet it, less those of the row below; by finish() those that do
  long everywhere_ = 0;
};

void add_cells(const Plan& plan, const Blocks& blocks, std::vector<RankCost>& ranks) {
  const core::Domain<2> domain = blocks.domain(0);
  const double others = blocks.ranks() - 1;
  constexpr double word = sizeof(double), positions = 4 * word, forces = 2 * word, velocities = 2 * word;
  RowsOfCells rows(domain);
  double of_positions = 0, of_forces = 0, nodes_of_all = 0;
  for_each_outline(*plan.scene, lattice_spacing(*plan.scene), [&](std::size_t, const core::Membranes& outline) {
    const core::CellRange& cell = outline.cells.front();
    const int rank = core::CellExchange::owners_by_place(outline, blocks).front();
    RankCost& own = ranks[rank];
    ++own.cells;
    own.membrane_nodes += cell.count;
    own.position_bytes += others * (cell.count * positions + word);
    own.force_bytes += others * cell.count * forces;
    of_positions += cell.count * positions + word, of_forces += cell.count * forces, nodes_of_all += cell.count;
    const core::Bounds bounds = core::bounds(outline, cell);
    const core::Box<2> block = blocks.domain(rank).block;
    const std::array<int, 2> first{core::floor_int(bounds.x_min), core::floor_int(bounds.y_min)},
        last{core::floor_int(bounds.x_max), core::floor_int(bounds.y_max)};
    rows.add(first[1] - 1, last[1] + 2, cell.count);
    if (block.contains(first) && block.contains(last)) return;
    for (int i = 0; i < cell.count; ++i) {
      // Whose block has the stencil's first node, sends the node's velocity.
      const std::array<int, 2> node{domain.wrapped(0, core::floor_int(outline.x[i])),
                                    domain.wrapped(1, core::floor_int(outline.y[i]))};
      if (node[1] < 0 || block.contains(node)) continue;
      ranks[blocks.owner(node)].node_velocity_bytes += velocities;
      own.received_bytes += velocities;
    }
  });
  rows.finish();
  const long rounds = plan.has_interactions ? 4 : 3;  // positions, forces, velocities, and reactions
  for (int r = 0; r < blocks.ranks(); ++r) {
    RankCost& rank = ranks[r];
    rank.messages += rounds * (blocks.ranks() - 1);
    rank.waits += others > 0 ? rounds : 0;
    if (others > 0) rank.received_bytes += of_positions + of_forces - (rank.position_bytes + rank.force_bytes) / others;
    const core::Box<2> block = blocks.domain(r).block;
    const double beside =
        std::max(0.0, rows.nodes(block.begin[1], block.end[1]) - static_cast<double>(rank.membrane_nodes));
    rank.sharing_s += others > 0 ? beside * cost_of_sharing::beside + nodes_of_all * cost_of_sharing::anywhere : 0;
  }
}

std::string in_line(const char* name, const std::vector<RankCost>& ranks,
                    const std::function<double(const RankCost&)>& value, const char* format) {
  double least = value(ranks.front()), most = least, sum = 0;
  for (const RankCost& rank : ranks) {
    least = std::min(least, value(rank));
    most = std::max(most, value(rank));
    sum += value(rank);
  }
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), format, name, least, sum / static_cast<double>(ranks.size()), most);
  return text.data();
}

}  // namespace

std::vector<RankCost> rank_costs(const Plan& plan, const Blocks& blocks) {
  const scene::Scene& scene = *plan.scene;
  std::vector<RankCost> ranks(static_cast<std::size_t>(blocks.ranks()));
  add_halos(plan, blocks, ranks);
  if (plan.has_cells) add_cells(plan, blocks, ranks);
  const double membranes = membrane_memory(scene), lattice = estimate(plan).memory_bytes - membranes;
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const core::Box<2> block = blocks.domain(rank).block;
    RankCost& cost = ranks[rank];
    cost.nodes = static_cast<long>(block.size(0)) * block.size(1);
    const double nodes = static_cast<double>(cost.nodes), all = static_cast<double>(blocks.domain(rank).nodes());
    cost.memory_bytes = lattice * nodes / all + membranes;  // every rank holds all cells
    const double word = scene.numerics.precision == scene::Precision::f64 ? 8 : 4;
    cost.sharing_s += cost.lattice_bytes() / word * cost_of_sharing::number;
    cost.step_s = step_cost(nodes, static_cast<double>(cost.membrane_nodes), scene.numerics.precision);
  }
  return ranks;
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
  constexpr const char *whole = "  %-34s %12.0f %12.0f %12.0f\n", *decimal = "  %-34s %12.2f %12.2f %12.2f\n";
  const auto number = [](auto RankCost::*member) {
    return [member](const RankCost& rank) { return static_cast<double>(rank.*member); };
  };
  const auto scaled = [](double RankCost::*member, double by) {
    return [member, by](const RankCost& rank) { return rank.*member * by; };
  };
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "\n%zu ranks                                   least         mean         most\n", ranks.size());
  std::string out = text.data();
  out += in_line("nodes of the block", ranks, number(&RankCost::nodes), whole);
  out += in_line("cells", ranks, number(&RankCost::cells), whole);
  out += in_line("membrane nodes", ranks, number(&RankCost::membrane_nodes), whole);
  out += in_line("neighbours", ranks, number(&RankCost::neighbours), whole);
  out += in_line("messages of a step", ranks, number(&RankCost::messages), whole);
  out += in_line("populations, kB a step", ranks, scaled(&RankCost::population_bytes, 1e-3), decimal);
  out += in_line("velocities, kB", ranks, scaled(&RankCost::velocity_bytes, 1e-3), decimal);
  out += in_line("positions of cells, kB", ranks, scaled(&RankCost::position_bytes, 1e-3), decimal);
  out += in_line("forces of cells, kB", ranks, scaled(&RankCost::force_bytes, 1e-3), decimal);
  out += in_line("velocities of cells, kB", ranks, scaled(&RankCost::node_velocity_bytes, 1e-3), decimal);
  out += in_line("received, kB", ranks, scaled(&RankCost::received_bytes, 1e-3), decimal);
  out += in_line("memory, MB", ranks, scaled(&RankCost::memory_bytes, 1e-6), decimal);
  out += in_line("a step's computing, us", ranks, scaled(&RankCost::step_s, 1e6), decimal);
  out += in_line("sharing it with others, us", ranks, scaled(&RankCost::sharing_s, 1e6), decimal);
  std::snprintf(text.data(), text.size(), "  balance %.2f: the ranks' mean computing time over the largest\n",
                balance(ranks));
  return out + text.data();
}

std::string to_text(const RankCost& cost, int rank, const core::Box<2>& block) {
  std::array<char, 1024> text{};
  std::snprintf(text.data(), text.size(),
                "\nRank %d: nodes %d to %d along x, %d to %d along y\n"
                "  %-34s %12ld\n  %-34s %12ld\n  %-34s %12ld\n  %-34s %12ld\n  %-34s %12ld\n"
                "  %-34s %12.2f\n  %-34s %12.2f\n  %-34s %12.2f\n  %-34s %12.2f\n  %-34s %12.2f\n"
                "  %-34s %12.2f\n  %-34s %12.2f\n  %-34s %12.2f\n  %-34s %12.2f\n",
                rank, block.begin[0], block.end[0] - 1, block.begin[1], block.end[1] - 1,  //
                "nodes of the block", cost.nodes, "cells", cost.cells, "membrane nodes", cost.membrane_nodes,
                "neighbours", cost.neighbours, "messages of a step", cost.messages,  //
                "populations, kB a step", cost.population_bytes / 1e3, "velocities, kB", cost.velocity_bytes / 1e3,
                "positions of cells, kB", cost.position_bytes / 1e3, "forces of cells, kB", cost.force_bytes / 1e3,
                "velocities of cells, kB", cost.node_velocity_bytes / 1e3,  //
                "received, kB", cost.received_bytes / 1e3, "memory, MB", cost.memory_bytes / 1e6,
                "a step's computing, us", cost.step_s * 1e6, "sharing it with others, us", cost.sharing_s * 1e6);
  return text.data();
}

}  // namespace rouleau::plan
