#include "neighbour_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <rouleau/dispatch.hpp>

namespace rouleau::core {

namespace {

constexpr int bridged = 2;  // segments between two runs that are searched rather than stepped over

/// One group of nodes against all segments of the other cell.
struct CandidateTask {
  const double *x, *y, *along_x, *along_y, *inverse_square;  // of the other cell's segments
  int segments;
  const double *node_x, *node_y;  // of the group, moved into the other cell's image
  int nodes;
  double skin, cutoff;
  double* square;  // [nodes][segments rounded up]
  double* excess;  // [segments rounded up]: negative for candidates
};

struct Candidates {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const CandidateTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const CandidateTask t = *task;
    const int stride = (t.segments + SegmentTable::margin - 1) / SegmentTable::margin * SegmentTable::margin;
    for (int k = 0; k < stride; k += S::size) S(std::numeric_limits<double>::infinity()).store(t.excess + k);
    double numbers[S::size];
    for (int k = 0; k < S::size; ++k) numbers[k] = k;
    const S lane = S::load(numbers);
    for (int i = 0; i < t.nodes; ++i) {
      double* square = t.square + i * stride;
      const S x = t.node_x[i], y = t.node_y[i];
      S nearest = std::numeric_limits<double>::infinity(), left = t.segments;
      for (int k = 0; k < t.segments; k += S::size) {
        const Approach<S> approach(x - S::load(t.x + k), y - S::load(t.y + k), S::load(t.along_x + k),
                                   S::load(t.along_y + k), S::load(t.inverse_square + k));
        approach.square.store(square + k);
        // The lanes beyond the last segment hold those of the next cell.
        const S own = select(lane < left, approach.square, S(std::numeric_limits<double>::infinity()));
        nearest = min(nearest, own);
        left -= S(S::size);
      }
      const double limit = min(std::sqrt(least(nearest)) + 4 * t.skin, t.cutoff + 2 * t.skin);
      const S limit_square = limit * limit * (1 + 1e-12);  // room for rounding
      for (int k = 0; k < t.segments; k += S::size)
        min(S::load(t.excess + k), S::load(square + k) - limit_square).store(t.excess + k);
    }
  }
};

/// Distance between two boxes, the second moved.
double distance(const BoundingBox<2>& a, const BoundingBox<2>& b, double move_x, double move_y) {
  const double dx = std::max({0.0, b.least[0] + move_x - a.most[0], a.least[0] - b.most[0] - move_x});
  const double dy = std::max({0.0, b.least[1] + move_y - a.most[1], a.least[1] - b.most[1] - move_y});
  return std::hypot(dx, dy);
}

}  // namespace

NeighbourList::NeighbourList(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain)
    : cutoffs_(std::move(cutoffs)),
      domain_(domain),
      watch_(membranes),
      rank_(membranes.cells.size()),
      workspaces_(membranes.cells.size()),
      lists_(membranes.cells.size()) {
  std::vector<int> order(membranes.cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return membranes.cells[a].type < membranes.cells[b].type; });
  for (std::size_t k = 0; k < order.size(); ++k) rank_[order[k]] = static_cast<int>(k);
  int most = 0;
  for (const CellRange& cell : membranes.cells) most = std::max(most, cell.count);
  stride_ = static_cast<std::size_t>(most + SegmentTable::margin);
}

void NeighbourList::refresh(Worker worker, const Membranes& membranes, const SegmentTable& segments) {
  if (!renewed()) return;
  const CellNumbers cells = membranes.known_cells(worker);
  const double skin = suitable_skin(membranes);
  // Every worker sorts all cells: that is quicker than to wait for one who does.
  std::vector<BoundingBox<2>> boxes;
  for (const int cell : membranes.known_cells()) boxes.push_back(segments.boxes[cell]);
  const CellGrid<2> grid(boxes, cutoffs_.largest() + 2 * skin, domain_);
  int place = cells.first_place();  // among the known cells
  for (const int cell : cells) {
    CandidateList& list = lists_[cell];
    Workspace& workspace = workspaces_.of(cells.first_place());
    workspace.square.resize(stride_ * group);
    workspace.excess.resize(stride_);
    list.pairs.clear();
    list.groups.clear();
    list.runs.clear();
    list.touched = 0;
    grid.find(place++, workspace.near);
    for (int& near : workspace.near) near = membranes.known_at(near);
    list_pairs(membranes, cell, segments, skin, workspace.near);
    for (Pair& pair : list.pairs) list_candidates(membranes, cell, pair, segments, skin, workspace);
    watch_.remember(cell, membranes, skin);
  }
  if (worker.first()) ++renewals_;
}

void NeighbourList::list_pairs(const Membranes& membranes, int cell, const SegmentTable& segments, double skin,
                               std::vector<int>& near) {
  CandidateList& list = lists_[cell];
  const int type = membranes.cells[cell].type;
  const BoundingBox<2>& own = segments.boxes[cell];
  std::sort(near.begin(), near.end(), [&](int a, int b) { return rank_[a] < rank_[b]; });
  for (const int other : near) {
    const double cutoff = cutoffs_(type, membranes.cells[other].type);
    if (!(cutoff > 0)) continue;
    core::for_each_image(own, segments.boxes[other], cutoff + 2 * skin, domain_, [&](ImageShift shift) {
      if (other != cell || !(shift == ImageShift{})) list.pairs.push_back({{other, shift}, 0, 0, {0, 0}, 0, -1});
    });
  }
}

void NeighbourList::list_candidates(const Membranes& membranes, int cell, Pair& pair, const SegmentTable& segments,
                                    double skin, Workspace& workspace) {
  static const auto candidates = Dispatch<Candidates, const CandidateTask*>::pick();
  CandidateList& list = lists_[cell];
  const CellRange& own = membranes.cells[cell];
  const CellRange& other = membranes.cells[pair.other];
  const double move_x = pair.shift.x * domain_.period(0), move_y = pair.shift.y * domain_.period(1);
  const double cutoff = cutoffs_(own.type, other.type);
  double x[group], y[group];
  const CandidateTask task{segments.x.data() + other.first,
                           segments.y.data() + other.first,
                           segments.along_x.data() + other.first,
                           segments.along_y.data() + other.first,
                           segments.inverse_square.data() + other.first,
                           other.count,
                           x,
                           y,
                           group,
                           skin,
                           cutoff,
                           workspace.square.data(),
                           workspace.excess.data()};
  pair.group_begin = static_cast<int>(list.groups.size());
  const std::size_t first_run = list.runs.size();
  for (int first = own.first; first < own.end(); first += group) {
    BoundingBox<2> box{{segments.x[first], segments.y[first]}, {segments.x[first], segments.y[first]}};
    for (int k = 0; k < group; ++k) {
      const int i = std::min(first + k, own.end() - 1);
      x[k] = segments.x[i] - move_x;
      y[k] = segments.y[i] - move_y;
      box.least = {std::min(box.least[0], segments.x[i]), std::min(box.least[1], segments.y[i])};
      box.most = {std::max(box.most[0], segments.x[i]), std::max(box.most[1], segments.y[i])};
    }
    const double reach = cutoff + 2 * skin + 1e-9;
    if (distance(box, segments.boxes[pair.other], move_x, move_y) > reach) continue;
    candidates(&task);
    const auto run_begin = static_cast<int>(list.runs.size());
    for (int k = 0; k < other.count; ++k) {
      if (!(workspace.excess[k] <= 0)) continue;
      // Few long runs cost less than many short ones.
      if (static_cast<int>(list.runs.size()) > run_begin && k - list.runs.back().end < bridged)
        list.runs.back().end = k + 1;
      else
        list.runs.push_back({k, k + 1});
    }
    const auto run_end = static_cast<int>(list.runs.size());
    if (run_end > run_begin) list.groups.push_back({first, run_begin, run_end});
  }
  pair.group_end = static_cast<int>(list.groups.size());
  for (std::size_t r = first_run; r < list.runs.size(); ++r) {
    const Range ends{list.runs[r].begin, list.runs[r].end + 1};
    pair.touched =
        r == first_run ? ends : Range{std::min(pair.touched.begin, ends.begin), std::max(pair.touched.end, ends.end)};
  }
  pair.reaction = list.touched;
  list.touched += pair.touched.end - pair.touched.begin;
}

void NeighbourList::forget(const Membranes& membranes, std::span<const Range> nodes) {
  watch_.forget(membranes, nodes);
  membranes.forget_unknown_of(lists_);
}

void NeighbourList::link(Worker worker, const Membranes& membranes) {
  if (!renewed()) return;
  const CellNumbers cells = membranes.known_cells(worker);
  for (const int cell : cells) {
    for (Pair& pair : lists_[cell].pairs) {
      const std::vector<Pair>& others = lists_[pair.other].pairs;
      const auto opposite = std::find_if(others.begin(), others.end(), [&](const Pair& candidate) {
        return candidate.other == cell && candidate.shift == -pair.shift;
      });
      pair.reverse = static_cast<int>(opposite - others.begin());
    }
  }
}

}  // namespace rouleau::core
