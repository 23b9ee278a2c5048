#include "parts.hpp"

#include <algorithm>

namespace rouleau::core {

template <int D>
double content_of(const Region<D>& region, const Vec<D>& middle, const Vec<D>& half, int halvings) {
  const Distance<D> found = region.distance(middle);
  const double whole = (2 * half).prod(), reach = half.norm();
  if (found.value <= -reach) return 0;
  if (found.value >= reach) return whole;
  if (halvings == 0) {
    const double across = half.dot(found.gradient.cwiseAbs());
    return whole * std::clamp(0.5 + found.value / (2 * across), 0.0, 1.0);
  }
  int longest = 0;
  half.maxCoeff(&longest);
  Vec<D> part = half, away = Vec<D>::Zero();
  away[longest] = part[longest] /= 2;
  return content_of<D>(region, middle - away, part, halvings - 1) +
         content_of<D>(region, middle + away, part, halvings - 1);
}
template double content_of(const Region<2>&, const Vec<2>&, const Vec<2>&, int);
template double content_of(const Region<3>&, const Vec<3>&, const Vec<3>&, int);

template <int D>
std::vector<Vec<D>> pieces_outside(const Region<D>& region, const Domain<D>& domain) {
  const auto place_of = [&](long number) {
    Vec<D> place;
    for (int k = 0; k < D; number /= domain.size[k++]) place[k] = static_cast<double>(number % domain.size[k]);
    return place;
  };
  std::vector<bool> waits;  // nodes outside that no piece has yet
  for (long i = 0; i < domain.nodes(); ++i) waits.push_back(region.distance(place_of(i)).value <= 0);
  std::vector<Vec<D>> pieces;
  std::vector<long> next;
  for (long first = 0; first < domain.nodes(); ++first) {
    if (!waits[first]) continue;
    waits[first] = false;
    double least = 1;
    for (next = {first}; !next.empty();) {
      const long here = next.back();
      next.pop_back();
      const Vec<D> place = place_of(here);
      const double distance = region.distance(place).value;
      if (least > 0) pieces.push_back(place);
      if (distance < least) least = distance, pieces.back() = place;
      long stride = 1;
      for (int k = 0; k < D; stride *= domain.size[k++]) {
        const int at = static_cast<int>(place[k]);
        for (const int beside : {at - 1, at + 1}) {
          const int node = domain.wrapped(k, beside);
          const long number = here + (node - at) * stride;
          if (node < 0 || !waits[number]) continue;
          waits[number] = false;
          next.push_back(number);
        }
      }
    }
  }
  return pieces;
}
template std::vector<Vec<2>> pieces_outside(const Region<2>&, const Domain<2>&);
template std::vector<Vec<3>> pieces_outside(const Region<3>&, const Domain<3>&);

}  // namespace rouleau::core
