// One thread's share of a pass: all threads run the same pass and each works on its own range.
#pragma once

#include <algorithm>

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

}  // namespace rouleau
