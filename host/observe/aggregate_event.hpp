// A change in who is close to whom.
#pragma once

#include <array>
#include <vector>

#include "json/json.hpp"

namespace rouleau::observe {

struct AggregateEvent {
  double strain, time;
  int count;
  std::vector<std::vector<int>> members;  ///< empty: not kept
  bool through_image;
  std::vector<std::vector<int>> joined = {};  ///< by attracting contacts alone; empty: as members, or nothing attracts
  std::vector<std::array<int, 2>> met_images = {};  ///< attracting pairs that left each other and met by another image
  [[nodiscard]] const std::vector<std::vector<int>>& together() const { return joined.empty() ? members : joined; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateEvent, strain, time, count, members, through_image, joined, met_images)
};

}  // namespace rouleau::observe
