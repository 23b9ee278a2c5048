// What the membrane laws of each cell type need, give and remember, found out before the first step.
#include <algorithm>
#include <array>
#include <string>

#include "membrane_forces.hpp"
#include "stiffness.hpp"

namespace rouleau::membrane {

namespace {

constexpr int pack_margin = 8;  // doubles in the widest pack

}  // namespace

MembraneForces::Law MembraneForces::describe(std::shared_ptr<const plugin::ModelInstance> model) {
  const plugin::Manifest& manifest = model->manifest();
  static constexpr std::array known = {"stretch", "stretch_rate", "curvature", "rest_curvature",
                                       "area",    "rest_area",    "perimeter", "rest_perimeter"};
  for (const std::string& need : manifest.needs) {
    if (std::find(known.begin(), known.end(), need) == known.end()) {
      throw Error(ExitCode::plugin_refused, Place{manifest.file.string(), "/needs"},
                  "membrane law \"" + manifest.id + "\" needs \"" + need + "\", which this program does not give.");
    }
  }
  const auto needs = [&](const char* input) { return manifest.needs_input(input); };
  const auto gives = [&](const char* output) { return manifest.gives_output(output); };
  return {std::move(model),           needs("stretch"), needs("stretch_rate"),    needs("curvature"),
          needs("rest_curvature"),    needs("area"),    needs("rest_area"),       needs("perimeter"),
          needs("rest_perimeter"),    gives("tension"), gives("moment"),          gives("pressure"),
          gives("perimeter_tension"), gives("energy"),  gives("tension_by_rate"), {}};
}

MembraneForces::MembraneForces(const Membranes& membranes, std::vector<MembraneLaws> laws) {
  for (MembraneLaws& list : laws) {
    Type& type = types_.emplace_back();
    for (auto& model : list) {
      const Law& law = type.laws.emplace_back(describe(std::move(model)));
      type.rate |= law.stretch_rate || law.tension_by_rate;
      type.tension_by_rate |= law.tension_by_rate;
      has_state_ = has_state_ || law.tension_by_rate || !law.model->manifest().state.empty();
      type.tension |= law.tension;
      type.moment |= law.moment || law.curvature;
      type.cell |= law.pressure || law.perimeter_tension;
    }
  }
  allocate(membranes);
}

void MembraneForces::allocate(const Membranes& membranes) {
  std::size_t size = pack_margin;
  for (const CellRange& cell : membranes.cells) {
    offset_.push_back(size);
    size += static_cast<std::size_t>(cell.count + pack_margin) / pack_margin * pack_margin + 2 * pack_margin;
  }
  Scratch& s = scratch_;
  for (auto* values : {&rest_.inverse_length, &rest_.inverse_weight, &rest_.curvature, &s.x, &s.y, &s.u, &s.v,
                       &s.tangent_x, &s.tangent_y, &s.inverse_length, &s.stretch, &s.rate, &s.curvature, &s.tension,
                       &s.moment, &s.law, &s.energy, &s.segment_force_x, &s.segment_force_y}) {
    values->assign(size, 0.0);
  }
  if (std::any_of(types_.begin(), types_.end(), [](const Type& type) { return type.tension_by_rate; })) {
    for (auto* values : {&s.by_rate, &s.law_by_rate}) values->assign(size, 0.0);
  }
  for (std::size_t c = 0; c < membranes.cells.size(); ++c) {
    const CellRange& cell = membranes.cells[c];
    for (int k = 0; k < cell.count; ++k) {
      const auto i = static_cast<std::size_t>(cell.first + k), at = offset_[c] + static_cast<std::size_t>(k);
      rest_.inverse_length[at] = 1 / membranes.rest_length[i];
      rest_.inverse_weight[at] = 1 / membranes.rest_weight[i];
      rest_.curvature[at] = membranes.rest_curvature[i];
    }
  }
}

void MembraneForces::make_semi_implicit(const Membranes& membranes, double viscosity) {
  for (const CellRange& cell : membranes.cells) {
    Type& type = types_[static_cast<std::size_t>(cell.type)];
    if (type.filter) continue;
    double stretching = 0, bending = 0;
    for (const Law& law : type.laws) {
      stretching += stretching_stiffness(*law.model);
      bending += bending_stiffness(*law.model);
    }
    const double length = cell.rest_perimeter / cell.count;
    type.filter.emplace(cell.count, length, coupling::stiffening(type.slip.shift, length), viscosity, stretching,
                        bending);
    has_state_ = true;
  }
}

void MembraneForces::keep_state(Membranes& membranes) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    Type& type = types_[t];
    const auto keep = [&](int law, const std::string& model, const plugin::StateVariable& variable, double initial) {
      return membrane::keep_state(
          membranes.state, {static_cast<int>(t), law, model, variable.name, variable.unit, variable.dimension, {}},
          initial, membranes.x.size());
    };
    for (std::size_t l = 0; l < type.laws.size(); ++l) {
      Law& law = type.laws[l];
      const plugin::Manifest& manifest = law.model->manifest();
      law.state.clear();
      for (std::size_t k = 0; k < manifest.state.size(); ++k) {
        law.state.push_back(keep(static_cast<int>(l), manifest.id, manifest.state[k], law.model->initial_state()[k]));
      }
    }
    if (type.tension_by_rate)
      type.rate_tension = keep(-1, "", {"rate_tension", "N/m", units::dimension::tension, 0}, 0);
    for (int k = 0; k < 2 && type.filter; ++k) {
      type.held_force[k] =
          keep(-1, "", {k == 0 ? "held_force_x" : "held_force_y", "N/m", units::dimension::tension, 0}, 0);
    }
  }
  state_kept_ = true;
}

}  // namespace rouleau::membrane
