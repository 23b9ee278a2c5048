// What the membrane laws of each cell type need, give and remember, found out before the first step.
#include <algorithm>
#include <string>

#include "membrane_forces.hpp"
#include "stiffness.hpp"

namespace rouleau::core {

MembraneForces::Law MembraneForces::describe(const MembraneLaw& model) {
  return {.model = model,
          .stretch = model.reads("stretch"),
          .stretch_rate = model.reads("stretch_rate"),
          .curvature = model.reads("curvature"),
          .rest_curvature = model.reads("rest_curvature"),
          .area = model.reads("area"),
          .rest_area = model.reads("rest_area"),
          .perimeter = model.reads("perimeter"),
          .rest_perimeter = model.reads("rest_perimeter"),
          .tension = model.writes("tension"),
          .moment = model.writes("moment"),
          .pressure = model.writes("pressure"),
          .perimeter_tension = model.writes("perimeter_tension"),
          .energy = model.writes("energy"),
          .tension_by_rate = model.writes("tension_by_rate"),
          .state = {}};
}

MembraneForces::MembraneForces(Membranes& membranes, const MembraneForcesSetup& setup) {
  for (const MembraneLaws& laws : setup.laws) {
    Type& type = types_.emplace_back();
    if (!setup.mobility.empty()) type.mobility = setup.mobility[types_.size() - 1];
    for (const MembraneLaw& model : laws) {
      const Law& law = type.laws.emplace_back(describe(model));
      type.rate |= law.stretch_rate || law.tension_by_rate;
      type.tension_by_rate |= law.tension_by_rate;
      type.tension |= law.tension;
      type.moment |= law.moment || law.curvature;
      type.cell |= law.pressure || law.perimeter_tension;
    }
  }
  allocate(membranes);
  if (setup.semi_implicit) make_filters(membranes, setup.viscosity);
  keep_state(membranes, setup.tension_unit);
}

void MembraneForces::allocate(const Membranes& membranes) {
  std::size_t size = pack_margin;
  for (const CellRange& cell : membranes.cells) {
    offset_.push_back(size);
    size += static_cast<std::size_t>(cell.count + pack_margin) / pack_margin * pack_margin + 2 * pack_margin;
  }
  Scratch& s = scratch_;
  for (auto* values :
       {&s.x, &s.y, &s.u, &s.v, &s.tangent_x, &s.tangent_y, &s.inverse_length, &s.stretch, &s.rate, &s.curvature,
        &s.tension, &s.moment, &s.law, &s.energy, &s.segment_force_x, &s.segment_force_y}) {
    *values = PagedArray<double>(size);
  }
  if (std::any_of(types_.begin(), types_.end(), [](const Type& type) { return type.tension_by_rate; })) {
    for (auto* values : {&s.by_rate, &s.law_by_rate}) *values = PagedArray<double>(size);
  }
  find_rests(membranes);
}

/// Cells of a type rest alike as a rule; each is compared with the last one of its type.
void MembraneForces::find_rests(const Membranes& membranes) {
  std::vector<int> last(types_.size(), -1);
  for (int c = 0; c < membranes.cell_count(); ++c) {
    const CellRange& cell = membranes.cells[c];
    const auto alike = [&](const CellRange& other, const std::vector<double>& values) {
      return std::equal(values.begin() + cell.first, values.begin() + cell.end(), values.begin() + other.first,
                        values.begin() + other.end());
    };
    int& rest_of = last[cell.type];
    const CellRange* known = rest_of >= 0 ? &membranes.cells[rests_[rest_of].cell] : nullptr;
    if (known == nullptr || !alike(*known, membranes.rest_length) || !alike(*known, membranes.rest_weight) ||
        !alike(*known, membranes.rest_curvature)) {
      rest_of = static_cast<int>(rests_.size());
      Rest& rest = rests_.emplace_back();
      rest.cell = c;
      for (auto* values : {&rest.inverse_length, &rest.inverse_weight, &rest.curvature})
        values->assign(static_cast<std::size_t>(cell.count + 3 * pack_margin), 0.0);
      for (int k = 0; k < cell.count; ++k) {
        const auto i = static_cast<std::size_t>(cell.first + k), at = static_cast<std::size_t>(pack_margin + k);
        rest.inverse_length[at] = 1 / membranes.rest_length[i];
        rest.inverse_weight[at] = 1 / membranes.rest_weight[i];
        rest.curvature[at] = membranes.rest_curvature[i];
      }
    }
    rest_of_.push_back(rest_of);
  }
}

void MembraneForces::make_filters(const Membranes& membranes, double viscosity) {
  for (const CellRange& cell : membranes.cells) {
    Type& type = types_[cell.type];
    if (type.filter) continue;
    Stiffness stiffness;
    for (const Law& law : type.laws) stiffness += law.model;
    const double length = cell.rest_perimeter / cell.count;
    type.filter.emplace(cell.count, length, stiffening(type.mobility.shift, length), viscosity, stiffness.stretching,
                        stiffness.bending);
  }
}

void MembraneForces::keep_state(Membranes& membranes, double tension_unit) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    Type& type = types_[t];
    const auto keep = [&](int law, const std::string& id, const StateVariable& variable) {
      return core::keep_state(membranes.state, {static_cast<int>(t), law, id, variable.name, variable.unit, {}},
                              variable.initial, membranes.x.size());
    };
    for (std::size_t l = 0; l < type.laws.size(); ++l) {
      Law& law = type.laws[l];
      for (const StateVariable& variable : law.model.state) {
        law.state.push_back(keep(static_cast<int>(l), law.model.id, variable));
      }
    }
    if (type.tension_by_rate) type.rate_tension = keep(-1, "", {"rate_tension", 0, tension_unit});
    for (int k = 0; k < 2 && type.filter; ++k) {
      type.held_force[k] = keep(-1, "", {k == 0 ? "held_force_x" : "held_force_y", 0, tension_unit});
    }
  }
}

}  // namespace rouleau::core
