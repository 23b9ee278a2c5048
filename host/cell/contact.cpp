#include "contact.hpp"

#include <rouleau/dispatch.hpp>

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

  /// Place, distance and direction of contacts [i, i + valid); the arrays have room for a whole pack.
  template <class S>
  ROULEAU_ALWAYS_INLINE static void refine(const SearchTask& t, int i, const S& move_x, const S& move_y, int valid) {
    S x, y, from_x, from_y, along_x, along_y, inverse_square;
    for (int k = 0; k < S::size; ++k) {
      const int at = k < valid ? i + k : i;
      const int node = t.node[at], segment = t.segment[at];
      x.vector[k] = t.x[node];
      y.vector[k] = t.y[node];
      from_x.vector[k] = t.x[segment];
      from_y.vector[k] = t.y[segment];
      along_x.vector[k] = t.along_x[segment];
      along_y.vector[k] = t.along_y[segment];
      inverse_square.vector[k] = t.inverse_square[segment];
    }
    const Approach<S> approach(x - move_x - from_x, y - move_y - from_y, along_x, along_y, inverse_square);
    const S distance = sqrt(approach.square);
    const auto apart = distance > S(0.0);
    // A node on the other outline has no direction of its own: it is sent out along the segment's outward normal.
    const S inverse = 1.0 / distance, inverse_length = sqrt(inverse_square);
    approach.along.store(t.along + i);
    // Rounding may differ from that of the search by a unit in the last place: the potential is promised the cutoff.
    min(max(distance, S(ContactList::least_distance)), S(t.cutoff)).store(t.distance + i);
    select(apart, approach.x * inverse, along_y * inverse_length).store(t.direction_x + i);
    select(apart, approach.y * inverse, -(along_x * inverse_length)).store(t.direction_y + i);
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
