// Which nodes of the lattice feel a membrane: one bit for 16 nodes, merged into runs.
#pragma once

#include <cstdint>
#include <vector>

namespace rouleau::host {

/// Consecutive nodes [begin, end) of a row that are all active or all not.
struct Run {
  int begin, end;
  bool active;
};

/// Active nodes carry force, velocity and relaxation rate; the others are collided without.
class Activity {
 public:
  static constexpr int nodes_per_bit = 16;

  Activity() = default;
  /// Nothing is active.
  Activity(int nx, int ny);

  /// Takes the marks of rows [first_row, end_row) away.
  void clear(int first_row, int end_row);
  /// Marks the nodes [begin, end) of a row; the columns are taken periodically, rows outside [0, ny) are left out.
  void mark(int y, int begin, int end);
  /// Merges equal neighbours in rows [first_row, end_row) into runs; to be called after the last mark and before
  /// runs().
  void rebuild_runs(int first_row, int end_row);
  void rebuild_runs() { rebuild_runs(0, ny_); }

  /// Runs of row y, left to right, covering [0, nx) exactly.
  [[nodiscard]] const std::vector<Run>& runs(int y) const { return runs_[static_cast<std::size_t>(y)]; }
  [[nodiscard]] bool active(int x, int y) const;
  /// Whether row y has an active run; whether its first or last run is one.
  [[nodiscard]] bool any(int y) const { return runs(y).size() > 1 || runs(y).front().active; }
  [[nodiscard]] bool at_side(int y) const { return runs(y).front().active || runs(y).back().active; }
  [[nodiscard]] double active_fraction() const;

 private:
  int nx_ = 0, ny_ = 0, words_ = 0;
  std::vector<std::uint64_t> bits_;
  std::vector<std::vector<Run>> runs_;
};

}  // namespace rouleau::host
