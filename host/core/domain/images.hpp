// Which periodic images of two boxes come near each other.
#pragma once

#include <cmath>
#include <compare>

#include "bounding_box.hpp"
#include "domain.hpp"
#include "vec.hpp"

namespace rouleau::core {

/// Bounding box of a set of points.
struct Bounds {
  double x_min, x_max, y_min, y_max;

  /// False for the positions of a simulation that has just blown up (not finite, or absurdly large). The checks of the
  /// run will report them; until then nothing may crash or hang on them.
  [[nodiscard]] bool usable() const {
    const double far = 1e9, large = 1e5;
    return x_min > -far && x_max < far && y_min > -far && y_max < far && x_max - x_min < large && y_max - y_min < large;
  }
};

/// An image of a cell: shifted by x periods along x, y along y, and in three dimensions z along z.
struct ImageShift {
  int x = 0, y = 0, z = 0;
  // By x, then y, then z. clang-tidy 14 looks for a null pointer here.
  friend auto operator<=>(const ImageShift&, const ImageShift&) = default;  // NOLINT(modernize-use-nullptr)
  [[nodiscard]] ImageShift operator-() const { return {-x, -y, -z}; }
};

/// Calls `visit(ImageShift)` for every image of `b` whose bounds come within `reach` of the bounds of `a`, in a fixed
/// order. Bounds that are not usable() have no images. If it visits a shift for (a, b), it visits the opposite one for
/// (b, a), whatever the rounding: IEEE subtraction and division are symmetric under change of sign.
template <class Visit>
void for_each_image(const Bounds& a, const Bounds& b, double reach, const Domain<2>& domain, Visit visit) {
  if (!a.usable() || !b.usable()) return;
  const auto first = [&](double a_min, double b_max, double period) {
    return static_cast<int>(std::ceil((a_min - b_max - reach) / period));
  };
  const auto last = [&](double a_max, double b_min, double period) {
    return static_cast<int>(std::floor((a_max - b_min + reach) / period));
  };
  int y_first = 0, y_last = 0;
  if (domain.periodic[1]) {
    y_first = first(a.y_min, b.y_max, domain.period(1));
    y_last = last(a.y_max, b.y_min, domain.period(1));
  } else if (!(a.y_max - b.y_min + reach >= 0 && a.y_min - b.y_max - reach <= 0)) {
    return;
  }
  const int x_first = first(a.x_min, b.x_max, domain.period(0)), x_last = last(a.x_max, b.x_min, domain.period(0));
  for (int y = y_first; y <= y_last; ++y) {
    for (int x = x_first; x <= x_last; ++x) visit(ImageShift{x, y, 0});
  }
}

/// Calls visit(ImageShift) for every image of `b` that comes within `reach` of box `a`, in a fixed order. Boxes that are
/// not usable() have no images. If it visits a shift for (a, b), it visits the opposite one for (b, a), whatever the
/// rounding: IEEE subtraction and division are symmetric under change of sign.
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
