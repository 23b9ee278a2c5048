// Which segments can be the closest ones to a group of nodes, for all pairs of cells and images within reach.
#pragma once

#include <vector>

#include "base/worker.hpp"
#include "cell_grid.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/membrane/membranes.hpp"
#include "cutoffs.hpp"
#include "segment_table.hpp"

namespace rouleau::core {

/// Ordered pair: nodes of a cell against the outline of `other` moved by `shift` periods.
struct CellPair {
  int other;
  ImageShift shift;
};

/// Lists of candidate segments that stay complete while no node has moved further than `skin`.
///
/// Why that is exact. Let d_k be the distance of a node to segment k when the list is made and d'_k later. A point of a
/// segment is a convex combination of its ends, so it has moved by at most the skin, like the node: |d'_k - d_k| <= 2
/// skin for every k. If k is the closest segment later and m was when the list was made, then
///     d_k <= d'_k + 2 skin <= d'_m + 2 skin <= d_m + 4 skin,  and  d_k <= cutoff + 2 skin if d'_k <= cutoff.
/// A segment with d_k above min(d_m + 4 skin, cutoff + 2 skin) can therefore be left out.
///
/// A thin skin makes short lists that are soon out of date: each is chosen for the speed at which the nodes move.
class NeighbourList {
 public:
  static constexpr int group = 8;  ///< consecutive nodes that share one list

  /// Segments [begin, end), counted from the first of the other cell.
  struct SegmentRun {
    int begin, end;
  };
  /// Candidates for nodes [first, first + group) of a cell: runs [run_begin, run_end) of its list.
  struct Group {
    int first;
    int run_begin, run_end;
  };
  /// One ordered pair and its groups that have candidates.
  struct Pair : CellPair {
    int group_begin, group_end;
    Range touched;  ///< ends of the candidates: nodes of `other` from its first on; its count stands for node 0 again
    int reaction;   ///< where those nodes begin among all that the cell touches
    int reverse;    ///< index of the opposite pair in the list of `other`
  };
  /// All that belongs to the nodes of one cell.
  struct CandidateList {
    std::vector<Pair> pairs;  ///< ordered by type of the other cell, then by the other cell, then by shift
    std::vector<Group> groups;
    std::vector<SegmentRun> runs;
    int touched = 0;  ///< number of nodes of other cells that the pairs touch
  };

  NeighbourList(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain);

  /// Pass 1: has a node moved too far?
  void measure(Worker worker, const Membranes& membranes) { watch_.measure(worker, membranes); }
  /// With other ranks, before that: they agree on it.
  [[nodiscard]] DisplacementWatch& watch() { return watch_; }
  /// Pass 2: if one has, makes the lists of this worker's cells anew. `segments` are those of the present positions.
  void refresh(Worker worker, const Membranes& membranes, const SegmentTable& segments);
  /// Pass 3: if the lists are new, finds the opposite pairs of this worker's cells.
  void link(Worker worker, const Membranes& membranes);
  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Membranes& membranes, std::span<const Range> nodes);
  /// Whether the lists are new in this step; the same for all workers from pass 2 on.
  [[nodiscard]] bool renewed() const { return watch_.exceeded(); }

  [[nodiscard]] const CandidateList& list(int cell) const { return lists_[cell]; }
  [[nodiscard]] const Cutoffs& cutoffs() const { return cutoffs_; }
  [[nodiscard]] const Domain<2>& domain() const { return domain_; }
  /// How often the lists were made.
  [[nodiscard]] long renewals() const { return renewals_; }

 private:
  /// While a list is made.
  struct Workspace {
    std::vector<int> near;       ///< cells that may be near
    std::vector<double> square;  ///< [group][segment] square distances
    std::vector<double> excess;  ///< how far each segment is from being a candidate
  };
  /// `near`: cells that may be; in any order.
  void list_pairs(const Membranes& membranes, int cell, const SegmentTable& segments, double skin,
                  std::vector<int>& near);
  void list_candidates(const Membranes& membranes, int cell, Pair& pair, const SegmentTable& segments, double skin,
                       Workspace& workspace);

  Cutoffs cutoffs_;
  Domain<2> domain_;
  DisplacementWatch watch_;
  std::vector<int> rank_;   // of each cell: its place when they are ordered by type, then by number
  std::size_t stride_ = 0;  // of a workspace: segments of any cell, with a margin
  WorkerScratch<Workspace> workspaces_;
  std::vector<CandidateList> lists_;
  long renewals_ = 0;
};

}  // namespace rouleau::core
