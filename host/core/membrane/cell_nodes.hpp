// The nodes of all cells of a scene, whatever joins them: one structure of arrays, in lattice units.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/bounding_box.hpp"
#include "element_state.hpp"
#include "paged_array.hpp"

namespace rouleau::core {

/// In two dimensions: a closed polygon, counter-clockwise. Segment i joins node i and the next node, so that nodes and
/// segments share their numbers. How the nodes of a surface are joined is a matter of its type (Mesh).
struct Segments {
  int first;  ///< node
  int count;  ///< of nodes and of segments

  [[nodiscard]] int end() const { return first + count; }
  /// The node after / before node i along the outline.
  [[nodiscard]] int next(int i) const { return i + 1 == end() ? first : i + 1; }
  [[nodiscard]] int previous(int i) const { return i == first ? end() - 1 : i - 1; }
};

/// One cell: its nodes in the arrays of CellNodes.
struct CellRange : Segments {
  int type;                   ///< index into the setup's cell types
  double rest_area = 0;       ///< of an outline, enclosed as created: the fluid inside cannot leave
  double rest_perimeter = 0;  ///< of an outline: RestShape::rest_perimeter
};

/// What one rank has to do with a cell.
struct CellPart {
  bool owned;     ///< it computes the cell's forces and moves it
  bool known;     ///< it knows where the cell is; the arrays hold something old else
  bool reaching;  ///< the cell's nodes may touch this rank's block
  bool inside;    ///< it owns the cell, and no node touches anything but nodes of its block
};

/// Which cells a pass is over: those that this rank owns, or what it knows of others'; of its own those inside of its
/// block, which can do without other ranks, or those at its borders: all of the only rank's.
enum class Whose { own, others, own_inside, own_at_borders };

/// Numbers of cells in their order: those of a list, or all, at places [begin, end); of these the owned ones, or all.
class CellNumbers {
 public:
  /// `listed`: null: all. `parts`: of all cells; null: owned or not.
  CellNumbers(Range places, const int* listed, const CellPart* parts = nullptr)
      : places_(places), listed_(listed), parts_(parts) {}
  class Iterator {
   public:
    Iterator(const CellNumbers& of, int place) : of_(of), place_(place) { pass_others(); }
    int operator*() const { return of_.listed_ != nullptr ? of_.listed_[place_] : place_; }
    Iterator& operator++() {
      ++place_;
      pass_others();
      return *this;
    }
    bool operator!=(const Iterator& other) const { return place_ != other.place_; }

   private:
    void pass_others() {
      while (of_.parts_ != nullptr && place_ < of_.places_.end && !of_.parts_[**this].owned) ++place_;
    }
    const CellNumbers& of_;
    int place_;
  };
  [[nodiscard]] Iterator begin() const { return {*this, places_.begin}; }
  [[nodiscard]] Iterator end() const { return {*this, places_.end}; }
  [[nodiscard]] bool empty() const { return places_.begin == places_.end; }
  /// Another one for every worker that has any.
  [[nodiscard]] int first_place() const { return places_.begin; }

 private:
  Range places_;
  const int* listed_;
  const CellPart* parts_;
};

/// A number for each node along x, y and z; that along z is empty in two dimensions.
using NodeArrays = std::array<std::vector<double>, 3>;

/// Those along the axes of D dimensions.
template <int D, class Arrays>
auto along_axes(Arrays& arrays) {
  return std::span(arrays).template first<D>();
}

/// Where they begin for the nodes from `first` on.
template <int D, class Arrays>
auto pointers(Arrays& arrays, int first = 0) {
  std::array<decltype(arrays[0].data()), D> begin;
  for (std::size_t k = 0; k < D; ++k) begin[k] = arrays[k].data() + first;
  return begin;
}

/// Positions are not wrapped into the periodic box, so that cells stay whole. The first node of the lattice lies at the
/// origin, walls half a spacing outside the first and the last one.
struct CellNodes {
  std::vector<CellRange> cells;
  NodeArrays position;
  NodeArrays force;                   ///< on the nodes, set anew each step
  NodeArrays velocity;                ///< displacement of the last step
  std::vector<double> largest_step;   ///< of each known cell: no node moved further in the last
                                      ///< step; empty: unknown
  double largest_step_of_others = 0;  ///< the same for all cells that are not known
  std::vector<double> area_leakage;   ///< of each cell, over its rest area: area that the area
                                      ///< correction kept from leaving it within a strain of about
                                      ///< one, in three dimensions volume; empty: none
  std::vector<ElementState> state;    ///< what laws and the method remember; empty where none does
  ContactMemory contacts;             ///< what interactions between cells remember
  ContactMemory wall_contacts;        ///< what interactions with walls remember
  std::vector<CellPart> part;         ///< of this rank in each cell, none of one that is not there; empty: all of
                                      ///< every cell
  std::vector<int> known;             ///< the cells that it knows, if it has parts

  [[nodiscard]] int node_count() const { return static_cast<int>(position[0].size()); }
  /// Of the cells that this rank knows.
  [[nodiscard]] int known_node_count() const {
    if (part.empty()) return node_count();
    int nodes = 0;
    for (const int c : known) nodes += cells[c].count;
    return nodes;
  }
  [[nodiscard]] bool owns(int cell) const { return part.empty() || part[cell].owned; }
  [[nodiscard]] bool knows(int cell) const { return part.empty() || part[cell].known; }
  [[nodiscard]] bool reaches(int cell) const { return part.empty() || part[cell].reaching; }
  [[nodiscard]] bool is(int cell, Whose whose) const {
    if (whose == Whose::others) return knows(cell) && !owns(cell);
    const bool inside = !part.empty() && part[cell].inside;
    return owns(cell) && (whose == Whose::own || inside == (whose == Whose::own_inside));
  }
  [[nodiscard]] int cell_count() const { return static_cast<int>(cells.size()); }
  /// The cells that this rank knows: what a step is about, however many there are. `worker`: its share of them.
  [[nodiscard]] CellNumbers known_cells() const { return known_cells(Worker{}); }
  [[nodiscard]] CellNumbers known_cells(Worker worker) const {
    return part.empty() ? CellNumbers(worker.share(cell_count()), nullptr)
                        : CellNumbers(worker.share(static_cast<int>(known.size())), known.data());
  }
  /// Those of them that it owns. `worker`: of its share of those that this rank knows, so that a worker meets the same
  /// cells in one pass after another.
  [[nodiscard]] CellNumbers own_cells() const { return own_cells(Worker{}); }
  [[nodiscard]] CellNumbers own_cells(Worker worker) const {
    return part.empty() ? known_cells(worker)
                        : CellNumbers(worker.share(static_cast<int>(known.size())), known.data(), part.data());
  }
  /// The one of them at a place.
  [[nodiscard]] int known_at(int place) const { return part.empty() ? place : known[place]; }
  /// Between which numbers a worker's known cells lie.
  [[nodiscard]] Range numbers_of_known(Worker worker) const {
    if (part.empty()) return worker.share(cell_count());
    const Range share = worker.share(static_cast<int>(known.size()));
    const auto number = [this](int place) {
      return place < static_cast<int>(known.size()) ? known[place] : cell_count();
    };
    return {number(share.begin), number(share.end)};
  }
  /// The nodes of these, and of others between them.
  [[nodiscard]] Range node_share(Worker worker) const {
    const Range share = numbers_of_known(worker);
    const auto first = [this](int cell) { return cell < cell_count() ? cells[cell].first : node_count(); };
    return {first(share.begin), first(share.end)};
  }

  /// The only rank has these cells, in their order, and no others: those have not come yet, or have gone.
  void keep_only(std::vector<int> there);
  /// Makes room for so many, without taking memory for it before they are there.
  void reserve(std::size_t cell_count, std::size_t nodes, int dimension);
  /// Nodes that positions have been added of exert no force and have not moved.
  void resize_to_positions();
  /// Takes all cells away, as they were added; the room for them stays.
  void remove_cells();
  /// Nodes of the cells that this rank knows or does not know, in runs.
  [[nodiscard]] std::vector<Range> known_nodes() const { return nodes_in_runs(true); }
  [[nodiscard]] std::vector<Range> unknown_nodes() const { return nodes_in_runs(false); }
  /// Takes no memory for what is known of these nodes and for what their cells remember; both is gone.
  void forget(std::span<const Range> nodes);
  /// Where these nodes are, and no more.
  void forget_places(std::span<const Range> nodes);
  /// Makes nothing of what is kept of cells that this rank does not know. `of_cells`: one for each cell.
  template <class V>
  void forget_unknown_of(std::vector<V>& of_cells) const {
    for (std::size_t c = 0; c < of_cells.size(); ++c) {
      if (!knows(static_cast<int>(c))) of_cells[c] = {};
    }
  }

 private:
  [[nodiscard]] std::vector<Range> nodes_in_runs(bool of_known) const;
};

/// The box around a cell's nodes; its numbers are none where one of theirs is.
template <int D>
BoundingBox<D> box_of(const CellNodes& nodes, const CellRange& range) {
  BoundingBox<D> box;
  for (int k = 0; k < D; ++k) {
    double least = INFINITY, most = -INFINITY, zero = 0;  // zero becomes NaN with the first place that is not finite
    for (int i = range.first; i < range.end(); ++i) {
      const double place = nodes.position[k][i];
      least = std::min(least, place), most = std::max(most, place);
      zero += place - place;
    }
    box.least[k] = least + zero, box.most[k] = most + zero;
  }
  return box;
}
template <int D>
BoundingBox<D> box_of(const CellNodes& nodes, int cell) {
  return box_of<D>(nodes, nodes.cells[cell]);
}

/// The boxes of all cells.
template <int D>
std::vector<BoundingBox<D>> boxes_of(const CellNodes& nodes) {
  std::vector<BoundingBox<D>> boxes;
  boxes.reserve(nodes.cells.size());
  for (int c = 0; c < nodes.cell_count(); ++c) boxes.push_back(box_of<D>(nodes, c));
  return boxes;
}

/// The same; of cells that this rank does not know, no numbers.
template <int D>
std::vector<BoundingBox<D>> boxes_of_known(const CellNodes& nodes) {
  std::vector<BoundingBox<D>> boxes(nodes.cells.size(), BoundingBox<D>::unknown());
  for (const int cell : nodes.known_cells()) boxes[cell] = box_of<D>(nodes, cell);
  return boxes;
}

}  // namespace rouleau::core
