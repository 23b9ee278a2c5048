#include "formulas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rouleau::core {

namespace {

template <int D>
class BoxRegion final : public Region<D> {
 public:
  BoxRegion(const Vec<D>& lower, const Vec<D>& upper) : lower_(lower), upper_(upper) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    Vec<D> outward = Vec<D>::Zero();  // from the box to a place outside
    Distance<D> inside{std::numeric_limits<double>::infinity(), Vec<D>::Zero()};
    for (int k = 0; k < D; ++k) {
      const double above = place[k] - lower_[k], below = upper_[k] - place[k];
      const double least = std::min(above, below), sign = above < below ? 1 : -1;
      if (least < 0) outward[k] = sign * least;
      if (least < inside.value) inside.value = least, inside.gradient = sign * Vec<D>::Unit(k);
    }
    const double away = outward.norm();
    return away > 0 ? Distance<D>{-away, -outward / away} : inside;
  }

 private:
  Vec<D> lower_, upper_;
};

template <int D>
class BallRegion final : public Region<D> {
 public:
  BallRegion(const Vec<D>& center, double radius) : center_(center), radius_(radius) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    const Vec<D> inward = center_ - place;
    const double from_center = inward.norm();
    return {radius_ - from_center, from_center > 0 ? Vec<D>(inward / from_center) : Vec<D>(Vec<D>::Unit(0))};
  }
  /// Where |place + share by - center| = radius.
  [[nodiscard]] double share_inside(const Vec<D>& place, const Vec<D>& by) const override {
    const Vec<D> from = place - center_;
    const double a = by.squaredNorm(), b = by.dot(from), c = from.squaredNorm() - radius_ * radius_;
    return std::clamp((std::sqrt(b * b - a * c) - b) / a, 0.0, 1.0);
  }

 private:
  Vec<D> center_;
  double radius_;
};

class Extruded final : public Region<3> {
 public:
  Extruded(RegionPointer<2> section, int axis, double from, double to)
      : section_(std::move(section)),
        axis_(axis),
        first_(axis == 0 ? 1 : 0),
        second_(axis == 2 ? 1 : 2),
        from_(from),
        to_(to) {}
  [[nodiscard]] Distance<3> distance(const Vec<3>& place) const override {
    const Distance<2> across = section_->distance(in_section(place));
    const double above = place[axis_] - from_, below = to_ - place[axis_], along = std::min(above, below);
    Vec<3> of_section = Vec<3>::Zero(), of_ends = (above < below ? 1 : -1) * Vec<3>::Unit(axis_);
    of_section[first_] = across.gradient[0], of_section[second_] = across.gradient[1];
    if (across.value < 0 && along < 0) {
      const double away = std::hypot(across.value, along);
      return {-away, (-across.value * of_section - along * of_ends) / away};
    }
    return across.value < along ? Distance<3>{across.value, of_section} : Distance<3>{along, of_ends};
  }
  [[nodiscard]] double share_inside(const Vec<3>& place, const Vec<3>& by) const override {
    if (std::isfinite(from_) || std::isfinite(to_)) return Region::share_inside(place, by);
    return section_->share_inside(in_section(place), in_section(by));
  }

 private:
  [[nodiscard]] Vec<2> in_section(const Vec<3>& vector) const { return {vector[first_], vector[second_]}; }

  RegionPointer<2> section_;
  int axis_, first_, second_;  ///< along it, and across
  double from_, to_;
};

}  // namespace

template <int D>
RegionPointer<D> box_region(const Vec<D>& lower, const Vec<D>& upper) {
  return std::make_shared<BoxRegion<D>>(lower, upper);
}

template <int D>
RegionPointer<D> between_walls(const Domain<D>& domain) {
  Vec<D> lower = Vec<D>::Constant(-std::numeric_limits<double>::infinity()), upper = -lower;
  for (int k = 0; k < D; ++k)
    if (domain.walled(k)) lower[k] = -0.5, upper[k] = domain.size[k] - 0.5;
  return box_region<D>(lower, upper);
}

template <int D>
RegionPointer<D> ball_region(const Vec<D>& center, double radius) {
  return std::make_shared<BallRegion<D>>(center, radius);
}

RegionPointer<3> extruded(RegionPointer<2> section, int axis, double from, double to) {
  return std::make_shared<Extruded>(std::move(section), axis, from, to);
}

template RegionPointer<2> box_region(const Vec<2>&, const Vec<2>&);
template RegionPointer<3> box_region(const Vec<3>&, const Vec<3>&);
template RegionPointer<2> between_walls(const Domain<2>&);
template RegionPointer<3> between_walls(const Domain<3>&);
template RegionPointer<2> ball_region(const Vec<2>&, double);
template RegionPointer<3> ball_region(const Vec<3>&, double);

}  // namespace rouleau::core
