// What is called otherwise in three dimensions than in two, and the way from their number to templates.
#pragma once

#include <array>
#include <type_traits>

namespace rouleau::scene {

struct DimensionWords {
  const char *number, *lattice, *axes;
  const char *content, *contents, *content_unit, *content_column;         ///< of what a membrane encloses
  double content_in_unit;                                                 ///< of 1 m2 or 1 m3
  const char *segment, *segments, *best_segments, *are_best, *edges_are;  ///< that an outline or a surface consists of
};

/// `dimension`: 2 or 3.
inline const DimensionWords& words_of(int dimension) {
  static constexpr std::array<DimensionWords, 2> words{
      {{"two", "D2Q9", "x and y", "area", "areas", "um2", "area_m2", 1e12, "segment", "segments",
        "about one for each spacing", " is best", "are "},
       {"three", "D3Q19", "x, y and z", "volume", "volumes", "um3", "volume_m3", 1e18, "edge", "triangles",
        "edges of about one spacing", " are best", "edges are "}}};
  return words[static_cast<std::size_t>(dimension - 2)];
}

/// function(std::integral_constant<int, dimension>()), for what has the dimension as a template parameter.
template <class Function>
auto in_dimension(int dimension, Function function) {
  return dimension == 3 ? function(std::integral_constant<int, 3>()) : function(std::integral_constant<int, 2>());
}

}  // namespace rouleau::scene
