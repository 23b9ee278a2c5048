#include "segment_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>
#include <rouleau/dispatch.hpp>

namespace rouleau::core {

namespace {

/// The nodes of one cell against one other cell's image.
struct SearchTask {
  const double *x, *y, *along_x, *along_y, *inverse_square;
  const NeighbourList::Group *groups, *groups_end;
  const NeighbourList::SegmentRun* runs;
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
    for (const NeighbourList::Group* group = t.groups; group != t.groups_end; ++group)
      count = append<S>(t, *group, move_x, move_y, count);
    task->count = count;
  }

 private:
  static constexpr int size = NeighbourList::group;
  static constexpr double no_distance = 1e-150;  // the least whose square has a root and an inverse
  /// The closest segment of each node.
  template <class S>
  struct Closest {
    S square, segment, along, x, y;
  };

  /// Appends the contacts of a group of nodes. The whole group is written, for which the arrays have room, and then
  /// drawn together where nodes lie beyond the cutoff.
  template <class S>
  ROULEAU_ALWAYS_INLINE static int append(const SearchTask& t, const NeighbourList::Group& group, const S& move_x,
                                          const S& move_y, int count) {
    constexpr int packs = size / S::size;
    Closest<S> closest[packs];
    find<S>(t, group, move_x, move_y, closest);
    S nearest = 1e300, farthest = 0.0;
    for (int p = 0; p < packs; ++p) {
      const Closest<S>& c = closest[p];
      const int at = count + p * S::size;
      const SquareRoot<S> distance = sqrt_and_inverse(max(S(no_distance * no_distance), c.square));
      nearest = min(nearest, distance.root);
      farthest = max(farthest, distance.root);
      c.along.store(t.along + at);
      distance.root.store(t.distance + at);
      (c.x * distance.inverse).store(t.direction_x + at);
      (c.y * distance.inverse).store(t.direction_y + at);
      using Integers __attribute__((vector_size(S::size * sizeof(int)))) = int;
      const Integers segment = __builtin_convertvector(c.segment.vector, Integers);
      std::memcpy(t.segment + at, &segment, sizeof segment);
    }
    for (int k = 0; k < size; ++k) t.node[count + k] = group.first + k;
    if (!(least(nearest) >= least_distance)) send_out(t, count);
    const int valid = std::min(size, t.nodes_end - group.first);
    if (valid == size && largest(farthest) <= t.cutoff) return count + size;
    int end = count;
    for (int k = count; k < count + valid; ++k) {
      const bool touches = t.distance[k] <= t.cutoff;
      t.node[end] = t.node[k];
      t.segment[end] = t.segment[k];
      t.along[end] = t.along[k];
      t.distance[end] = t.distance[k];
      t.direction_x[end] = t.direction_x[k];
      t.direction_y[end] = t.direction_y[k];
      end += touches ? 1 : 0;
    }
    return end;
  }

  template <class S>
  ROULEAU_ALWAYS_INLINE static void find(const SearchTask& t, const NeighbourList::Group& group, const S& move_x,
                                         const S& move_y, Closest<S>* closest) {
    constexpr int packs = size / S::size;
    S x[packs], y[packs];
    for (int p = 0; p < packs; ++p) {
      x[p] = S::load(t.x + group.first + p * S::size) - move_x;
      y[p] = S::load(t.y + group.first + p * S::size) - move_y;
      closest[p] = {1e300, 0.0, 0.0, 0.0, 0.0};
    }
    for (int r = group.run_begin; r < group.run_end; ++r) {
      const int begin = t.other_first + t.runs[r].begin, end = t.other_first + t.runs[r].end;
      S number = static_cast<double>(begin);
      for (int k = begin; k < end; ++k, number += S(1.0)) {
        const S from_x = S::broadcast(t.x + k), from_y = S::broadcast(t.y + k);
        const S along_x = S::broadcast(t.along_x + k), along_y = S::broadcast(t.along_y + k);
        const S inverse_square = S::broadcast(t.inverse_square + k);
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

  /// A node on the other outline has no direction of its own: it is sent out along the segment's outward normal.
  [[gnu::noinline, gnu::cold]] static void send_out(const SearchTask& t, int begin) {
    for (int k = begin; k < begin + size; ++k) {
      if (t.distance[k] <= 2 * no_distance) {  // the root is rounded
        const int segment = t.segment[k];
        const double inverse_length = std::sqrt(t.inverse_square[segment]);
        t.direction_x[k] = t.along_y[segment] * inverse_length;
        t.direction_y[k] = -t.along_x[segment] * inverse_length;
      }
      t.distance[k] = std::max(t.distance[k], least_distance);
    }
  }
};

constexpr int block_size = 8;

/// Consecutive segments and a circle that holds them.
struct Block {
  int first, end;
  double x, y, radius;
};

std::vector<Block> blocks_of(int count, const double* x, const double* y) {
  std::vector<Block> blocks;
  for (int first = 0; first < count; first += block_size) {
    const int end = std::min(first + block_size, count), middle = (first + end) / 2;
    Block& block = blocks.emplace_back(Block{first, end, x[middle], y[middle], 0});
    for (int i = first; i <= end; ++i)
      block.radius = std::max(block.radius, std::hypot(x[i < count ? i : 0] - block.x, y[i < count ? i : 0] - block.y));
  }
  return blocks;
}

}  // namespace

SelfContacts::SelfContacts(const Membranes& membranes, const std::vector<double>& cutoffs) {
  for (std::size_t t = 0; t < cutoffs.size(); ++t) {
    Type& type = types_.emplace_back(Type{cutoffs[t], {}});
    const RestShape& rest = *membranes.types[t];
    const int count = static_cast<int>(rest.x.size());
    type.reach.resize(rest.x.size(), {0, 0});
    const double apart = std::numbers::pi / 2 * type.cutoff;
    const double whole = std::accumulate(rest.rest_length.begin(), rest.rest_length.end(), 0.0);
    for (int node = 0; node < count; ++node) {
      // Begins of segments that are far enough ahead, and ends of those that are far enough behind.
      double along = 0;
      int begin = 0, end = 0;
      for (int segment = 0; segment < count; ++segment) {
        if (along < apart) begin = segment + 1;
        along += rest.rest_length[(node + segment) % count];
        if (whole - along >= apart) end = segment + 1;
      }
      if (begin < end) type.reach[node] = {node + begin, node + end};
    }
  }
}

void SelfContacts::append(const CellRange& cell, const Membranes& membranes, ContactList& list) const {
  const Type& type = types_[cell.type];
  const int count = cell.count, before = list.count;
  const double *x = membranes.position[0].data() + cell.first, *y = membranes.position[1].data() + cell.first;
  // Those of all nodes, then those of nodes that are near something.
  double *square = list.distance.data() + before, *along = list.along.data() + before;
  double *away_x = list.direction_x.data() + before, *away_y = list.direction_y.data() + before;
  int* closest = list.segment.data() + before;
  std::fill(square, square + count, type.cutoff * type.cutoff);
  std::fill(closest, closest + count, -1);
  const auto look = [&](int node, int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const int next = j + 1 < count ? j + 1 : 0;
      const double along_x = x[next] - x[j], along_y = y[next] - y[j];
      const double length2 = along_x * along_x + along_y * along_y;
      const Approach<double> approach(x[node] - x[j], y[node] - y[j], along_x, along_y, length2 > 0 ? 1 / length2 : 0);
      if (!(approach.square < square[node])) continue;
      square[node] = approach.square;
      closest[node] = j;
      along[node] = approach.along;
      away_x[node] = approach.x, away_y[node] = approach.y;
    }
  };
  const std::vector<Block> blocks = blocks_of(count, x, y);
  for (const Block& own : blocks) {
    for (const Block& other : blocks) {
      const double reach = own.radius + other.radius + type.cutoff, dx = own.x - other.x, dy = own.y - other.y;
      if (!(dx * dx + dy * dy <= reach * reach)) continue;
      for (int node = own.first; node < own.end; ++node) {
        // Counted from the node on, segments of the block may come before or after the first one of the cell.
        const Reach allowed = type.reach[node];
        for (const int turn : {0, count})
          look(node, std::max(other.first, allowed.begin - turn), std::min(other.end, allowed.end - turn));
      }
    }
  }
  int end = before;
  for (int node = 0; node < count; ++node) {
    if (closest[node] < 0) continue;
    list.node[end] = cell.first + node;
    list.segment[end] = cell.first + closest[node];
    list.along[end] = along[node];
    list.distance[end] = std::max(std::sqrt(square[node]), least_distance);
    list.direction_x[end] = away_x[node];
    list.direction_y[end++] = away_y[node];
  }
  list.within = {before, end};
  list.count = end;
}

SegmentContacts::SegmentContacts(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain,
                                 const std::vector<double>& self_cutoffs)
    : neighbours_(membranes, std::move(cutoffs), domain), segments_(membranes) {
  if (!self_cutoffs.empty()) self_contacts_.emplace(membranes, self_cutoffs);
}

void SegmentContacts::measure(Worker worker, const Membranes& membranes) {
  neighbours_.measure(worker, membranes);
  segments_.update(worker, membranes);
}

void SegmentContacts::refresh(Worker worker, const Membranes& membranes) {
  neighbours_.refresh(worker, membranes, segments_);
}

void SegmentContacts::find(int cell, const Membranes& membranes, ContactList& list) const {
  static const auto function = Dispatch<Search, SearchTask*>::pick();
  const NeighbourList::CandidateList& candidates = neighbours_.list(cell);
  const CellRange& own = membranes.cells[cell];
  const bool touches_itself = self_contacts_ && self_contacts_->acts_on(own.type);
  list.make_room(candidates.pairs.size(), candidates.groups.size() * NeighbourList::group + SegmentTable::margin +
                                              (touches_itself ? own.count : 0));
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
    const NeighbourList::Pair& pair = candidates.pairs[p];
    const CellRange& other = membranes.cells[pair.other];
    const double cutoff = neighbours_.cutoffs()(own.type, other.type);
    const int before = task.count;
    if (pair.group_begin != pair.group_end) {
      task.groups = candidates.groups.data() + pair.group_begin;
      task.groups_end = candidates.groups.data() + pair.group_end;
      task.move_x = pair.shift.x * neighbours_.domain().period(0),
      task.move_y = pair.shift.y * neighbours_.domain().period(1);
      task.other_first = other.first;
      task.cutoff = cutoff;
      function(&task);
    }
    list.ranges[p] = {before, task.count};
  }
  list.count = task.count;
  list.within = {list.count, list.count};
  if (touches_itself) self_contacts_->append(own, membranes, list);
}

void SegmentContacts::measure_velocities(int cell, const Membranes& membranes, ContactList& list) const {
  for (auto* values : {&list.normal_velocity, &list.tangential_velocity, &list.sliding_speed})
    values->resize(list.distance.size());
  const std::vector<double>&u = membranes.velocity[0], &v = membranes.velocity[1];
  const std::vector<NeighbourList::Pair>& pairs = neighbours_.list(cell).pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const CellRange& other = membranes.cells[pairs[p].other];
    for (int i = list.ranges[p].begin; i < list.ranges[p].end; ++i) {
      const int node = list.node[i], begin = list.segment[i], end = other.next(begin);
      const double along = list.along[i];
      const double du = u[node] - ((1 - along) * u[begin] + along * u[end]);
      const double dv = v[node] - ((1 - along) * v[begin] + along * v[end]);
      const double nx = list.direction_x[i], ny = list.direction_y[i];  // from the other cell to this one
      list.normal_velocity[i] = du * nx + dv * ny;
      list.tangential_velocity[i] = du * ny - dv * nx;
      list.sliding_speed[i] = std::abs(list.tangential_velocity[i]);
    }
  }
}

}  // namespace rouleau::core
