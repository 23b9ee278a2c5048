#include "membrane_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <rouleau/dispatch.hpp>

#include "geometry.hpp"
#include "membrane_kernels.hpp"

namespace rouleau::core {

namespace {

constexpr std::size_t most_states = 16;  // of one law: the manifest's limit

void close(double* values, int count) {
  values[-1] = values[count - 1];
  values[count] = values[0];
}

template <class Loop>
void run_loop(const CellArrays& arrays) {
  static const auto function = Dispatch<Loop, const CellArrays*>::pick();
  function(&arrays);
}

double weighted_sum(const double* values, const double* weights, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += values[i] * weights[i];
  return sum;
}

}  // namespace

void MembraneForces::run(Worker worker, Membranes& membranes) {
  const Range cells = worker.share(membranes.cell_count());
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    if (!membranes.owns(cell)) continue;
    const std::size_t at = offset(cells.begin);
    const CellRange& range = membranes.cells[cell];
    const bool semi_implicit = types_[range.type].filter.has_value();
    measure(membranes, cell, at, semi_implicit);
    act(membranes, cell, at, apply_laws(membranes, cell, at, &membranes.state, nullptr));
    if (semi_implicit) soften(membranes, cell);
  }
}

MembraneEnergy MembraneForces::energies(const Membranes& membranes) {
  MembraneEnergy energy;
  for (int cell = 0; cell < membranes.cell_count(); ++cell) {
    measure(membranes, cell, offset(0), false);
    apply_laws(membranes, cell, offset(0), nullptr, &energy);
  }
  return energy;
}

void MembraneForces::tensions(const Membranes& membranes, std::vector<double>& tension) {
  tension.resize(membranes.x.size());
  for (int cell = 0; cell < membranes.cell_count(); ++cell) {
    const CellRange& range = membranes.cells[cell];
    measure(membranes, cell, offset(0), false);
    const double uniform = apply_laws(membranes, cell, offset(0), nullptr, nullptr).perimeter_tension;
    for (int k = 0; k < range.count; ++k) {
      tension[range.first + k] = scratch_.tension[offset(0) + static_cast<std::size_t>(k)] + uniform;
    }
  }
}

void MembraneForces::measure(const Membranes& membranes, int cell, std::size_t at, bool ahead) {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  Scratch& s = scratch_;
  const auto copy_closed = [&](const std::vector<double>& from, PagedArray<double>& to) {
    std::copy_n(from.data() + range.first, range.count, to.data() + at);
    close(to.data() + at, range.count);
  };
  copy_closed(membranes.x, s.x);
  copy_closed(membranes.y, s.y);
  if (ahead) {
    for (int k = -1; k <= range.count; ++k) {
      const int node = range.first + (k < 0 ? range.count - 1 : k % range.count);
      const std::size_t to = at + static_cast<std::size_t>(k);
      s.x[to] += membranes.velocity_x[node];
      s.y[to] += membranes.velocity_y[node];
    }
  }
  if (type.rate) {
    copy_closed(membranes.velocity_x, s.u);
    copy_closed(membranes.velocity_y, s.v);
  }
  CellArrays arrays{};
  arrays.count = range.count;
  arrays.x = &s.x[at], arrays.y = &s.y[at], arrays.u = &s.u[at], arrays.v = &s.v[at];
  arrays.tangent_x = &s.tangent_x[at], arrays.tangent_y = &s.tangent_y[at];
  arrays.inverse_length = &s.inverse_length[at], arrays.stretch = &s.stretch[at], arrays.rate = &s.rate[at];
  arrays.inverse_rest_length = &rest_of(cell).inverse_length[pack_margin];
  arrays.inverse_rest_weight = &rest_of(cell).inverse_weight[pack_margin];
  arrays.curvature = &s.curvature[at];
  arrays.with_rate = type.rate, arrays.with_moment = type.moment;
  run_loop<MeasureCell>(arrays);
}

void MembraneForces::give_inputs(const Law& law, const CellRange& range, int cell, std::size_t at,
                                 const CellState& sums, rouleau_membrane_block& block) const {
  const bool whole_cell = law.pressure || law.perimeter_tension;
  block.struct_size = sizeof block;
  block.count = whole_cell ? 1 : static_cast<std::uint32_t>(range.count);
  if (law.stretch) block.stretch = &scratch_.stretch[at];
  if (law.stretch_rate) block.stretch_rate = &scratch_.rate[at];
  if (law.curvature) block.curvature = &scratch_.curvature[at];
  if (law.rest_curvature) block.rest_curvature = &rest_of(cell).curvature[pack_margin];
  if (law.area) block.area = &sums.area;
  if (law.rest_area) block.rest_area = &range.rest_area;
  if (law.perimeter) block.perimeter = &sums.perimeter;
  if (law.rest_perimeter) block.rest_perimeter = &range.rest_perimeter;
}

void MembraneForces::apply_law(const Law& law, const Membranes& membranes, int cell, std::size_t at,
                               std::vector<ElementState>* next, CellState& sums, bool first_tension, bool first_moment,
                               double* energy) {
  Scratch& s = scratch_;
  const CellRange& range = membranes.cells[cell];
  double pressure = 0, perimeter_tension = 0;
  rouleau_membrane_block block{};
  give_inputs(law, range, cell, at, sums, block);
  block.time_step = next != nullptr ? 1 : 0;
  if (law.tension) block.tension = first_tension ? &s.tension[at] : &s.law[at];
  if (law.moment) block.moment = first_moment ? &s.moment[at] : &s.law[at];
  if (law.pressure) block.pressure = &pressure;
  if (law.perimeter_tension) block.perimeter_tension = &perimeter_tension;
  if (law.tension_by_rate) block.tension_by_rate = &s.law_by_rate[at];
  block.energy = energy;
  std::array<const double*, most_states> state;
  std::array<double*, most_states> new_state;
  if (!law.state.empty()) {
    for (std::size_t k = 0; k < law.state.size(); ++k) {
      const auto first = static_cast<std::size_t>(range.first);
      state[k] = &membranes.state[law.state[k]].value[first];
      if (next != nullptr) new_state[k] = &(*next)[law.state[k]].value[first];
    }
    block.state = state.data();
    if (next != nullptr) block.new_state = new_state.data();
  }
  law.model.compute(&block);

  const auto add = [&](const PagedArray<double>& from, PagedArray<double>& sum) {
    for (std::size_t i = at; i < at + static_cast<std::size_t>(range.count); ++i) sum[i] += from[i];
  };
  if (law.tension && !first_tension) add(s.law, s.tension);
  if (law.moment && !first_moment) add(s.law, s.moment);
  if (law.tension_by_rate) add(s.law_by_rate, s.by_rate);
  sums.pressure += pressure;
  sums.perimeter_tension += perimeter_tension;
}

MembraneForces::CellState MembraneForces::apply_laws(const Membranes& membranes, int cell, std::size_t at,
                                                     std::vector<ElementState>* next, MembraneEnergy* energy) {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  CellState sums;
  if (type.cell) {
    sums.area = enclosed_area(membranes, range);
    sums.perimeter = perimeter(membranes, range);
  }
  if (type.tension_by_rate) std::fill_n(&scratch_.by_rate[at], range.count, 0.0);
  bool tension = false, moment = false;
  for (const Law& law : type.laws) {
    apply_law(law, membranes, cell, at, next, sums, !tension, !moment,
              energy != nullptr && law.energy ? &scratch_.energy[at] : nullptr);
    if (energy != nullptr)
      add_energy(law, membranes, cell, at, sums, tension ? &scratch_.law[at] : &scratch_.tension[at], *energy);
    tension |= law.tension;
    moment |= law.moment;
  }
  // Where no law gives them, the arrays may hold those of another type's cell.
  if (!tension) std::fill_n(&scratch_.tension[at], range.count, 0.0);
  if (!moment) std::fill_n(&scratch_.moment[at], range.count, 0.0);
  if (type.tension_by_rate) add_rate_tension(membranes, cell, at, next);
  if (type.tension_by_rate && energy != nullptr) {
    const auto first = static_cast<std::size_t>(range.first);
    const double* implicit = &membranes.state[type.rate_tension].value[first];
    for (int k = 0; k < range.count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      energy->dissipation += implicit[k] * scratch_.rate[at + i] * membranes.rest_length[first + i];
    }
  }
  return sums;
}

double MembraneForces::integrated(const Law& law, const Membranes& membranes, const CellRange& range,
                                  const double* energy) {
  const auto first = static_cast<std::size_t>(range.first);
  if (law.tension) return weighted_sum(energy, &membranes.rest_length[first], range.count);
  if (law.moment) return weighted_sum(energy, &membranes.rest_weight[first], range.count);
  return energy[0];
}

double MembraneForces::relaxed_energy(const Law& law, const Membranes& membranes, int cell, std::size_t at,
                                      const CellState& sums) const {
  const CellRange& range = membranes.cells[cell];
  const auto count = static_cast<std::size_t>(range.count);
  const std::vector<double> still(count, 0.0);
  std::vector<double> energy(count);
  std::vector<std::vector<double>> values;
  std::array<const double*, most_states> state{};
  std::array<double*, most_states> new_state{};
  for (std::size_t k = 0; k < law.state.size(); ++k) {
    const double* present = &membranes.state[law.state[k]].value[range.first];
    values.emplace_back(present, present + count);
  }
  for (std::size_t k = 0; k < values.size(); ++k) state[k] = new_state[k] = values[k].data();
  rouleau_membrane_block block{};
  give_inputs(law, range, cell, at, sums, block);
  if (law.stretch_rate) block.stretch_rate = still.data();
  block.energy = energy.data();
  block.state = state.data();
  block.new_state = new_state.data();
  block.time_step = 1;
  law.model.compute(&block);
  block.new_state = nullptr;
  block.time_step = 0;
  law.model.compute(&block);
  return integrated(law, membranes, range, energy.data());
}

/// `tension`: that of this law alone.
void MembraneForces::add_energy(const Law& law, const Membranes& membranes, int cell, std::size_t at,
                                const CellState& sums, const double* tension, MembraneEnergy& energy) const {
  const CellRange& range = membranes.cells[cell];
  if (!law.energy) {
    // A law that only resists the rate of stretch stores nothing.
    bool stores = !law.tension_by_rate;
    for (int k = 0; k < range.count && !stores; ++k) {
      const double by_rate = scratch_.law_by_rate[at + static_cast<std::size_t>(k)];
      const double viscous = by_rate * scratch_.rate[at + static_cast<std::size_t>(k)];
      stores = std::abs(tension[k] - viscous) > 1e-12 * std::abs(viscous);
    }
    if (stores) energy.unknown = law.model.id;
    return;
  }
  const double present = integrated(law, membranes, range, &scratch_.energy[at]);
  (law.tension ? energy.tension : law.moment ? energy.bending : energy.cell) += present;
  if (!law.state.empty()) energy.dissipation += present - relaxed_energy(law, membranes, cell, at, sums);
}

/// T(stretch, rate) is taken apart into eta rate, for which the tension of the implicit step comes in, and the rest.
void MembraneForces::add_rate_tension(const Membranes& membranes, int cell, std::size_t at,
                                      std::vector<ElementState>* next) {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  const std::size_t variable = type.rate_tension;
  const double length = range.rest_perimeter / range.count;
  const auto first = static_cast<std::size_t>(range.first);
  Scratch& s = scratch_;
  if (next != nullptr) {
    solve({range.count,
           &s.tangent_x[at],
           &s.tangent_y[at],
           &rest_of(cell).inverse_length[pack_margin],
           &s.rate[at],
           &s.by_rate[at],
           rate_mobility(length) + type.mobility.slip / length,
           &(*next)[variable].value[first],
           {&s.law[at], &s.law_by_rate[at], &s.segment_force_x[at], &s.segment_force_y[at]}});
  }
  const double* implicit = &membranes.state[variable].value[first];
  for (int k = 0; k < range.count; ++k) {
    const std::size_t i = at + static_cast<std::size_t>(k);
    s.tension[i] += implicit[k] - s.by_rate[i] * s.rate[i];
  }
}

void MembraneForces::act(Membranes& membranes, int cell, std::size_t at, const CellState& state) {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  Scratch& s = scratch_;
  CellArrays arrays{};
  arrays.count = range.count;
  arrays.x = &s.x[at], arrays.y = &s.y[at];
  arrays.tangent_x = &s.tangent_x[at], arrays.tangent_y = &s.tangent_y[at];
  arrays.inverse_length = &s.inverse_length[at];
  arrays.tension = &s.tension[at], arrays.moment = &s.moment[at];
  arrays.segment_force_x = &s.segment_force_x[at], arrays.segment_force_y = &s.segment_force_y[at];
  arrays.force_x = &membranes.force_x[range.first];
  arrays.force_y = &membranes.force_y[range.first];
  arrays.with_moment = type.moment, arrays.with_pressure = type.cell;
  arrays.pressure = state.pressure, arrays.perimeter_tension = state.perimeter_tension;
  run_loop<ActOnCell>(arrays);
}

/// Makes the forces those of the semi-implicit step.
void MembraneForces::soften(Membranes& membranes, int cell) const {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  const auto first = static_cast<std::size_t>(range.first);
  const auto held = [&](int component) { return &membranes.state[type.held_force[component]].value[first]; };
  type.filter->apply(&membranes.force_x[first], &membranes.force_y[first], held(0), held(1));
}

}  // namespace rouleau::core
