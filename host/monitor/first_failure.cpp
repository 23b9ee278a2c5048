#include "first_failure.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "json/json.hpp"

namespace rouleau::monitor {

namespace {

/// What a check says of a failure; mode and time come later. CBOR holds every number to its last bit.
std::vector<std::uint8_t> packed(const Failure& f) {
  const std::vector<double> place(f.place.begin(), f.place.end());
  return nlohmann::json::to_cbor({f.reason, place, f.cell, f.value, f.limit, f.message, f.remedy});
}

Failure unpacked(const std::vector<std::uint8_t>& bytes) {
  const nlohmann::json text = nlohmann::json::from_cbor(bytes);
  Failure f;
  f.reason = text.at(0), f.cell = text.at(2), f.value = text.at(3), f.limit = text.at(4);
  f.message = text.at(5), f.remedy = text.at(6);
  const std::vector<double> place = text.at(1);
  f.place = scene::Vector::filled(static_cast<int>(place.size()), 0);
  std::copy(place.begin(), place.end(), f.place.begin());
  return f;
}

}  // namespace

template <int D>
std::optional<Failure> first_failure(const core::Ranks<D>& ranks, std::optional<Failure> mine,
                                     std::array<double, 2> order) {
  if (!ranks.several()) return mine;
  struct Found {
    bool any;
    std::array<double, 2> order;
    int rank;
  };
  const Found first =
      core::best_of_all(ranks, Found{mine.has_value(), order, ranks.transport->rank()},
                        [](const Found& a, const Found& b) { return a.any && (!b.any || a.order < b.order); });
  if (!first.any) return std::nullopt;
  return unpacked(core::of_rank(ranks, first.rank, mine ? packed(*mine) : std::vector<std::uint8_t>{}));
}

template std::optional<Failure> first_failure(const core::Ranks<2>&, std::optional<Failure>, std::array<double, 2>);
template std::optional<Failure> first_failure(const core::Ranks<3>&, std::optional<Failure>, std::array<double, 2>);

}  // namespace rouleau::monitor
