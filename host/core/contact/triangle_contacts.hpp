// Closest points of the nodes of one cell on the surfaces of its neighbours, in three dimensions.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/worker.hpp"
#include "closest_points.hpp"
#include "contact_law.hpp"
#include "core/domain/domain.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/surface/surfaces.hpp"
#include "cutoffs.hpp"
#include "near_triangles.hpp"
#include "self_reach.hpp"

namespace rouleau::core {

/// A node X of a cell and the closest point P = sum of weight[k] X_corner[k] on another cell's image.
struct TriangleContact {
  int node;                   ///< index in Surfaces
  int other;                  ///< cell; the cell itself, for one of its images or, not shifted, for its own surface
  ImageShift shift;           ///< of that image
  bool within;                ///< it is the cell's own surface
  std::array<int, 3> corner;  ///< of the triangle that P is on: indices in Surfaces
  std::array<double, 3> weight;
  double distance;   ///< |X - P|, at least least_distance
  Vec<3> direction;  ///< (X - P) / |X - P|; the triangle's outward normal where X = P
};

/// Exact closest points within the cutoffs, one for each node and each image of another cell, and one on those parts of
/// its own surface that it may touch (SelfReach). They depend on the present positions alone, not on when the lists of
/// candidates were made.
///
/// Candidates stay complete while no node has moved further than the skin, for the reason that NeighbourList has; a
/// triangle is a set of convex combinations of its corners, too. Of each a bound of its last known distance is kept,
/// which has changed by no more than both cells' nodes have travelled since: most need not be looked at. Those that
/// are, are looked at three at a time, the nearest first.
class TriangleContacts {
 public:
  /// `self_cutoffs`: of each type, within a cell; 0, and where there are none: cells do not touch themselves.
  TriangleContacts(const Surfaces& surfaces, Cutoffs cutoffs, const Domain<3>& domain,
                   const std::vector<double>& self_cutoffs = {});

  /// Of all cells within one reach, whatever their types and owners, at the present positions: find() may be called.
  static TriangleContacts within(double reach, const Surfaces& surfaces, const Domain<3>& domain);

  /// Pass over cells: whether a node has moved too far for the lists.
  void measure(Worker worker, const Surfaces& surfaces);
  /// Pass over cells, after a barrier: their lists, if they have to be made anew.
  void refresh(Worker worker, const Surfaces& surfaces);
  /// Then: the contacts of a cell of this rank, by node, then by the other cell and its image. A cell's by one worker
  /// at a time.
  void find(int cell, const Surfaces& surfaces, std::vector<TriangleContact>& contacts) const;

  /// With other ranks, before measure(): they agree on whether a node has moved too far.
  [[nodiscard]] DisplacementWatch& watch() { return watch_; }
  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Surfaces& surfaces, std::span<const Range> nodes);
  /// How often lists were made.
  [[nodiscard]] long renewals() const { return renewals_; }

 private:
  struct Candidate {
    float distance;  ///< not less: when it was last looked at, and how far both cells had travelled by then, added up
    int triangle;    ///< of the other cell
  };
  static constexpr int at_once = 3;
  /// Candidates of a node against one image of a cell.
  struct Group {
    int node, image;
    float nearest;                         ///< least distance of them all
    std::array<Candidate, at_once> first;  ///< where there are fewer, the last of them again
    int begin, end;                        ///< others, nearest first
  };
  /// Of a cell, from which the nodes have candidates.
  struct Image {
    int other;
    ImageShift shift;
    bool within;  ///< the cell's own surface
    // For find().
    int first_node;                       ///< of the other cell
    const std::array<int, 3>* triangles;  ///< of its mesh
    Vec<3> moved;                         ///< by so much the image lies beside it
    double cutoff, path;                  ///< how far both cells have travelled
  };
  /// How far find() has come with a group.
  struct Search {
    int group;
    int looked;     ///< at so many beyond the first; -1: at none
    int closest;    ///< triangle; `none`: none
    double square;  ///< of its distance, or of the cutoff
    std::array<double, 3> weight;
    Vec<3> away;  ///< from the closest point to the node
  };
  struct CandidateList {
    std::vector<Image> images;
    std::vector<Group> groups;
    std::vector<Candidate> candidates;
    // Room for find().
    std::vector<Search> searches;
    std::vector<int> searching;  ///< those that are not at their end
    ClosestPoints points;        ///< of their next candidates
    std::vector<Candidate> fresh;
    /// Least distance of a group's others from the one with this number on; infinite: there are none.
    [[nodiscard]] float nearest_from(const Group& group, int number) const {
      const int at = group.begin + number;
      return at < group.end ? candidates[at].distance : std::numeric_limits<float>::infinity();
    }
    /// What is to be looked at next.
    std::span<Candidate> next(const Search& search);
  };

  static constexpr int none = std::numeric_limits<int>::max();

  static void sort_in(CandidateList& list, const Search& search);
  [[nodiscard]] double travelled(int cell, int other) const;
  [[nodiscard]] double cutoff(const Surfaces& surfaces, int cell, int other, bool within) const;
  /// `near`: cells that may be near.
  void list_candidates(int cell, const Surfaces& surfaces, const std::vector<int>& near,
                       const std::vector<BoundingBox<3>>& boxes, double skin);
  void look_at_next(const Surfaces& surfaces, CandidateList& list) const;
  static TriangleContact contact(const Search& search, const CandidateList& list, const Surfaces& surfaces);

  Cutoffs cutoffs_;
  std::vector<std::unique_ptr<const SelfReach>> self_reach_;  // of each type; null: it does not touch itself; or empty
  Domain<3> domain_;
  DisplacementWatch watch_;
  bool of_all_ = false;       // lists of other ranks' cells, too
  std::vector<double> path_;  // of each cell since its list was made: no node has a longer one; infinite: unknown
  std::vector<std::uint8_t> renewed_;         // of each cell: its list was made in this step
  mutable std::vector<CandidateList> lists_;  // of which distances are mutable
  long renewals_ = 0;
};

}  // namespace rouleau::core
