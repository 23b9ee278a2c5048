// Where the time of a run goes, pass by pass.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rouleau::run {

struct PassCost {
  std::string name;
  double wall_s = 0;
  long calls = 0;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PassCost, name, wall_s, calls)
};
class PassCosts {
 public:
  /// Adds wall-clock time and calls to a pass.
  void add(const std::string& pass, double wall_s, long calls) {
    auto found = std::find_if(passes_.begin(), passes_.end(), [&](const PassCost& cost) { return cost.name == pass; });
    if (found == passes_.end()) found = passes_.insert(found, PassCost{pass, 0, 0});
    found->wall_s += wall_s;
    found->calls += calls;
  }
  /// In the order in which they were first added.
  [[nodiscard]] const std::vector<PassCost>& passes() const { return passes_; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PassCosts, passes_)

 private:
  std::vector<PassCost> passes_;
};

}  // namespace rouleau::run
