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

MembraneForces::MembraneForces(Membranes& membranes, const MembraneForcesSetup& setup)
    : scratch_(membranes.cells.size()) {
  for (const MembraneLaws& laws : setup.laws) {
    const std::size_t index = types_.size();
    Type& type = types_.emplace_back();
    if (!setup.mobility.empty()) type.mobility = setup.mobility[index];
    type.response = setup.response;
    for (const MembraneLaw& model : laws) {
      const Law& law = type.laws.emplace_back(describe(model));
      type.rate |= law.stretch_rate || law.tension_by_rate;
      type.tension_by_rate |= law.tension_by_rate;
      type.tension |= law.tension;
      type.moment |= law.moment || law.curvature;
      type.cell |= law.pressure || law.perimeter_tension;
    }
    const RestShape& rest = *membranes.types[index];
    const int count = static_cast<int>(rest.x.size());
    most_nodes_ = std::max(most_nodes_, count);
    for (Padded* values : {&type.inverse_length, &type.inverse_weight, &type.curvature}) *values = Padded(count);
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      type.inverse_length[k] = 1 / rest.rest_length[i];
      type.inverse_weight[k] = 1 / rest.rest_weight[i];
      type.curvature[k] = rest.rest_curvature[i];
    }
  }
  if (setup.semi_implicit) make_filters(membranes, setup.viscosity);
  keep_state(membranes, setup.tension_unit);
}

MembraneForces::Scratch::Scratch(int count) {
  for (Padded* values : {&x, &y, &u, &v, &tangent_x, &tangent_y, &inverse_length, &stretch, &rate, &curvature, &tension,
                         &moment, &law, &energy, &segment_force_x, &segment_force_y, &by_rate, &law_by_rate})
    *values = Padded(count);
}

void MembraneForces::make_filters(const Membranes& membranes, double viscosity) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    Type& type = types_[t];
    const RestShape& rest = *membranes.types[t];
    Stiffness stiffness;
    for (const Law& law : type.laws) stiffness += law.model;
    const int count = static_cast<int>(rest.x.size());
    const double length = rest.rest_perimeter / count;
    type.filter.emplace(count, length, type.response.gain * stiffening(type.mobility.shift, length), viscosity,
                        stiffness.stretching, stiffness.bending);
  }
}

void MembraneForces::keep_state(Membranes& membranes, double tension_unit) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    Type& type = types_[t];
    const auto keep = [&](int law, const std::string& id, const StateVariable& variable) {
      return core::keep_state(membranes.state, {static_cast<int>(t), law, id, variable.name, variable.unit, {}},
                              variable.initial, membranes.position[0].size());
    };
    for (std::size_t l = 0; l < type.laws.size(); ++l) {
      Law& law = type.laws[l];
      for (const StateVariable& variable : law.model.state)
        law.state.push_back(keep(static_cast<int>(l), law.model.id, variable));
    }
    if (type.tension_by_rate) type.rate_tension = keep(-1, "", {"rate_tension", 0, tension_unit});
    for (int k = 0; k < 2 && type.filter; ++k)
      type.held_force[k] = keep(-1, "", {k == 0 ? "held_force_x" : "held_force_y", 0, tension_unit});
  }
}

}  // namespace rouleau::core
