#include "rheology.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/flow_rate.hpp"
#include "core/fluid/relaxation.hpp"

namespace rouleau::observe {

bool is_driven_channel(const plan::StageSetting& setting, const scene::Scene& scene) {
  return setting.largest_body_force_x() != 0 && setting.fastest_wall() == 0 && !scene.domain.periodic_y;
}

template <class T, class Set>
double flow_rate(const core::Fluid<T, Set>& fluid) {
  const core::Domain<Set::dimension>& domain = fluid.setting().domain;
  const double rate =
      core::flow_rate(fluid.row_velocities(), fluid.walls_now(), domain, fluid.setting().solid != nullptr);
  if constexpr (Set::dimension == 3) return rate / domain.size[2];
  return rate;
}

template double flow_rate(const core::Fluid<float>&);
template double flow_rate(const core::Fluid<double>&);
template double flow_rate(const core::Fluid<float, core::D3Q19>&);
template double flow_rate(const core::Fluid<double, core::D3Q19>&);

double apparent_viscosity(double flow_rate, double body_force, const plan::StageSetting& setting, int height) {
  const double viscosity = core::viscosity_of(setting.tau);
  const double alone = body_force * std::pow(height, 3) / (12 * viscosity);
  return flow_rate != 0 ? alone / flow_rate : std::nan("");
}

CellFreeLayer cell_free_layer(const core::Membranes& membranes, const core::Domain<2>& domain,
                              const core::Ranks<2>& ranks) {
  const int nx = domain.size[0], ny = domain.size[1];
  const double half = ny / 2.0, lower_wall = -0.5, upper_wall = ny - 0.5;
  std::vector<CellFreeLayer> columns(static_cast<std::size_t>(nx), CellFreeLayer{half, half});
  const auto narrow = [](CellFreeLayer& column, const CellFreeLayer& by) {
    column.lower = std::min(column.lower, by.lower);
    column.upper = std::min(column.upper, by.upper);
  };
  for (const int c : membranes.own_cells()) {
    const core::CellRange& cell = membranes.cells[c];
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(cell.next(i));
      const double x0 = membranes.x[from], x1 = membranes.x[to], y0 = membranes.y[from], y1 = membranes.y[to];
      const double left = std::min(x0, x1), right = std::max(x0, x1);
      // The last state of a run that blew up may hold anything.
      if (!(right - left < nx && std::abs(left) < 1e9)) continue;
      for (double x = std::ceil(left); x <= right; ++x) {
        const double y = x1 != x0 ? y0 + (y1 - y0) * (x - x0) / (x1 - x0) : y0;
        const auto column = static_cast<std::size_t>(domain.wrapped(0, static_cast<int>(x)));
        narrow(columns[column],
               {std::min(y, x1 != x0 ? y : y1) - lower_wall, upper_wall - std::max(y, x1 != x0 ? y : y1)});
      }
    }
  }
  core::join(ranks, columns, narrow);
  CellFreeLayer mean{0, 0};
  for (const CellFreeLayer& column : columns) mean.lower += column.lower / nx, mean.upper += column.upper / nx;
  return mean;
}

std::map<int, int> aggregate_sizes(const std::vector<int>& label) {
  std::map<int, int> members, sizes;
  for (const int l : label) ++members[l];
  for (const auto& [l, size] : members) ++sizes[size];
  return sizes;
}

double number_mean(const std::map<int, int>& sizes) {
  double cells = 0, aggregates = 0;
  for (const auto& [size, count] : sizes) {
    cells += static_cast<double>(size) * count;
    aggregates += count;
  }
  return cells / aggregates;
}

double weight_mean(const std::map<int, int>& sizes) {
  double cells = 0, squares = 0;
  for (const auto& [size, count] : sizes) {
    cells += static_cast<double>(size) * count;
    squares += static_cast<double>(size) * size * count;
  }
  return squares / cells;
}

}  // namespace rouleau::observe
