#include "threads.hpp"

#include <algorithm>
#include <latch>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "scene/scene.hpp"

namespace rouleau::command {

int processors() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

void check_threads(const char* option, int threads) {
  if (threads >= 1 && threads <= 1024) return;
  throw Error(Cause::bad_input, std::string(option) + " " + std::to_string(threads) +
                                    ": wants a number from 1 to 1024 (this machine has " +
                                    std::to_string(processors()) + " processors)");
}

int useful_threads(const scene::Scene& scene, int threads) {
  const double rows = scene.domain.node_count() / scene.domain.nodes[0];
  return static_cast<int>(std::min<double>(threads, std::max(1.0, rows / 4)));
}

void require_threads(const char* option, int threads) {
  std::latch all_asked(1);
  std::vector<std::jthread> others;
  try {
    for (int k = 1; k < threads; ++k) others.emplace_back([&] { all_asked.wait(); });
  } catch (const std::system_error& error) {
    all_asked.count_down();
    throw Error(Cause::input_output,
                std::string(option) + " " + std::to_string(threads) + ": the system grants no more than " +
                    std::to_string(others.size() + 1) + ": " + error.code().message(),
                {"take fewer, or raise the limit of processes (ulimit -u) or of memory (ulimit -v)"});
  }
  all_asked.count_down();
}

}  // namespace rouleau::command
