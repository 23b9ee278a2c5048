#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <rouleau/dispatch.hpp>
#include <utility>

namespace rouleau::host {

namespace {

/// The nodes of one cell against one other cell's image.
struct SearchTask {
  const double *x, *y, *along_x, *along_y, *inverse_square;
  const Neighbours::Group *groups, *groups_end;
  const Neighbours::SegmentRun* runs;
  double move_x, move_y;       // of the image
  int nodes_end;               // of the cell
  int other_first, other_end;  // of the other cell
  double cutoff;
  int *node, *segment, *segment_end;
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
      count = closest<S>(t, *group, move_x, move_y, count);
    }
    for (int i = t.count; i < count; i += S::size) refine<S>(t, i, move_x, move_y, count - i);
    task->count = count;
  }

 private:
  /// Closest segment of each node of a group; appends those within the cutoff.
  template <class S>
  ROULEAU_ALWAYS_INLINE static int closest(const SearchTask& t, const Neighbours::Group& group, const S& move_x,
                                           const S& move_y, int count) {
    constexpr int packs = Neighbours::group / S::size;
    S x[packs], y[packs], square[packs], index[packs];
    for (int p = 0; p < packs; ++p) {
      x[p] = S::load(t.x + group.first + p * S::size) - move_x;
      y[p] = S::load(t.y + group.first + p * S::size) - move_y;
      square[p] = 1e300;
      index[p] = 0.0;
    }
    for (int r = group.run_begin; r < group.run_end; ++r) {
      for (int k = t.other_first + t.runs[r].begin; k < t.other_first + t.runs[r].end; ++k) {
        const S from_x = t.x[k], from_y = t.y[k], along_x = t.along_x[k], along_y = t.along_y[k];
        const S inverse_square = t.inverse_square[k];
        const S number = static_cast<double>(k);
        for (int p = 0; p < packs; ++p) {
          const Approach<S> approach(x[p] - from_x, y[p] - from_y, along_x, along_y, inverse_square);
          const auto nearer = approach.square < square[p];
          square[p] = select(nearer, approach.square, square[p]);
          index[p] = select(nearer, number, index[p]);
        }
      }
    }
    double squares[Neighbours::group], indices[Neighbours::group];
    for (int p = 0; p < packs; ++p) {
      square[p].store(squares + p * S::size);
      index[p].store(indices + p * S::size);
    }
    const int valid = t.nodes_end - group.first;
    const double cutoff_square = t.cutoff * t.cutoff;
    for (int k = 0; k < Neighbours::group; ++k) {
      const int segment = static_cast<int>(indices[k]);
      t.node[count] = group.first + k;
      t.segment[count] = segment;
      t.segment_end[count] = segment + 1 == t.other_end ? t.other_first : segment + 1;
      count += ((k < valid) & (squares[k] <= cutoff_square)) ? 1 : 0;
    }
    return count;
  }

  /// Values at the given places.
  template <class S, int... k>
  ROULEAU_ALWAYS_INLINE static S gather(const double* values, const int (&at)[S::size],
                                        std::integer_sequence<int, k...>) {
    return S(typename S::Vector{values[at[k]]...});
  }

  /// Place, distance and direction of contacts [i, i + valid); the arrays have room for a whole pack.
  template <class S>
  ROULEAU_ALWAYS_INLINE static void refine(const SearchTask& t, int i, const S& move_x, const S& move_y, int valid) {
    constexpr std::make_integer_sequence<int, S::size> lanes;
    int node[S::size], segment[S::size];
    for (int k = 0; k < S::size; ++k) {
      const int at = k < valid ? i + k : i;
      node[k] = t.node[at];
      segment[k] = t.segment[at];
    }
    const S x = gather<S>(t.x, node, lanes) - move_x, y = gather<S>(t.y, node, lanes) - move_y;
    const Approach<S> approach(x - gather<S>(t.x, segment, lanes), y - gather<S>(t.y, segment, lanes),
                               gather<S>(t.along_x, segment, lanes), gather<S>(t.along_y, segment, lanes),
                               gather<S>(t.inverse_square, segment, lanes));
    const S distance = sqrt(approach.square), inverse = 1.0 / distance;
    approach.along.store(t.along + i);
    // Rounding may differ from that of the search by a unit in the last place: the potential is promised the cutoff.
    min(max(distance, S(ContactList::least_distance)), S(t.cutoff)).store(t.distance + i);
    (approach.x * inverse).store(t.direction_x + i);
    (approach.y * inverse).store(t.direction_y + i);
    double closest = approach.square.vector[0];
    for (int k = 1; k < S::size; ++k) closest = min(approach.square.vector[k], closest);
    if (!(closest > 0)) send_out(t, i, std::min(valid, S::size));
  }
  /// A node on the other outline has no direction of its own: it is sent out along the segment's outward normal.
  static void send_out(const SearchTask& t, int i, int valid) {
    for (int k = i; k < i + valid; ++k) {
      if (t.distance[k] > ContactList::least_distance) continue;
      const int segment = t.segment[k];
      const double inverse_length = std::sqrt(t.inverse_square[segment]);
      t.direction_x[k] = t.along_y[segment] * inverse_length;
      t.direction_y[k] = -t.along_x[segment] * inverse_length;
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
  const Range cells = worker.share(static_cast<int>(membranes.cells.size()));
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    if (neighbours_.renewed()) reserve(cell);
    search(membranes, cell);
  }
}

void Contacts::reserve(int cell) {
  ContactList& list = lists_[static_cast<std::size_t>(cell)];
  const Neighbours::CellList& candidates = neighbours_.list(cell);
  list.ranges.resize(candidates.pairs.size());
  const std::size_t room = candidates.groups.size() * Neighbours::group + SegmentTable::margin;
  if (room <= list.node.size()) return;
  for (auto* values : {&list.node, &list.segment, &list.segment_end}) values->resize(room);
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
  task.node = list.node.data(), task.segment = list.segment.data(), task.segment_end = list.segment_end.data();
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
      task.other_first = other.first, task.other_end = other.end();
      task.cutoff = cutoff;
      function(&task);
    }
    list.ranges[p] = {before, task.count};
  }
  list.count = task.count;
}

}  // namespace rouleau::host
