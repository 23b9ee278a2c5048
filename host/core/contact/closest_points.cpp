#include "closest_points.hpp"

#include <algorithm>

#include "core/domain/run_loop.hpp"
#include "core/geometry/triangle_distance.hpp"
#include "core/surface/padded_triangles.hpp"

namespace rouleau::core {

namespace {

struct FindTask {
  int count;
  const double *node[3], *place[3];
  const int* corner[3];
  double *weight[3], *away[3], *square;
};

struct FindClosest {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const FindTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const FindTask t = *task;
    for (int k = 0; k < t.count; k += S::size) {
      const auto corner = [&](int c) { return Vectors<S>::gather(t.node, t.corner[c] + k); };
      const ClosestPoint<S> point = closest_point(Vectors<S>::load(t.place, k), corner(0), corner(1), corner(2));
      for (int c = 0; c < 3; ++c) point.weight[c].store(t.weight[c] + k);
      point.away.store(t.away, k);
      dot(point.away, point.away).store(t.square + k);
    }
  }
};

}  // namespace

void ClosestPoints::resize(int count) {
  const auto size = static_cast<std::size_t>(padded(count));
  if (square.size() >= size) return;
  for (auto& numbers : corner) numbers.resize(size);
  for (auto* vectors : {&place, &weight, &away})
    for (auto& numbers : *vectors) numbers.resize(size);
  square.resize(size);
}

void ClosestPoints::find(int count, const std::array<const double*, 3>& nodes) {
  FindTask task{};
  task.count = count, task.square = square.data();
  std::copy(nodes.begin(), nodes.end(), task.node);
  point_into(task.corner, corner), point_into(task.place, place);
  point_into(task.weight, weight), point_into(task.away, away);
  run_loop<FindClosest>(task);
}

}  // namespace rouleau::core
