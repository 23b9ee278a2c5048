// Which cells the ranks of a simulation have to tell each other of.
#pragma once

#include <map>
#include <vector>

#include "core/contact/cell_grid.hpp"
#include "core/contact/cutoffs.hpp"
#include "core/domain/bounding_box.hpp"
#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "solver_setup.hpp"

namespace rouleau::core {

/// Spacings.
struct GhostReach {
  double lattice;      ///< of its nodes to a block: stencil, marks and viscosity
  double contact = 0;  ///< of its nodes to those of another cell; 0: cells do not act on each other
};

constexpr double lattice_reach = 8;  ///< a stencil reaches two nodes, marks and viscosity a few more, and what is
                                     ///< remembered of them is somewhat older

/// How much farther from a node its force may act than that of a kernel of four points at the node itself, spacings.
template <int D>
double extra_reach(const BasicSolverSetup<D>& setup);

template <int D>
GhostReach ghost_reach(const BasicSolverSetup<D>& setup) {
  return {.lattice = lattice_reach + extra_reach(setup), .contact = contact_reach(setup.interactions)};
}

/// Every cell has one owner, the rank that computes its forces and moves it; it enters no formula, so that any rank
/// will do. The one whose block the cell is above hears of it least, so that cells which travel change hands. Other
/// ranks know a cell, as a ghost, whose blocks it may reach or with whose cells it may act, while no node has
/// moved further than the skin since the boxes of all cells were last compared. All ranks find the same from the same
/// boxes, so that nobody has to say which cells a message is about. Cells that have not come yet, or have gone, have no
/// owner, and no rank knows them.
template <int D>
class GhostCells {
 public:
  static constexpr double skin = 1;  ///< spacings
  static constexpr int nobody = -1;  ///< the owner of a cell that is not there

  /// By the boxes of all cells. `owner[c]`: rank of cell c, or nobody; beyond its end by place.
  GhostCells(const Ranks<D>& ranks, const std::vector<BoundingBox<D>>& boxes, GhostReach reach,
             std::vector<int> owner = {});

  /// The rank whose block holds the middle of a cell's box; 0 of one that is none.
  static int owner_by_place(const BoundingBox<D>& box, const Decomposition<D>& blocks);

  /// The ranks, in their order, that know a cell with this box for the sake of their blocks.
  static std::vector<int> reached_by(const BoundingBox<D>& box, const Decomposition<D>& blocks, double reach);
  /// Calls function(c, other) for pairs of cells whose owners know the other one for the sake of their own, of the
  /// cells c that `wanted` holds for.
  template <class Wanted, class Function>
  static void for_touching(const std::vector<BoundingBox<D>>& boxes, const Domain<D>& domain, double contact,
                           Wanted wanted, Function function) {
    if (!(contact > 0)) return;
    const double reach = contact + 2 * skin;
    const CellGrid<D> grid(boxes, reach, domain);
    std::vector<int> around;
    for (int c = 0; c < static_cast<int>(boxes.size()); ++c) {
      if (!wanted(c)) continue;
      grid.find(c, around);
      for (const int other : around) {
        // Both owners have to come to the same answer.
        if (distance_along_axes(boxes[std::min(c, other)], boxes[std::max(c, other)], domain) <= reach)
          function(c, other);
      }
    }
  }

  /// A cell that changes hands.
  struct Handover {
    int cell, from, to;
  };
  /// Gives cells whose middle has come `margin` away from their owner's block to the ranks above whose blocks it lies,
  /// and says which; all ranks find the same. Until renew() peers are the old ones.
  std::vector<Handover> change_owners(const std::vector<BoundingBox<D>>& boxes);
  static constexpr double margin = 4;  ///< spacings: a cell that sways over a border stays where it is

  /// Finds the ghosts anew, from the boxes of all cells.
  void renew(const std::vector<BoundingBox<D>>& boxes);

  /// Says of all cells what this rank's part in them is.
  void set_parts(CellNodes& cells) const;
  [[nodiscard]] const Ranks<D>& ranks() const { return ranks_; }
  [[nodiscard]] int cell_count() const { return static_cast<int>(owner_.size()); }
  [[nodiscard]] int owner(int cell) const { return owner_[cell]; }
  [[nodiscard]] bool owns(int cell) const { return owner_[cell] == ranks_.transport->rank(); }
  [[nodiscard]] bool knows(int cell) const { return known_[cell] != 0; }
  /// Whether a cell's nodes may touch this rank's block.
  [[nodiscard]] bool reaches(int cell) const { return reaching_[cell] != 0; }
  /// Whether it is this rank's, and its nodes touch neither another block nor a wall.
  [[nodiscard]] bool inside(int cell) const { return inside_[cell] != 0; }

  /// What this rank and another one share. Cells are in their order.
  struct Peer {
    std::vector<int> mine, theirs;             ///< of each, that the other one knows
    std::vector<int> mine_there, theirs_here;  ///< those of them that may touch the other's block
    bool touch = false;                        ///< some of mine may act on some of theirs
  };
  /// By rank; those without anything are left out.
  [[nodiscard]] const std::map<int, Peer>& peers() const { return peers_; }

 private:
  Ranks<D> ranks_;
  std::vector<int> owner_;
  GhostReach reach_;
  std::vector<char> known_, reaching_, inside_;  // of each cell
  std::map<int, Peer> peers_;
};

extern template class GhostCells<2>;
extern template class GhostCells<3>;

}  // namespace rouleau::core
