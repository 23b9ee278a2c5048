#include "region.hpp"

#include <cmath>
#include <utility>

namespace rouleau::core {

template <int D>
double Region<D>::share_inside(const Vec<D>& place, const Vec<D>& by) const {
  constexpr double exact = 1e-14;
  constexpr int most_tries = 100;
  double inside = 0, outside = 1, at_inside = distance(place).value, at_outside = distance(place + by).value;
  // Regula falsi of Illinois type: distances are nearly linear along a link.
  for (int i = 0, side = 0; i < most_tries && outside - inside > exact && at_outside < 0; ++i) {
    const double share = inside + (outside - inside) * at_inside / (at_inside - at_outside);
    const double value = distance(place + share * by).value;
    if (value > 0) {
      inside = share, at_inside = value;
      if (side == 1) at_outside /= 2;
      side = 1;
    } else {
      outside = share, at_outside = value;
      if (side == -1) at_inside /= 2;
      side = -1;
    }
  }
  return outside;
}

namespace {

template <int D>
class Moving final : public Region<D> {
 public:
  Moving(RegionPointer<D> region, const BorderMotion<D>& motion) : region_(std::move(region)), motion_(motion) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override { return region_->distance(place); }
  [[nodiscard]] double share_inside(const Vec<D>& place, const Vec<D>& by) const override {
    return region_->share_inside(place, by);
  }
  [[nodiscard]] Vec<D> velocity(const Vec<D>& place) const override {
    return motion_.velocity + motion_.spin * (place - motion_.center);
  }

 private:
  RegionPointer<D> region_;
  BorderMotion<D> motion_;
};

template <int D>
class Outside final : public Region<D> {
 public:
  explicit Outside(RegionPointer<D> region) : region_(std::move(region)) {}
  [[nodiscard]] Vec<D> velocity(const Vec<D>& place) const override { return region_->velocity(place); }
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    const Distance<D> inside = region_->distance(place);
    return {-inside.value, -inside.gradient};
  }

 private:
  RegionPointer<D> region_;
};

/// Of several regions the least distance (intersection), or the largest (union).
template <int D>
class Joined final : public Region<D> {
 public:
  Joined(std::vector<RegionPointer<D>> regions, bool least) : regions_(std::move(regions)), least_(least) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override { return choose(place).second; }
  [[nodiscard]] Vec<D> velocity(const Vec<D>& place) const override {
    return regions_[choose(place).first]->velocity(place);
  }

 private:
  [[nodiscard]] std::pair<std::size_t, Distance<D>> choose(const Vec<D>& place) const {
    std::pair<std::size_t, Distance<D>> chosen{0, regions_.front()->distance(place)};
    for (std::size_t i = 1; i < regions_.size(); ++i) {
      const Distance<D> other = regions_[i]->distance(place);
      if (least_ ? other.value < chosen.second.value : other.value > chosen.second.value) chosen = {i, other};
    }
    return chosen;
  }

  std::vector<RegionPointer<D>> regions_;
  bool least_;
};

template <int D>
class Magnified final : public Region<D> {
 public:
  Magnified(RegionPointer<D> region, double scale, const Vec<D>& shift)
      : region_(std::move(region)), scale_(scale), shift_(shift) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    const Distance<D> found = region_->distance((place - shift_) / scale_);
    return {scale_ * found.value, found.gradient};
  }
  [[nodiscard]] double share_inside(const Vec<D>& place, const Vec<D>& by) const override {
    return region_->share_inside((place - shift_) / scale_, by / scale_);
  }
  [[nodiscard]] Vec<D> velocity(const Vec<D>& place) const override {
    return scale_ * region_->velocity((place - shift_) / scale_);
  }

 private:
  RegionPointer<D> region_;
  double scale_;
  Vec<D> shift_;
};

template <int D>
class Repeated final : public Region<D> {
 public:
  Repeated(RegionPointer<D> region, const Vec<D>& middle, const Domain<D>& domain)
      : region_(std::move(region)), middle_(middle), domain_(domain) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override { return region_->distance(near(place)); }
  [[nodiscard]] Vec<D> velocity(const Vec<D>& place) const override { return region_->velocity(near(place)); }

 private:
  [[nodiscard]] Vec<D> near(const Vec<D>& place) const {
    Vec<D> near = place;
    for (int k = 0; k < D; ++k) {
      const double period = domain_.period(k);
      if (period > 0) near[k] -= period * std::round((place[k] - middle_[k]) / period);
    }
    return near;
  }

  RegionPointer<D> region_;
  Vec<D> middle_;
  Domain<D> domain_;
};

}  // namespace

template <int D>
RegionPointer<D> moving(RegionPointer<D> region, const BorderMotion<D>& motion) {
  return motion.any() ? std::make_shared<Moving<D>>(std::move(region), motion) : std::move(region);
}

template <int D>
RegionPointer<D> outside_of(RegionPointer<D> region) {
  return std::make_shared<Outside<D>>(std::move(region));
}

template <int D>
RegionPointer<D> intersection(std::vector<RegionPointer<D>> regions) {
  if (regions.size() == 1) return std::move(regions.front());
  return std::make_shared<Joined<D>>(std::move(regions), true);
}

template <int D>
RegionPointer<D> union_of(std::vector<RegionPointer<D>> regions) {
  if (regions.size() == 1) return std::move(regions.front());
  return std::make_shared<Joined<D>>(std::move(regions), false);
}

template <int D>
RegionPointer<D> magnified(RegionPointer<D> region, double scale, const Vec<D>& shift) {
  return std::make_shared<Magnified<D>>(std::move(region), scale, shift);
}

template <int D>
RegionPointer<D> repeated(RegionPointer<D> region, const Vec<D>& middle, const Domain<D>& domain) {
  return std::make_shared<Repeated<D>>(std::move(region), middle, domain);
}

template class Region<2>;
template class Region<3>;
template RegionPointer<2> moving(RegionPointer<2>, const BorderMotion<2>&);
template RegionPointer<3> moving(RegionPointer<3>, const BorderMotion<3>&);
template RegionPointer<2> outside_of(RegionPointer<2>);
template RegionPointer<3> outside_of(RegionPointer<3>);
template RegionPointer<2> intersection(std::vector<RegionPointer<2>>);
template RegionPointer<3> intersection(std::vector<RegionPointer<3>>);
template RegionPointer<2> union_of(std::vector<RegionPointer<2>>);
template RegionPointer<3> union_of(std::vector<RegionPointer<3>>);
template RegionPointer<2> magnified(RegionPointer<2>, double, const Vec<2>&);
template RegionPointer<3> magnified(RegionPointer<3>, double, const Vec<3>&);
template RegionPointer<2> repeated(RegionPointer<2>, const Vec<2>&, const Domain<2>&);
template RegionPointer<3> repeated(RegionPointer<3>, const Vec<3>&, const Domain<3>&);

}  // namespace rouleau::core
