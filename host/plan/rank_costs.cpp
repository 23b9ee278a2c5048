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

/// Of a rank, and of those whose blocks lie within two nodes of its own, across periodic borders too.
std::vector<int> ranks_near(const Blocks& blocks, int rank) {
  const core::Domain<2> domain = blocks.domain(rank);
  constexpr int reach = 2;
  std::vector<int> near;
  for (int other = 0; other < blocks.ranks(); ++other) {
    const core::Box<2> box = blocks.domain(other).block;
    bool meets = true;
    for (int k = 0; k < 2; ++k) {
      bool along = false;
      for (const int shift : {-domain.size[k], 0, domain.size[k]}) {
        if (shift != 0 && !domain.periodic[k]) continue;
        along = along || (box.begin[k] + shift < domain.block.end[k] + reach &&
                          domain.block.begin[k] - reach < box.end[k] + shift);
      }
      meets = meets && along;
    }
    if (meets) near.push_back(other);
  }
  return near;
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
    std::set<int> neighbours;
    core::for_halo_nodes(domain, 1, 1, [&](const std::array<int, 2>& node, const std::array<int, 2>& out) {
      const double bytes = crossing(domain, node, out) * number;
      const int other = owner(node);
      if (other != rank) neighbours.insert(other);
      ranks[rank].halo_bytes += bytes / 2;   // home after odd steps,
      ranks[other].halo_bytes += bytes / 2;  // out after even ones
    });
    ranks[rank].neighbours = static_cast<long>(neighbours.size());
    if (!plan.has_cells) continue;
    core::for_halo_nodes(domain, 1, 2, [&](const std::array<int, 2>& node, const std::array<int, 2>&) {
      ranks[owner(node)].halo_bytes += 2 * number;
    });
  }
}

void add_cells(const Plan& plan, const Blocks& blocks, std::vector<RankCost>& ranks) {
  const core::Membranes membranes = make_membranes(*plan.scene, lattice_spacing(*plan.scene));
  const std::vector<int> owner = core::CellExchange::owners_by_place(membranes, blocks);
  const core::Domain<2> domain = blocks.domain(0);
  const int others = blocks.ranks() - 1;
  constexpr double word = sizeof(double), positions = 4 * word, forces = 2 * word, velocities = 2 * word;
  for (std::size_t c = 0; c < membranes.cells.size(); ++c) {
    const core::CellRange& cell = membranes.cells[c];
    RankCost& own = ranks[owner[c]];
    ++own.cells;
    own.membrane_nodes += cell.count;
    own.cell_bytes += others * (cell.count * (positions + forces) + word);
    const core::Box<2> block = blocks.domain(owner[c]).block;
    for (int i = cell.first; i < cell.end(); ++i) {
      // Whose block has the stencil's first node, sends the node's velocity.
      const std::array<int, 2> node{domain.wrapped(0, core::floor_int(membranes.x[i])),
                                    domain.wrapped(1, core::floor_int(membranes.y[i]))};
      if (node[1] >= 0 && !block.contains(node)) ranks[blocks.owner(node)].cell_bytes += velocities;
    }
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
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "\n%zu ranks                                   least         mean         most\n", ranks.size());
  std::string out = text.data();
  out += in_line("nodes of the block", ranks, number(&RankCost::nodes), whole);
  out += in_line("cells", ranks, number(&RankCost::cells), whole);
  out += in_line("membrane nodes", ranks, number(&RankCost::membrane_nodes), whole);
  out += in_line("neighbours", ranks, number(&RankCost::neighbours), whole);
  out += in_line(
      "sent in a step for the lattice, kB", ranks, [](const RankCost& r) { return r.halo_bytes / 1e3; }, decimal);
  out += in_line(
      "sent in a step for cells, kB", ranks, [](const RankCost& r) { return r.cell_bytes / 1e3; }, decimal);
  out += in_line(
      "memory, MB", ranks, [](const RankCost& r) { return r.memory_bytes / 1e6; }, decimal);
  out += in_line(
      "a step's computing, us", ranks, [](const RankCost& r) { return r.step_s * 1e6; }, decimal);
  std::snprintf(text.data(), text.size(),
                "  balance %.2f: the ranks' mean computing time over the largest; messages cost extra\n",
                balance(ranks));
  return out + text.data();
}

}  // namespace rouleau::plan
