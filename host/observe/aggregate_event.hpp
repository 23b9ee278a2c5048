// A change in who is aggregated with whom.
#pragma once

#include <vector>

#include "json/json.hpp"

namespace rouleau::observe {

struct AggregateEvent {
  double strain, time;
  int count;
  std::vector<std::vector<int>> members;  ///< empty: not kept
  bool through_image;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateEvent, strain, time, count, members, through_image)
};

}  // namespace rouleau::observe
