// Where in a domain the border of a region is near.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/domain/domain.hpp"
#include "region.hpp"

namespace rouleau::core {

/// Asks a region for its distance where that may be at most `reach` alone: boxes of the domain know where it is not, so
/// that a place far from all walls costs one look.
template <int D>
class NearBorder {
 public:
  NearBorder(RegionPointer<D> region, const Domain<D>& domain, double reach);

  /// The region's distance at a place or its image in the domain; none where it is larger than `reach` for certain, or
  /// where the place is no number.
  [[nodiscard]] std::optional<Distance<D>> at(Vec<D> place) const;

 private:
  static constexpr double edge = 2;  ///< of a box, spacings
  /// Marks, of so many boxes along every axis from `first` on, those that the border may be near.
  void mark(const std::array<int, D>& first, int boxes);
  [[nodiscard]] std::size_t number(const std::array<int, D>& box) const;

  RegionPointer<D> region_;
  Domain<D> domain_;
  double reach_;
  std::array<int, D> count_;  ///< of boxes along each axis; the first begins one spacing before the first node
  std::vector<bool> near_;
};

extern template class NearBorder<2>;
extern template class NearBorder<3>;

}  // namespace rouleau::core
