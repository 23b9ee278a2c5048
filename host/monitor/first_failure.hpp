// Ranks agree on which of their failures the run fails with.
#pragma once

#include <array>
#include <optional>

#include "core/domain/ranks.hpp"
#include "failure.hpp"

namespace rouleau::monitor {

/// The failure that one rank would have found first: the one with the least `order`, numbers compared one after
/// another. On all ranks, which ask together; none: no rank has found any. No two ranks' failures have the same order.
template <int D>
std::optional<Failure> first_failure(const core::Ranks<D>& ranks, std::optional<Failure> mine,
                                     std::array<double, 2> order);

}  // namespace rouleau::monitor
