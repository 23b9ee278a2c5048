#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <rouleau/dispatch.hpp>

namespace rouleau::host {

namespace {

/// The nodes of one cell against one other cell's image.
struct SearchTask {
  const double *x, *y, *along_x, *along_y, *inverse_square;
  const Neighbours::Group *groups, *groups_end;
  const Neighbours::SegmentRun* runs;
  double move_x, move_y;  // of the image
  int nodes_end;          // of the cell
  int other_first;        // of the other cell
  double cutoff;
  int *node, *segment;
  double *along, *distance, *direction_x, *direction_y;
  int count;  // contacts before and, when done, after
};

struct Search {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(SearchTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const SearchTask t = *task;
    int count = t.count;
    const S move_x = t.move_x, move_y = t.move_y;
    for (const Neighbours::Group* group = t.groups; group != t.groups_end; ++group) {
      count = append<S>(t, *group, move_x, move_y, count);
    }
    task->count = count;
  }

 private:
  static constexpr int size = Neighbours::group;
  /// The closest segment of each node.
  template <class S>
  struct Closest {
    S square, segment, along, x, y;
  };
  /// The same of a group.
  struct Found {
    double along[size], distance[size], direction_x[size], direction_y[size];
    int segment[size];
  };

  /// Appends the contacts of a group of nodes; the arrays have room for the whole group.
  template <class S>
  ROULEAU_ALWAYS_INLINE static int append(const SearchTask& t, const Neighbours::Group& group, const S& move_x,
                                          const S& move_y, int count) {
    constexpr int packs = size / S::size;
    Closest<S> closest[packs];
    find<S>(t, group, move_x, move_y, closest);
    Found found;
    S nearest = 1e300, farthest = 0.0;
    for (int p = 0; p < packs; ++p) {
      const Closest<S>& c = closest[p];
      const int at = p * S::size;
      const S distance = sqrt(c.square), inverse = 1.0 / distance;
      nearest = min(distance, nearest);
      farthest = max(distance, farthest);
      c.along.store(found.along + at);
      distance.store(found.distance + at);
      (c.x * inverse).store(found.direction_x + at);
      (c.y * inverse).store(found.direction_y + at);
      for (int k = 0; k < S::size; ++k) found.segment[at + k] = static_cast<int>(c.segment.vector[k]);
    }
    if (!(least(nearest) >= ContactList::least_distance)) send_out(t, found);
    const int valid = std::min(size, t.nodes_end - group.first);
    if (valid == size && largest(farthest) <= t.cutoff) {
      put<size>(t, found, group.first, 0, count);
      return count + size;
    }
    for (int k = 0; k < valid; ++k) {
      put<1>(t, found, group.first, k, count);
      count += found.distance[k] <= t.cutoff ? 1 : 0;
    }
    return count;
  }

  template <class S>
  ROULEAU_ALWAYS_INLINE static void find(const SearchTask& t, const Neighbours::Group& group, const S& move_x,
                                         const S& move_y, Closest<S>* closest) {
    constexpr int packs = size / S::size;
    S x[packs], y[packs];
    for (int p = 0; p < packs; ++p) {
      x[p] = S::load(t.x + group.first + p * S::size) - move_x;
      y[p] = S::load(t.y + group.first + p * S::size) - move_y;
      closest[p] = {1e300, 0.0, 0.0, 0.0, 0.0};
    }
    for (int r = group.run_begin; r < group.run_end; ++r) {
      for (int k = t.other_first + t.runs[r].begin; k < t.other_first + t.runs[r].end; ++k) {
        const S from_x = t.x[k], from_y = t.y[k], along_x = t.along_x[k], along_y = t.along_y[k];
        const S inverse_square = t.inverse_square[k];
        const S number = static_cast<double>(k);
        for (int p = 0; p < packs; ++p) {
          const Approach<S> approach(x[p] - from_x, y[p] - from_y, along_x, along_y, inverse_square);
          Closest<S>& c = closest[p];
          const auto nearer = approach.square < c.square;
          c.square = select(nearer, approach.square, c.square);
          c.segment = select(nearer, number, c.segment);
          c.along = select(nearer, approach.along, c.along);
          c.x = select(nearer, approach.x, c.x);
          c.y = select(nearer, approach.y, c.y);
        }
      }
    }
  }

  /// Writes `count` nodes of a group from the k-th on to the list.
  template <int count>
  ROULEAU_ALWAYS_INLINE static void put(const SearchTask& t, const Found& found, int first, int k, int to) {
    for (int i = 0; i < count; ++i) {
      t.node[to + i] = first + k + i;
      t.segment[to + i] = found.segment[k + i];
    }
    for (int i = 0; i < count; ++i) t.along[to + i] = found.along[k + i];
    for (int i = 0; i < count; ++i) t.distance[to + i] = found.distance[k + i];
    for (int i = 0; i < count; ++i) t.direction_x[to + i] = found.direction_x[k + i];
    for (int i = 0; i < count; ++i) t.direction_y[to + i] = found.direction_y[k + i];
  }

  /// A node on the other outline has no direction of its own: it is sent out along the segment's outward normal.
  [[gnu::noinline, gnu::cold]] static void send_out(const SearchTask& t, Found& found) {
    for (int k = 0; k < size; ++k) {
      if (!(found.distance[k] > 0)) {
        const int segment = found.segment[k];
        const double inverse_length = std::sqrt(t.inverse_square[segment]);
        found.direction_x[k] = t.along_y[segment] * inverse_length;
        found.direction_y[k] = -t.along_x[segment] * inverse_length;
      }
      found.distance[k] = std::max(found.distance[k], ContactList::least_distance);
    }
  }
};

}  // namespace

Contacts::Contacts(const Membranes& membranes, Cutoffs cutoffs, PeriodicBox box)
    : neighbours_(membranes, std::move(cutoffs), box), segments_(membranes), lists_(membranes.cells.size()) {}

void Contacts::run(Worker worker, int phase, const Membranes& membranes) {
  if (phase == 0) {
    neighbours_.measure(worker, membranes);
    segments_.update(worker, membranes);
    return;
  }
  neighbours_.refresh(worker, membranes, segments_);
  const bool renewed = neighbours_.renewed();
  const Range cells = worker.share(membranes.cell_count());
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    if (renewed) reserve(cell);
    search(membranes, cell);
  }
}

void Contacts::reserve(int cell) {
  ContactList& list = lists_[static_cast<std::size_t>(cell)];
  const Neighbours::CellList& candidates = neighbours_.list(cell);
  list.ranges.resize(candidates.pairs.size());
  const std::size_t room = candidates.groups.size() * Neighbours::group + SegmentTable::margin;
  if (room <= list.node.size()) return;
  for (auto* values : {&list.node, &list.segment}) values->resize(room);
  for (auto* values : {&list.along, &list.distance, &list.direction_x, &list.direction_y}) values->resize(room);
}

void Contacts::search(const Membranes& membranes, int cell) {
  static const auto function = Dispatch<Search, SearchTask*>::pick();
  ContactList& list = lists_[static_cast<std::size_t>(cell)];
  const Neighbours::CellList& candidates = neighbours_.list(cell);
  const CellRange& own = membranes.cells[static_cast<std::size_t>(cell)];
  SearchTask task{};
  task.x = segments_.x.data(), task.y = segments_.y.data();
  task.along_x = segments_.along_x.data(), task.along_y = segments_.along_y.data();
  task.inverse_square = segments_.inverse_square.data();
  task.runs = candidates.runs.data();
  task.nodes_end = own.end();
  task.node = list.node.data(), task.segment = list.segment.data();
  task.along = list.along.data(), task.distance = list.distance.data();
  task.direction_x = list.direction_x.data(), task.direction_y = list.direction_y.data();
  for (std::size_t p = 0; p < candidates.pairs.size(); ++p) {
    const Neighbours::Pair& pair = candidates.pairs[p];
    const CellRange& other = membranes.cells[static_cast<std::size_t>(pair.other)];
    const double cutoff = neighbours_.cutoffs()(own.type, other.type);
    const int before = task.count;
    if (pair.group_begin != pair.group_end) {
      task.groups = candidates.groups.data() + pair.group_begin;
      task.groups_end = candidates.groups.data() + pair.group_end;
      task.move_x = pair.shift.x * neighbours_.box().nx, task.move_y = pair.shift.y * neighbours_.box().ny;
      task.other_first = other.first;
      task.cutoff = cutoff;
      function(&task);
    }
    list.ranges[p] = {before, task.count};
  }
  list.count = task.count;
}

}  // namespace rouleau::host
