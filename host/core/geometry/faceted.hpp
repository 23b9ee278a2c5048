// Regions inside of polygons, or of surfaces of triangles.
#pragma once

#include <array>
#include <vector>

#include "border.hpp"
#include "facet_tree.hpp"
#include "region.hpp"

namespace rouleau::core {

/// What a border encloses. The sign is that of the angle-weighted normal where the border is nearest (Baerentzen and
/// Aanaes, IEEE Trans. Vis. Comput. Graph. 11, 243, 2005).
template <int D>
class FacetedRegion final : public Region<D> {
 public:
  using Facet = std::array<int, D>;
  /// Where the border is not closed, the region goes on along its last facets. Throws std::invalid_argument for a facet
  /// without size, or none.
  explicit FacetedRegion(Border<D> border);

  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override;

 private:
  struct Nearest;
  [[nodiscard]] Nearest nearest_of(const Facet& facet, const Vec<D>& place) const;
  void add_normals();

  Border<D> border_;
  std::vector<Vec<D>> normals_;         ///< of facets, outward
  std::vector<Vec<D>> corner_normals_;  ///< of corners
  std::vector<std::array<Vec<D>, D>>
      edge_normals_;  ///< of a triangle's edges, by the corner across; empty in the plane
  FacetTree<D> tree_;
};

}  // namespace rouleau::core
