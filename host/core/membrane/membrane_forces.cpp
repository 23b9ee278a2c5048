#include "membrane_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/domain/run_loop.hpp"
#include "geometry.hpp"
#include "membrane_kernels.hpp"

namespace rouleau::core {

namespace {

constexpr std::size_t most_states = 16;  // of one law: the manifest's limit

void close(double* values, int count) {
  values[-1] = values[count - 1];
  values[count] = values[0];
}

double weighted_sum(const double* values, const double* weights, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += values[i] * weights[i];
  return sum;
}

}  // namespace

MembraneForces::Scratch& MembraneForces::scratch_of(int first_cell) {
  Scratch& scratch = scratch_.of(first_cell);
  if (scratch.x.count() < most_nodes_) scratch = Scratch(most_nodes_);
  return scratch;
}

void MembraneForces::run(Worker worker, Membranes& membranes) {
  const CellNumbers cells = membranes.own_cells(worker);
  for (const int cell : cells) {
    Scratch& scratch = scratch_of(cells.first_place());
    const bool semi_implicit = types_[membranes.cells[cell].type].filter.has_value();
    measure(membranes, cell, scratch, semi_implicit);
    act(membranes, cell, scratch, apply_laws(membranes, cell, scratch, &membranes.state, nullptr));
    if (semi_implicit) soften(membranes, cell);
  }
}

MembraneEnergy MembraneForces::energies(const Membranes& membranes, const Ranks<2>& ranks) {
  MembraneEnergySum sum;
  for (const int cell : membranes.own_cells()) {
    MembraneEnergy energy;
    measure(membranes, cell, scratch_of(0), false);
    apply_laws(membranes, cell, scratch_of(0), nullptr, &energy);
    sum.add(cell, energy);
  }
  return sum.of_all(ranks);
}

std::vector<double> MembraneForces::tensions(const Membranes& membranes, int cell) {
  Scratch& scratch = scratch_of(0);
  measure(membranes, cell, scratch, false);
  const double uniform = apply_laws(membranes, cell, scratch, nullptr, nullptr).perimeter_tension;
  std::vector<double> tension(scratch.tension.data(), scratch.tension.data() + membranes.cells[cell].count);
  for (double& of_segment : tension) of_segment += uniform;
  return tension;
}

void MembraneForces::measure(const Membranes& membranes, int cell, Scratch& s, bool ahead) const {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  const auto copy_closed = [&](const std::vector<double>& from, Padded& to) {
    std::copy_n(from.data() + range.first, range.count, to.data());
    close(to.data(), range.count);
  };
  copy_closed(membranes.position[0], s.x);
  copy_closed(membranes.position[1], s.y);
  if (ahead) {
    for (int k = -1; k <= range.count; ++k) {
      const int node = range.first + (k < 0 ? range.count - 1 : k % range.count);
      s.x[k] += membranes.velocity[0][node];
      s.y[k] += membranes.velocity[1][node];
    }
  }
  if (type.rate) {
    copy_closed(membranes.velocity[0], s.u);
    copy_closed(membranes.velocity[1], s.v);
  }
  CellArrays arrays{};
  arrays.count = range.count;
  arrays.x = s.x.data(), arrays.y = s.y.data(), arrays.u = s.u.data(), arrays.v = s.v.data();
  arrays.tangent_x = s.tangent_x.data(), arrays.tangent_y = s.tangent_y.data();
  arrays.inverse_length = s.inverse_length.data(), arrays.stretch = s.stretch.data(), arrays.rate = s.rate.data();
  arrays.inverse_rest_length = type.inverse_length.data();
  arrays.inverse_rest_weight = type.inverse_weight.data();
  arrays.curvature = s.curvature.data();
  arrays.with_rate = type.rate, arrays.with_moment = type.moment;
  run_loop<MeasureCell>(arrays);
}

void MembraneForces::give_inputs(const Law& law, const CellRange& range, const Scratch& scratch, const CellState& sums,
                                 rouleau_membrane_block& block) const {
  const bool whole_cell = law.pressure || law.perimeter_tension;
  block.struct_size = sizeof block;
  block.count = whole_cell ? 1 : static_cast<std::uint32_t>(range.count);
  if (law.stretch) block.stretch = scratch.stretch.data();
  if (law.stretch_rate) block.stretch_rate = scratch.rate.data();
  if (law.curvature) block.curvature = scratch.curvature.data();
  if (law.rest_curvature) block.rest_curvature = types_[range.type].curvature.data();
  if (law.area) block.area = &sums.area;
  if (law.rest_area) block.rest_area = &range.rest_area;
  if (law.perimeter) block.perimeter = &sums.perimeter;
  if (law.rest_perimeter) block.rest_perimeter = &range.rest_perimeter;
}

void MembraneForces::apply_law(const Law& law, const Membranes& membranes, int cell, Scratch& s,
                               std::vector<ElementState>* next, CellState& sums, bool first_tension, bool first_moment,
                               double* energy) const {
  const CellRange& range = membranes.cells[cell];
  double pressure = 0, perimeter_tension = 0;
  rouleau_membrane_block block{};
  give_inputs(law, range, s, sums, block);
  block.time_step = next != nullptr ? 1 : 0;
  if (law.tension) block.tension = first_tension ? s.tension.data() : s.law.data();
  if (law.moment) block.moment = first_moment ? s.moment.data() : s.law.data();
  if (law.pressure) block.pressure = &pressure;
  if (law.perimeter_tension) block.perimeter_tension = &perimeter_tension;
  if (law.tension_by_rate) block.tension_by_rate = s.law_by_rate.data();
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

  const auto add = [&](const Padded& from, Padded& sum) {
    for (int k = 0; k < range.count; ++k) sum[k] += from[k];
  };
  if (law.tension && !first_tension) add(s.law, s.tension);
  if (law.moment && !first_moment) add(s.law, s.moment);
  if (law.tension_by_rate) add(s.law_by_rate, s.by_rate);
  sums.pressure += pressure;
  sums.perimeter_tension += perimeter_tension;
}

MembraneForces::CellState MembraneForces::apply_laws(const Membranes& membranes, int cell, Scratch& scratch,
                                                     std::vector<ElementState>* next, MembraneEnergy* energy) const {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  CellState sums;
  if (type.cell) {
    sums.area = enclosed_area(membranes, range);
    sums.perimeter = perimeter(membranes, range);
  }
  if (type.tension_by_rate) std::fill_n(scratch.by_rate.data(), range.count, 0.0);
  bool tension = false, moment = false;
  for (const Law& law : type.laws) {
    apply_law(law, membranes, cell, scratch, next, sums, !tension, !moment,
              energy != nullptr && law.energy ? scratch.energy.data() : nullptr);
    if (energy != nullptr)
      add_energy(law, membranes, cell, scratch, sums, tension ? scratch.law.data() : scratch.tension.data(), *energy);
    tension |= law.tension;
    moment |= law.moment;
  }
  // Where no law gives them, the arrays may hold those of another type's cell.
  if (!tension) std::fill_n(scratch.tension.data(), range.count, 0.0);
  if (!moment) std::fill_n(scratch.moment.data(), range.count, 0.0);
  if (type.tension_by_rate) add_rate_tension(membranes, cell, scratch, next);
  if (type.tension_by_rate && energy != nullptr) {
    const double* implicit = &membranes.state[type.rate_tension].value[range.first];
    const double* length = membranes.type_of(range).rest_length.data();
    for (int k = 0; k < range.count; ++k) energy->dissipation += implicit[k] * scratch.rate[k] * length[k];
  }
  return sums;
}

double MembraneForces::integrated(const Law& law, const RestShape& rest, const double* energy) {
  const int count = static_cast<int>(rest.x.size());
  if (law.tension) return weighted_sum(energy, rest.rest_length.data(), count);
  if (law.moment) return weighted_sum(energy, rest.rest_weight.data(), count);
  return energy[0];
}

double MembraneForces::relaxed_energy(const Law& law, const Membranes& membranes, int cell, const Scratch& scratch,
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
  give_inputs(law, range, scratch, sums, block);
  if (law.stretch_rate) block.stretch_rate = still.data();
  block.energy = energy.data();
  block.state = state.data();
  block.new_state = new_state.data();
  block.time_step = 1;
  law.model.compute(&block);
  block.new_state = nullptr;
  block.time_step = 0;
  law.model.compute(&block);
  return integrated(law, membranes.type_of(range), energy.data());
}

/// `tension`: that of this law alone.
void MembraneForces::add_energy(const Law& law, const Membranes& membranes, int cell, const Scratch& scratch,
                                const CellState& sums, const double* tension, MembraneEnergy& energy) const {
  const CellRange& range = membranes.cells[cell];
  if (!law.energy) {
    // A law that only resists the rate of stretch stores nothing.
    bool stores = !law.tension_by_rate;
    for (int k = 0; k < range.count && !stores; ++k) {
      const double viscous = scratch.law_by_rate[k] * scratch.rate[k];
      stores = std::abs(tension[k] - viscous) > 1e-12 * std::abs(viscous);
    }
    if (stores) energy.unknown = law.model.id;
    return;
  }
  const double present = integrated(law, membranes.type_of(range), scratch.energy.data());
  (law.tension ? energy.tension : law.moment ? energy.bending : energy.cell) += present;
  if (!law.state.empty()) energy.dissipation += present - relaxed_energy(law, membranes, cell, scratch, sums);
}

/// T(stretch, rate) is taken apart into eta rate, for which the tension of the implicit step comes in, and the rest.
void MembraneForces::add_rate_tension(const Membranes& membranes, int cell, Scratch& s,
                                      std::vector<ElementState>* next) const {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  const std::size_t variable = type.rate_tension;
  const double length = range.rest_perimeter / range.count;
  const auto first = static_cast<std::size_t>(range.first);
  if (next != nullptr) {
    solve({range.count,
           s.tangent_x.data(),
           s.tangent_y.data(),
           type.inverse_length.data(),
           s.rate.data(),
           s.by_rate.data(),
           type.response.gain * rate_mobility(length) + type.mobility.slip / length,
           &(*next)[variable].value[first],
           {s.law.data(), s.law_by_rate.data(), s.segment_force_x.data(), s.segment_force_y.data()}});
  }
  const double* implicit = &membranes.state[variable].value[first];
  for (int k = 0; k < range.count; ++k) s.tension[k] += implicit[k] - s.by_rate[k] * s.rate[k];
}

void MembraneForces::act(Membranes& membranes, int cell, Scratch& s, const CellState& state) const {
  const CellRange& range = membranes.cells[cell];
  const Type& type = types_[range.type];
  CellArrays arrays{};
  arrays.count = range.count;
  arrays.x = s.x.data(), arrays.y = s.y.data();
  arrays.tangent_x = s.tangent_x.data(), arrays.tangent_y = s.tangent_y.data();
  arrays.inverse_length = s.inverse_length.data();
  arrays.tension = s.tension.data(), arrays.moment = s.moment.data();
  arrays.segment_force_x = s.segment_force_x.data(), arrays.segment_force_y = s.segment_force_y.data();
  arrays.force_x = &membranes.force[0][range.first];
  arrays.force_y = &membranes.force[1][range.first];
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
  type.filter->apply(&membranes.force[0][first], &membranes.force[1][first], held(0), held(1));
}

}  // namespace rouleau::core
