// Ranks that are threads of one process.
#pragma once

#include <exception>
#include <thread>
#include <vector>

#include "core/domain/ranks.hpp"

namespace rouleau::test {

/// Calls function(ranks) for every rank of a cut, each in a thread of its own. Throws what the first rank that has
/// thrown anything but RankLost has thrown.
template <int D, class Function>
void on_all_ranks(const core::Decomposition<D>& blocks, Function function) {
  const auto ends = core::make_loopback(blocks.ranks());
  std::vector<std::exception_ptr> thrown(ends.size());
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < ends.size(); ++rank) {
    threads.emplace_back([&, rank] {
      try {
        function(core::Ranks<D>{&blocks, ends[rank].get()});
      } catch (const core::RankLost&) {
        // The rank that was lost says why.
      } catch (...) {
        thrown[rank] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

}  // namespace rouleau::test
