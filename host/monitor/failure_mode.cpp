#include "failure_mode.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>
#include <vector>

#include "membrane_wave.hpp"

namespace rouleau::monitor {

namespace {

constexpr int oscillation_window = 8;  // nodes each way

/// Distance from a place to the nearest node of a cell, over all images; infinite without finite nodes.
double distance_to(const core::Membranes& m, const core::CellRange& cell, const std::array<double, 2>& place,
                   const core::Domain<2>& domain) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = cell.first; i < cell.end(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    double dx = m.position[0][k] - place[0], dy = m.position[1][k] - place[1];
    dx -= domain.period(0) * std::round(dx / domain.period(0));
    if (domain.periodic[1]) dy -= domain.period(1) * std::round(dy / domain.period(1));
    nearest = std::fmin(nearest, std::hypot(dx, dy));  // a NaN is farther than anything
  }
  return nearest;
}

struct Neighbourhood {
  int cell = -1;  ///< nearest to the place, if within its neighbourhood
  int rank = 0;   ///< who owns it
  bool contact = false;
};

/// `cell`: what is in question already; -1: nothing.
Neighbourhood find_neighbourhood(int cell, const core::Membranes& m, const std::array<double, 2>& place,
                                 const core::Domain<2>& domain, const core::Ranks<2>& ranks) {
  struct Nearest {
    double distance;
    int cell, rank;
  };
  Nearest nearest{membrane_neighbourhood, -1, ranks.several() ? ranks.transport->rank() : 0};
  std::vector<core::ExactSum> near(1);
  for (const int c : m.own_cells()) {
    const double distance = distance_to(m, m.cells[c], place, domain);
    if (distance < contact_neighbourhood && c != cell) near.front().add(1);
    if (cell < 0 ? distance < nearest.distance : c == cell) nearest.distance = distance, nearest.cell = c;
  }
  nearest = core::best_of_all(ranks, nearest, [](const Nearest& a, const Nearest& b) {
    if (a.cell < 0 || b.cell < 0) return a.cell > b.cell;
    return a.distance != b.distance ? a.distance < b.distance : a.cell < b.cell;
  });
  core::add_up(ranks, near);
  return {nearest.cell, nearest.rank, near.front().value() > (cell < 0 ? 1 : 0)};
}

/// What one rank has found, on all.
FailureMode of_rank(const core::Ranks<2>& ranks, int rank, const FailureMode& mode) {
  const std::vector<double> numbers = core::of_rank(
      ranks, rank, std::vector<double>{mode.wavelength, mode.tangential_share, static_cast<double>(mode.step)});
  return {core::text_of_rank(ranks, rank, mode.name), numbers[0], numbers[1], static_cast<long>(numbers[2])};
}

/// The first prominent wave of the cell, from what was noted of its growth or from its last step.
FailureMode wave_of(int cell, const core::Membranes& m, const GrowthWatch& growth, long step) {
  FailureMode mode;
  const auto read = [&mode](const MembraneWave& wave, long at) {
    if (!(wave.prominence >= prominent)) return false;
    mode.wavelength = wave.wavelength;
    mode.tangential_share = wave.tangential_share;
    mode.step = at;
    const char* direction = wave.tangential_share >= 0.5 ? "tangential" : "normal";
    mode.name = wave.wavelength <= longest_node_wave ? "node-scale" : direction;
    return true;
  };
  for (const Excursion& e : growth.excursions()) {
    if (e.cell == cell && read(find_wave(e.x, e.y, e.velocity_x, e.velocity_y), e.step)) return mode;
  }
  const core::CellRange& range = m.cells[cell];
  const auto part = [&range](const std::vector<double>& values) {
    return std::span(values).subspan(static_cast<std::size_t>(range.first), static_cast<std::size_t>(range.count));
  };
  read(find_wave(part(m.position[0]), part(m.position[1]), part(m.velocity[0]), part(m.velocity[1])), step);
  return mode;
}

}  // namespace

double lattice_oscillation(int x, int y, const std::function<FluidSample(int x, int y)>& sample) {
  double most = 0;
  for (const bool along_x : {true, false}) {
    std::vector<FluidSample> line;
    for (int i = -oscillation_window; i <= oscillation_window; ++i) {
      line.push_back(along_x ? sample(x + i, y) : sample(x, y + i));
    }
    double differences = 0, energy = 0;
    int counted = 0, known = 0;
    for (std::size_t q = 0; q < 3; ++q) {
      double mean = 0;
      int values = 0;
      for (const FluidSample& s : line) {
        if (std::isfinite(s[q])) mean += s[q], ++values;
      }
      mean /= std::max(values, 1);
      for (const FluidSample& s : line) {
        if (std::isfinite(s[q])) energy += (s[q] - mean) * (s[q] - mean), ++known;
      }
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const double difference = line[i - 1][q] - 2 * line[i][q] + line[i + 1][q];
        if (std::isfinite(difference)) differences += difference * difference, ++counted;
      }
    }
    // A wave of amplitude 1 two spacings long has second differences of 4.
    if (counted > 0 && energy > 0) most = std::max(most, (differences / counted) / (16 * energy / known));
  }
  return most;
}

template <class T, class Set>
double lattice_oscillation(const core::Fluid<T, Set>& fluid, const std::array<int, Set::dimension>& node) {
  using Moments = core::Moments<Set::dimension>;
  const core::Domain<Set::dimension>& domain = fluid.setting().domain;
  std::map<int, std::vector<Moments>> rows;  // that samples lie in, by y
  for (int i = -oscillation_window; i <= oscillation_window; ++i) rows[domain.wrapped(1, node[1] + i)] = {};
  rows.erase(-1);
  int layer = 0;
  if constexpr (Set::dimension == 3) layer = std::clamp(node[2], 0, domain.size[2] - 1) * domain.size[1];
  int first = 0;  // row of the band
  fluid.gather_moments(
      core::bands_of_all<Set::dimension>(domain.size, sizeof(Moments)), [&](int, const std::vector<Moments>& band) {
        const int end = first + static_cast<int>(band.size()) / domain.size[0];
        for (auto& [y, row] : rows) {
          if (layer + y < first || layer + y >= end) continue;
          const auto begin = band.begin() + static_cast<std::ptrdiff_t>(layer + y - first) * domain.size[0];
          row.assign(begin, begin + domain.size[0]);
        }
        first = end;
      });
  if (!fluid.ranks().first()) return 0;
  return lattice_oscillation(node[0], node[1], [&](int i, int j) -> FluidSample {
    j = domain.wrapped(1, j);
    if (j < 0) return {std::nan(""), std::nan(""), std::nan("")};
    const Moments& m = rows.at(j)[static_cast<std::size_t>(domain.wrapped(0, i))];
    return {m.velocity[0], m.velocity[1], m.density / std::sqrt(3.0)};
  });
}

template double lattice_oscillation(const core::Fluid<float>&, const std::array<int, 2>&);
template double lattice_oscillation(const core::Fluid<double>&, const std::array<int, 2>&);
template double lattice_oscillation(const core::Fluid<float, core::D3Q19>&, const std::array<int, 3>&);
template double lattice_oscillation(const core::Fluid<double, core::D3Q19>&, const std::array<int, 3>&);

void find_mode(monitor::Failure& failure, const core::Membranes& membranes, const GrowthWatch& growth,
               const core::Domain<2>& domain, std::array<double, 2> place, double oscillation, long step,
               const core::Ranks<2>& ranks) {
  const Neighbourhood around = find_neighbourhood(failure.cell, membranes, place, domain, ranks);
  FailureMode mode;
  if (around.cell >= 0 && membranes.owns(around.cell)) mode = wave_of(around.cell, membranes, growth, step);
  if (around.cell >= 0) mode = of_rank(ranks, around.rank, mode);
  const bool waves = mode.name != "none";
  if (failure.reason == "area_drift") {
    mode.name = "leakage";
  } else if (!waves && (failure.reason == "crossing" || around.contact)) {
    mode.name = "collapse";
  } else if (!waves && (around.cell < 0 || oscillation >= lattice_oscillation_limit)) {
    mode.name = "sound";
  }
  failure.mode = mode;
}

void find_mode(monitor::Failure& failure, const core::Surfaces& surfaces, double oscillation) {
  if (failure.reason == "area_drift") {
    failure.mode.name = "leakage";
  } else if (surfaces.cells.empty() || (failure.cell < 0 && oscillation >= lattice_oscillation_limit)) {
    failure.mode.name = "sound";
  }
}

std::string mode_sentence(const monitor::Failure& failure) {
  const FailureMode& mode = failure.mode;
  if (std::isfinite(mode.wavelength)) {
    char text[200];
    const char* direction = mode.tangential_share >= 0.5 ? "along" : "across";
    std::snprintf(text, sizeof text, "nodes move %s the membrane in waves of %.2g segments, first seen at step %ld",
                  direction, mode.wavelength, mode.step);
    return text;
  }
  if (mode.name == "collapse" && failure.reason != "crossing") return "it happened where two membranes are in contact";
  if (mode.name == "sound" && failure.reason != "mach")
    return failure.cell < 0 ? "no membrane is near: the fluid itself fails" : "the fluid oscillates from node to node";
  return "";
}

std::string mode_remedy(const monitor::Failure& failure, bool semi_implicit, const scene::Stage& stage,
                        const std::string& against_attraction) {
  const FailureMode& mode = failure.mode;
  const std::string lower = "lower " + stage.density_factor_key;
  const std::string step = semi_implicit ? lower : lower + " or set numerics.coupling to \"semi-implicit\"";
  // These say themselves what to do, whatever moves when they happen.
  for (const char* reason : {"area_drift", "uneven_nodes", "crossing"}) {
    if (failure.reason == reason) return "";
  }
  if (mode.name == "node-scale" && mode.tangential_share >= 0.5) {
    return "the nodes zigzag: take the peskin4 kernel and about one segment for each spacing; " + step;
  }
  if (std::isfinite(mode.wavelength)) {
    return std::string(mode.tangential_share >= 0.5 ? "the membrane resists stretching"
                                                    : "the membrane resists bending") +
           " too much for the time step: " + step;
  }
  if (mode.name == "collapse" && failure.reason != "mach") {
    return against_attraction.empty() ? lower + ", raise the resolution, or stiffen bending" : against_attraction;
  }
  if (mode.name == "sound" && failure.reason != "mach" && failure.cell < 0) {
    return "raise numerics.tau, take the \"trt\" collision, or " + lower;
  }
  return "";
}

}  // namespace rouleau::monitor
