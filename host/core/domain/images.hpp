// Which periodic images of two boxes come near each other.
#pragma once

#include <cmath>
#include <compare>

#include "bounding_box.hpp"
#include "vec.hpp"

namespace rouleau::core {

/// An image of a cell: shifted by x periods along x, y along y, and in three dimensions z along z.
struct ImageShift {
  int x = 0, y = 0, z = 0;
  // By x, then y, then z. clang-tidy 14 looks for a null pointer here.
  friend auto operator<=>(const ImageShift&, const ImageShift&) = default;  // NOLINT(modernize-use-nullptr)
  [[nodiscard]] ImageShift operator-() const { return {-x, -y, -z}; }
};

/// Calls visit(ImageShift) for every image of `b` that comes within `reach` of box `a`, in a fixed order. Boxes that
/// are not usable() have no images. If it visits a shift for (a, b), it visits the opposite one for (b, a), whatever
/// the rounding: IEEE subtraction and division are symmetric under change of sign.
template <int D, class Visit>
void for_each_image(const BoundingBox<D>& a, const BoundingBox<D>& b, double reach, const Domain<D>& domain,
                    Visit visit) {
  if (!a.usable() || !b.usable()) return;
  std::array<int, 3> first{}, last{};
  for (int k = 0; k < D; ++k) {
    const double low = a.least[k] - b.most[k] - reach, high = a.most[k] - b.least[k] + reach;
    if (domain.periodic[k]) {
      first[k] = static_cast<int>(std::ceil(low / domain.period(k)));
      last[k] = static_cast<int>(std::floor(high / domain.period(k)));
    } else if (low > 0 || high < 0) {
      return;
    }
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) visit(ImageShift{x, y, z});
    }
  }
}

/// By so much an image lies beside what it is an image of.
template <int D>
Vec<D> moved_by(const ImageShift& shift, const Domain<D>& domain) {
  const int periods[] = {shift.x, shift.y, shift.z};
  Vec<D> move;
  for (int k = 0; k < D; ++k) move[k] = periods[k] * domain.period(k);
  return move;
}

}  // namespace rouleau::core
