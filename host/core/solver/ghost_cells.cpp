#include "ghost_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/coupling/slip_constants.hpp"
#include "core/fluid/node_mask.hpp"
#include "core/membrane/rounding.hpp"

namespace rouleau::core {

namespace {

/// Whether all that a box comes within `reach` of are nodes of the domain's block.
template <int D>
bool lies_inside(const BoundingBox<D>& box, double reach, const Domain<D>& domain) {
  if (!box.usable()) return false;
  for (int k = 0; k < D; ++k)
    if (!domain.periodic[k] && !(box.least[k] - reach >= 0 && box.most[k] + reach <= domain.size[k] - 1)) return false;
  bool inside = true;
  for_nodes_near(box, reach, 1, domain, [&](const Box<D>& nodes) { inside = inside && domain.block.holds(nodes); });
  return inside;
}

}  // namespace

template <int D>
double extra_reach(const BasicSolverSetup<D>& setup) {
  double largest = 0;
  for (const CellType& type : setup.cell_types)
    if (setup.slip_correction)
      largest = std::max(largest, std::abs(slip_constants(setup.kernel, type.viscosity_ratio, D).shift));
  return largest + stencil_above(setup.kernel) - 2;
}

template double extra_reach(const BasicSolverSetup<2>&);
template double extra_reach(const BasicSolverSetup<3>&);

template <int D>
GhostCells<D>::GhostCells(const Ranks<D>& ranks, const std::vector<BoundingBox<D>>& boxes, GhostReach reach,
                          std::vector<int> owner)
    : ranks_(ranks),
      owner_(std::move(owner)),
      reach_(reach),
      known_(boxes.size()),
      reaching_(boxes.size()),
      inside_(boxes.size()) {
  owner_.reserve(boxes.size());
  while (owner_.size() < boxes.size()) owner_.push_back(owner_by_place(boxes[owner_.size()], *ranks.blocks));
  renew(boxes);
}

template <int D>
void GhostCells<D>::set_parts(CellNodes& cells) const {
  cells.part.resize(cells.cells.size());
  cells.known.clear();
  for (int c = 0; c < cells.cell_count(); ++c) {
    cells.part[c] = {.owned = owns(c), .known = knows(c), .reaching = reaches(c), .inside = inside(c)};
    if (knows(c)) cells.known.push_back(c);
  }
}

template <int D>
int GhostCells<D>::owner_by_place(const BoundingBox<D>& box, const Decomposition<D>& blocks) {
  if (!box.usable()) return 0;
  const Domain<D> domain = blocks.domain(0);
  std::array<int, D> node;
  for (int k = 0; k < D; ++k) {
    const int middle = floor_int((box.least[k] + box.most[k]) / 2 + 0.5), wrapped = domain.wrapped(k, middle);
    node[k] = wrapped >= 0 ? wrapped : (middle < 0 ? 0 : domain.size[k] - 1);
  }
  return blocks.owner(node);
}

template <int D>
std::vector<int> GhostCells<D>::reached_by(const BoundingBox<D>& box, const Decomposition<D>& blocks, double reach) {
  std::vector<int> ranks;
  if (box.usable()) {
    for_nodes_near(box, reach + skin, NodeMask::nodes_per_bit, blocks.domain(0), [&](const Box<D>& nodes) {
      const std::vector<int> of_part = blocks.meeting(nodes);
      ranks.insert(ranks.end(), of_part.begin(), of_part.end());
    });
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  } else {  // what blows up may be anywhere
    ranks.resize(static_cast<std::size_t>(blocks.ranks()));
    std::iota(ranks.begin(), ranks.end(), 0);
  }
  return ranks;
}

template <int D>
auto GhostCells<D>::change_owners(const std::vector<BoundingBox<D>>& boxes) -> std::vector<Handover> {
  std::vector<Handover> handovers;
  for (int c = 0; c < static_cast<int>(boxes.size()); ++c) {
    if (owner_[c] == nobody || !boxes[c].usable()) continue;
    const int place = owner_by_place(boxes[c], *ranks_.blocks);
    if (place == owner_[c]) continue;
    const Domain<D> of_owner = ranks_.blocks->domain(owner_[c]);
    BoundingBox<D> middle = boxes[c];
    for (int k = 0; k < D; ++k) middle.least[k] = middle.most[k] = (boxes[c].least[k] + boxes[c].most[k]) / 2;
    bool near = false;
    for_nodes_near(middle, margin, 1, of_owner,
                   [&](const Box<D>& nodes) { near = near || nodes.meets(of_owner.block); });
    if (near) continue;
    handovers.push_back({c, owner_[c], place});
    owner_[c] = place;
  }
  return handovers;
}

template <int D>
void GhostCells<D>::renew(const std::vector<BoundingBox<D>>& boxes) {
  const int own = ranks_.transport->rank(), cells = static_cast<int>(owner_.size());
  const Domain<D> domain = ranks_.blocks->domain(own);
  peers_.clear();
  for (int c = 0; c < cells; ++c) {
    if (owner_[c] == nobody) {
      reaching_[c] = inside_[c] = known_[c] = 0;
      continue;
    }
    bool here = !boxes[c].usable();
    if (owner_[c] == own) {
      for (const int rank : reached_by(boxes[c], *ranks_.blocks, reach_.lattice)) {
        here = here || rank == own;
        if (rank != own) peers_[rank].mine_there.push_back(c);
      }
    } else if (!here) {
      for_nodes_near(boxes[c], reach_.lattice + skin, NodeMask::nodes_per_bit, domain,
                     [&](const Box<D>& nodes) { here = here || nodes.meets(domain.block); });
    }
    reaching_[c] = here;
    inside_[c] = owner_[c] == own && lies_inside(boxes[c], reach_.lattice + skin, domain);
    known_[c] = owner_[c] == own || here;
  }
  std::map<int, std::vector<int>> near;  // of each rank: cells of this one that are near some of its own
  for_touching(
      boxes, domain, reach_.contact, [&](int c) { return owner_[c] == own; },
      [&](int c, int other) {
        if (owner_[other] == own || owner_[other] == nobody) return;
        known_[other] = 1;
        near[owner_[other]].push_back(c);
      });
  for (auto& [rank, of_mine] : near) {
    Peer& peer = peers_[rank];
    peer.touch = true;
    peer.mine = std::move(of_mine);
  }
  for (auto& [rank, peer] : peers_) {
    peer.mine.insert(peer.mine.end(), peer.mine_there.begin(), peer.mine_there.end());
    std::sort(peer.mine.begin(), peer.mine.end());
    peer.mine.erase(std::unique(peer.mine.begin(), peer.mine.end()), peer.mine.end());
  }
  for (int c = 0; c < cells; ++c) {
    if (owner_[c] == own || known_[c] == 0) continue;
    Peer& peer = peers_[owner_[c]];
    peer.theirs.push_back(c);
    if (reaching_[c] != 0) peer.theirs_here.push_back(c);
  }
}

template class GhostCells<2>;
template class GhostCells<3>;

}  // namespace rouleau::core
