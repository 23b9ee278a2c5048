// Whether a suspension rests, and whether what flows through it is in equilibrium.
#pragma once

#include <cmath>
#include <vector>

#include "core/membrane/displacement_watch.hpp"
#include "core/solver/in_order.hpp"
#include "json/json.hpp"

namespace rouleau::monitor {

/// Compares the energy at the end of a window with that at its start; windows follow one another. All energies in one
/// unit, times in steps.
class EquilibriumWatch {
 public:
  /// Nothing is known yet.
  void start() { *this = {}; }
  /// First step at which the energy is wanted again.
  [[nodiscard]] long next(long window) const { return known_ ? step_ + window : 0; }
  /// `magnitude`: what the energy's change is compared with; `least_rate`: its relative change in a step below which
  /// there is an equilibrium.
  void note(long step, double energy, double magnitude, double least_rate) {
    if (known_) {
      const double change = std::abs(energy - energy_);
      reached_ = change <= least_rate * static_cast<double>(step - step_) * magnitude;
    }
    known_ = true;
    step_ = step;
    energy_ = energy;
  }
  [[nodiscard]] bool reached() const { return reached_; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(EquilibriumWatch, step_, known_, reached_, energy_)

 private:
  long step_ = 0;
  bool known_ = false, reached_ = false;
  double energy_ = 0;
};

/// Compares positions with those at the start of the window; windows follow one another. All ranks call it together;
/// the first one remembers where all nodes were.
class RestWatch {
 public:
  /// Nobody asks about rest.
  void stop() { *this = {}; }
  /// A window begins. `ghosts`: whose the cells are; null: this rank's.
  template <int D>
  void start(long step, const core::CellNodes& cells, const core::GhostCells<D>* ghosts) {
    step_ = step;
    old_ = {};
    for_places(cells, ghosts, [this](Range, const core::CellNodes& some) {
      old_.x.insert(old_.x.end(), some.position[0].begin(), some.position[0].end());
      old_.y.insert(old_.y.end(), some.position[1].begin(), some.position[1].end());
      old_.z.insert(old_.z.end(), some.position[2].begin(), some.position[2].end());
    });
  }
  /// First step at which a window of so many steps has ended.
  [[nodiscard]] long end(long window) const { return step_ + window; }
  /// Largest distance that a node has moved since the window began, spacings; on the first rank.
  template <int D>
  [[nodiscard]] double moved(const core::CellNodes& cells, const core::GhostCells<D>* ghosts) const {
    double most = 0;
    for_places(cells, ghosts, [&](Range nodes, const core::CellNodes& some) {
      const double here =
          core::largest_displacement(some, {&old_.x[nodes.begin], &old_.y[nodes.begin], old_.z.data() + nodes.begin},
                                     {0, nodes.end - nodes.begin});
      if (!(here <= most) && !std::isnan(most)) most = here;
    });
    return most;
  }
  /// Whether it can be asked about these cells, if anybody does.
  [[nodiscard]] bool fits(const core::CellNodes& cells, bool asked) const {
    const auto fit = [&](const std::vector<double>& old, const std::vector<double>& now) {
      return old.size() == now.size() || (!asked && old.empty());
    };
    return step_ >= 0 && fit(old_.x, cells.position[0]) && fit(old_.y, cells.position[1]) &&
           fit(old_.z, cells.position[2]);
  }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RestWatch, step_, old_)

 private:
  /// Calls function(nodes, places of these) on the first rank for some nodes of all cells after others. Of a cell that
  /// is not there all lie in the far corner `nowhere`, so that one that comes or leaves moves.
  template <int D, class Function>
  static void for_places(const core::CellNodes& cells, const core::GhostCells<D>* ghosts, Function function) {
    constexpr double nowhere = -1e9;
    const auto add = [&](int cell, std::vector<double>& values) {
      if (!cells.knows(cell)) return;
      values.push_back(cell);
      for (int i = cells.cells[cell].first; i < cells.cells[cell].end(); ++i) {
        for (int k = 0; k < D; ++k) values.push_back(cells.position[k][i]);
      }
    };
    core::give_in_order<double>(ghosts, cells, add, [&](Range run, const std::vector<double>& values) {
      const Range nodes{cells.cells[run.begin].first, cells.cells[run.end - 1].end()};
      core::CellNodes some;
      for (int k = 0; k < D; ++k) some.position[k].assign(static_cast<std::size_t>(nodes.end - nodes.begin), nowhere);
      for (auto value = values.begin(); value != values.end();) {
        const core::CellRange& cell = cells.cells[static_cast<std::size_t>(*value++)];
        for (int i = cell.first; i < cell.end(); ++i) {
          for (int k = 0; k < D; ++k) some.position[k][i - nodes.begin] = *value++;
        }
      }
      function(nodes, some);
    });
  }
  struct OldPlaces {
    std::vector<double> x, y, z;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(OldPlaces, x, y, z)
  };
  long step_ = 0;
  OldPlaces old_;
};

}  // namespace rouleau::monitor
