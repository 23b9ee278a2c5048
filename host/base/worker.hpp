// One thread's share of a pass: all threads run the same pass and each works on its own range.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace rouleau {

struct Range {
  int begin, end;
};

/// Who is calling: thread `index` of `count`. Results never depend on `count`.
struct Worker {
  int index = 0;
  int count = 1;

  /// This worker's part of [0, n) in units of `grain`; the parts of all workers are disjoint and cover it.
  [[nodiscard]] Range share(int n, int grain = 1) const {
    const long long grains = (n + grain - 1) / grain;
    const auto bound = [&](long long i) {
      return static_cast<int>(std::min<long long>(n, grains * i / count * grain));
    };
    return {bound(index), bound(index + 1)};
  }
  [[nodiscard]] bool first() const { return index == 0; }
  [[nodiscard]] bool last() const { return index == count - 1; }
};

/// Working memory of each worker, made when it is first asked for. However many workers there are, no two have the same
/// first item.
template <class T>
class WorkerScratch {
 public:
  explicit WorkerScratch(std::size_t items) : made_(items) {}
  /// That of the worker whose share of the items begins here.
  [[nodiscard]] T& of(int first) {
    std::unique_ptr<T>& own = made_[static_cast<std::size_t>(first)];
    if (!own) own = std::make_unique<T>();
    return *own;
  }

 private:
  std::vector<std::unique_ptr<T>> made_;
};

}  // namespace rouleau
