// Which places are asked for their distance: all that are near a border, and few others.
#include "core/geometry/near_border.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/geometry/formulas.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// Counts who asks.
template <int D>
class Counting final : public Region<D> {
 public:
  explicit Counting(RegionPointer<D> region) : region_(std::move(region)) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    ++asked;
    return region_->distance(place);
  }
  mutable int asked = 0;

 private:
  RegionPointer<D> region_;
};

template <int D>
void check(const Domain<D>& domain, const RegionPointer<D>& region, double reach, double share) {
  const auto counting = std::make_shared<const Counting<D>>(region);
  const NearBorder<D> border(counting, domain, reach);
  auto random = generator(405);
  std::uniform_real_distribution<double> any(0, 1);
  constexpr int places = 20000;
  counting->asked = 0;
  int near = 0;
  for (int i = 0; i < places; ++i) {
    Vec<D> at, image;
    for (int k = 0; k < D; ++k) {
      at[k] = any(random) * domain.size[k] - (domain.walled(k) ? 0.5 : 0);
      image[k] = at[k] + (domain.walled(k) ? 0 : 1024 * domain.size[k]);
    }
    const Distance<D> exact = region->distance(at);
    const auto found = border.at(at), of_image = border.at(image);
    if (exact.value <= reach) REQUIRE(found);
    if (!found) continue;
    ++near;
    REQUIRE(found->value == exact.value);
    REQUIRE(found->gradient == exact.gradient);
    if (exact.value <= reach - 1e-9) REQUIRE(of_image);
    if (of_image) CHECK(of_image->value == Approx(exact.value).margin(1e-9));
  }
  CHECK(near < share * places);
  CHECK(near > 0);
  CHECK(counting->asked < 2.1 * share * places);
}

}  // namespace

TEST_CASE("a place far from all walls is not asked for its distance, and every other one gets its own") {
  check<2>({{60, 50}, {true, true}}, outside_of(ball_region<2>({30, 24}, 9)), 1.7, 0.3);
  check<2>({{60, 51}, {true, false}}, ball_region<2>({30, 25}, 24), 0, 0.6);
  check<3>({{40, 31, 36}, {true, true, true}}, outside_of(ball_region<3>({20, 17, 16}, 9)), 2.3, 0.4);
  const Domain<3> between({40, 31, 36}, {true, false, true});
  check<3>(between,
           intersection<3>(
               {outside_of(extruded(ball_region<2>({20, 15}, 4), 2, -INFINITY, INFINITY)), between_walls(between)}),
           1, 0.5);
}

TEST_CASE("a place that is no number, or far outside, is near no border or gets its distance") {
  const Domain<2> domain({30, 20}, {true, false});
  const NearBorder<2> border(intersection<2>({outside_of(ball_region<2>({15, 9}, 4)), between_walls(domain)}), domain,
                             1);
  CHECK_FALSE(border.at({NAN, 3}));
  CHECK_FALSE(border.at({3, NAN}));
  CHECK_FALSE(border.at({INFINITY, 3}));
  CHECK_FALSE(border.at({1e300, 3}));
  REQUIRE(border.at({3, -50.0}));
  CHECK(border.at({3, -50.0})->value == Approx(-49.5));
  CHECK(border.at({3, 5e8})->value == Approx(19.5 - 5e8));
}
