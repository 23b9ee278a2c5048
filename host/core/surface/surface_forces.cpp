#include "surface_forces.hpp"

#include <cmath>
#include <stdexcept>

#include "core/domain/run_loop.hpp"
#include "core/membrane/stiffness.hpp"

namespace rouleau::core {

namespace {

double weighted_sum(const std::vector<double>& values, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += values[i] * weights[i];
  return sum;
}

}  // namespace

SurfaceForces::Law SurfaceForces::describe(const MembraneLaw& model) {
  if (!model.state.empty()) {
    throw std::invalid_argument("\"" + model.id + "\" remembers \"" + model.state[0].name +
                                "\", which surfaces of triangles have no place for yet");
  }
  const bool viscous = model.writes("shear_viscosity") || model.writes("area_viscosity");
  const bool triangle = model.writes("stress_1") || model.writes("stress_2") || viscous;
  const bool cell = model.writes("pressure") || model.writes("surface_tension");
  if (!triangle && !cell && !model.writes("moment") && !model.writes("area_tension"))
    throw std::invalid_argument("\"" + model.id + "\" is no law of surfaces in three dimensions");
  auto element = Law::Element::area;
  if (model.writes("moment")) element = Law::Element::curvature;
  if (cell) element = Law::Element::cell;
  if (triangle) element = Law::Element::triangle;
  return {model, element, model.writes("energy"), viscous};
}

SurfaceForces::Type SurfaceForces::prepare(const RestSurface& rest, const MembraneLaws& laws) {
  const Mesh& mesh = rest.mesh;
  Type type(mesh);
  type.edges = mesh.edge_count();
  for (const MembraneLaw& model : laws) {
    const Law& law = type.laws.emplace_back(describe(model));
    type.triangle |= law.element == Law::Element::triangle;
    type.curvature |= law.element == Law::Element::curvature;
    type.area |= law.element == Law::Element::area;
    type.cell |= law.element == Law::Element::cell;
  }
  // The last triangle and the last edge stand for those that fill the last pack.
  for (int t = 0; t < type.mesh.size; ++t) {
    const int from = std::min(t, type.mesh.count - 1);
    for (int k = 0; k < 3; ++k) type.triangle_edge[k].push_back(mesh.triangle_edges()[from][k]);
    type.inverse[0].push_back(rest.inverse_11[from]);
    type.inverse[1].push_back(rest.inverse_12[from]);
    type.inverse[2].push_back(rest.inverse_22[from]);
    type.rest_area.push_back(rest.triangle_area[from]);
  }
  for (int e = 0; e < padded(type.edges); ++e) {
    const Mesh::Edge& edge = mesh.edges()[std::min(e, type.edges - 1)];
    type.edge_node[0].push_back(edge.a);
    type.edge_node[1].push_back(edge.b);
    type.edge_triangle[0].push_back(edge.left);
    type.edge_triangle[1].push_back(edge.right);
  }
  for (int i = 0; i < mesh.node_count(); ++i) {
    type.inverse_node_area.push_back(1 / rest.node_area[i]);
    type.area_share.push_back(rest.node_area[i] / (3 * rest.third_area[i]));
  }
  return type;
}

SurfaceForces::SurfaceForces(const Surfaces& surfaces, const std::vector<MembraneLaws>& laws)
    : scratch_(surfaces.cells.size()) {
  for (std::size_t t = 0; t < surfaces.types.size(); ++t) types_.push_back(prepare(*surfaces.types[t], laws[t]));
}

void SurfaceForces::take_semi_implicit_steps(Surfaces& surfaces, double viscosity, double tension_unit,
                                             const std::vector<KernelResponse>& responses) {
  constexpr std::array names{"held_force_x", "held_force_y", "held_force_z"};
  for (std::size_t t = 0; t < types_.size(); ++t) {
    Type& type = types_[t];
    Stiffness stiffness;
    for (const Law& law : type.laws) stiffness += law.model;
    type.filter.emplace(*surfaces.types[t], viscosity, stiffness.stretching, stiffness.bending, responses[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      // Over the spacing, which all stages share, a force has the unit of a tension.
      type.held_force[k] = keep_state(surfaces.state, {static_cast<int>(t), -1, "", names[k], tension_unit, {}}, 0,
                                      surfaces.position[0].size());
    }
  }
}

void SurfaceForces::take_viscosity(Surfaces& surfaces, const std::vector<double>& moduli, double tension_unit) {
  for (std::size_t t = 0; t < types_.size(); ++t)
    if (types_[t].viscous()) types_[t].viscosity.emplace(surfaces, static_cast<int>(t), moduli[t], tension_unit);
}

SurfaceForces::Scratch& SurfaceForces::scratch_of(int first_cell) {
  Scratch& s = scratch_.of(first_cell);
  if (!s.energy.empty()) return s;
  std::size_t triangles = 0, edges = 0, nodes = 0;
  for (const Type& type : types_) {
    triangles = std::max(triangles, type.rest_area.size());
    edges = std::max(edges, type.edge_node[0].size());
    nodes = std::max(nodes, type.inverse_node_area.size());
  }
  const auto make = [](auto& arrays, std::size_t size) {
    for (auto& array : arrays) array.assign(size, 0.0);
  };
  make(s.side[0], triangles);
  make(s.side[1], triangles);
  make(s.normal, triangles);
  make(s.invariant, triangles);
  make(s.stress, triangles);
  make(s.force, 3 * triangles);
  if (std::ranges::any_of(types_, &Type::viscous)) s.straining.resize(triangles);
  make(s.law, std::max(triangles, nodes));
  for (auto* array : {&s.turned_length, &s.edge_turn}) array->assign(edges, 0.0);
  for (auto* array : {&s.curvature, &s.area_ratio, &s.node_moment, &s.node_pull}) array->assign(nodes, 0.0);
  s.energy.assign(std::max(triangles, nodes), 0.0);
  return s;
}

SurfaceArrays SurfaceForces::arrays_of(const Type& type, Scratch& s) {
  SurfaceArrays arrays{};
  arrays.triangles = type.mesh.count;
  arrays.edges = type.edges;
  point_into(arrays.corner, type.mesh.corner), point_into(arrays.edge, type.triangle_edge);
  point_into(arrays.edge_node, type.edge_node), point_into(arrays.edge_triangle, type.edge_triangle);
  point_into(arrays.side[0], s.side[0]), point_into(arrays.side[1], s.side[1]);
  point_into(arrays.inverse, type.inverse);
  arrays.rest_area = type.rest_area.data();
  arrays.invariant_1 = s.invariant[0].data(), arrays.invariant_2 = s.invariant[1].data();
  point_into(arrays.normal, s.normal);
  arrays.stress_1 = s.stress[0].data(), arrays.stress_2 = s.stress[1].data();
  for (std::size_t k = 0; k < 3; ++k)
    point_into(arrays.force[k], s.force, k * static_cast<std::size_t>(type.mesh.size));
  arrays.turned_length = s.turned_length.data(), arrays.edge_turn = s.edge_turn.data();
  arrays.node_moment = s.node_moment.data(), arrays.node_pull = s.node_pull.data();
  point_into(arrays.viscous, s.straining.stress);
  arrays.with_moment = type.curvature, arrays.with_area_pull = type.area;
  arrays.with_viscosity = type.viscosity.has_value();
  return arrays;
}

SurfaceForces::Whole SurfaceForces::measure(const Type& type, Nodes nodes, Scratch& s) {
  SurfaceArrays arrays = arrays_of(type, s);
  arrays.place[0] = nodes.x, arrays.place[1] = nodes.y, arrays.place[2] = nodes.z;
  run_loop<MeasureTriangles>(arrays);
  if (type.curvature) {
    run_loop<MeasureEdges>(arrays);
    std::fill(s.curvature.begin(), s.curvature.end(), 0.0);
    for (int e = 0; e < type.edges; ++e) {
      s.curvature[type.edge_node[0][e]] += 0.5 * s.turned_length[e];
      s.curvature[type.edge_node[1][e]] += 0.5 * s.turned_length[e];
    }
    for (std::size_t i = 0; i < type.inverse_node_area.size(); ++i) s.curvature[i] *= type.inverse_node_area[i];
  }
  Whole whole;
  if (type.area) std::fill(s.area_ratio.begin(), s.area_ratio.end(), 0.0);
  if (type.area || type.cell) {
    const Vec<3> origin = nodes[0];
    for (int t = 0; t < type.mesh.count; ++t) {
      const Vec<3> normal(s.normal[0][t], s.normal[1][t], s.normal[2][t]);
      const double twice = normal.norm();
      whole.surface_area += twice / 2;
      whole.volume += (nodes[type.mesh.corner[0][t]] - origin).dot(normal) / 6;
      for (int k = 0; k < 3 && type.area; ++k) s.area_ratio[type.mesh.corner[k][t]] += twice / 2;
    }
    for (std::size_t i = 0; i < type.area_share.size() && type.area; ++i)
      s.area_ratio[i] *= type.area_share[i] * type.inverse_node_area[i];
  }
  return whole;
}

void SurfaceForces::apply(const Type& type, const RestSurface& rest, Scratch& s, Whole& whole, MembraneEnergy* energy) {
  const auto triangles = static_cast<std::size_t>(type.mesh.count), nodes = type.inverse_node_area.size();
  for (auto& stress : s.stress) std::fill(stress.begin(), stress.end(), 0.0);
  if (type.viscosity)
    for (auto& viscosity : s.straining.viscosity) std::fill(viscosity.begin(), viscosity.end(), 0.0);
  if (type.curvature) std::fill(s.node_moment.begin(), s.node_moment.end(), 0.0);
  if (type.area) std::fill(s.node_pull.begin(), s.node_pull.end(), 0.0);
  for (const Law& law : type.laws) {
    rouleau_membrane_block block{};
    block.struct_size = sizeof block;
    if (energy != nullptr && law.energy) block.energy = s.energy.data();
    const auto given = [&](const char* name, const double* input) { return law.model.reads(name) ? input : nullptr; };
    const auto wanted = [&](const char* name, double* output) { return law.model.writes(name) ? output : nullptr; };
    const auto add = [&](const double* output, const std::vector<double>& from, std::vector<double>& sum,
                         std::size_t count) {
      for (std::size_t i = 0; i < count && output != nullptr; ++i) sum[i] += from[i];
    };
    double pressure = 0, surface_tension = 0;
    switch (law.element) {
      case Law::Element::triangle:
        block.count = static_cast<std::uint32_t>(triangles);
        block.invariant_1 = given("invariant_1", s.invariant[0].data());
        block.invariant_2 = given("invariant_2", s.invariant[1].data());
        block.stress_1 = wanted("stress_1", s.law[0].data());
        block.stress_2 = wanted("stress_2", s.law[1].data());
        block.shear_viscosity = wanted("shear_viscosity", s.law[2].data());
        block.area_viscosity = wanted("area_viscosity", s.law[3].data());
        break;
      case Law::Element::curvature:
        block.count = static_cast<std::uint32_t>(nodes);
        block.curvature = given("curvature", s.curvature.data());
        block.rest_curvature = given("rest_curvature", rest.rest_curvature.data());
        block.moment = s.law[0].data();
        break;
      case Law::Element::area:
        block.count = static_cast<std::uint32_t>(nodes);
        block.area_ratio = given("area_ratio", s.area_ratio.data());
        block.area_tension = s.law[0].data();
        break;
      case Law::Element::cell:
        block.count = 1;
        block.volume = given("volume", &whole.volume);
        block.rest_volume = given("rest_volume", &rest.rest_volume);
        block.surface_area = given("surface_area", &whole.surface_area);
        block.rest_surface_area = given("rest_surface_area", &rest.rest_surface_area);
        block.pressure = wanted("pressure", &pressure);
        block.surface_tension = wanted("surface_tension", &surface_tension);
        break;
    }
    law.model.compute(&block);
    add(block.stress_1, s.law[0], s.stress[0], triangles);
    add(block.stress_2, s.law[1], s.stress[1], triangles);
    add(block.shear_viscosity, s.law[2], s.straining.viscosity[0], triangles);
    add(block.area_viscosity, s.law[3], s.straining.viscosity[1], triangles);
    add(block.moment, s.law[0], s.node_moment, nodes);
    add(block.area_tension, s.law[0], s.node_pull, nodes);
    whole.pressure += pressure;
    whole.surface_tension += surface_tension;
    if (energy == nullptr) continue;
    if (!law.energy) {
      // A law that only resists the rate of strain stores nothing.
      if (!law.viscous || law.model.writes("stress_1") || law.model.writes("stress_2")) energy->unknown = law.model.id;
    } else if (law.element == Law::Element::triangle) {
      energy->tension += weighted_sum(s.energy, rest.triangle_area);
    } else if (law.element == Law::Element::curvature) {
      energy->bending += weighted_sum(s.energy, rest.node_area);
    } else if (law.element == Law::Element::area) {
      energy->tension += weighted_sum(s.energy, rest.node_area);
    } else {
      energy->cell += s.energy[0];
    }
  }
}

void SurfaceForces::act(const Type& type, const Whole& whole, Scratch& s) {
  if (type.area)
    for (std::size_t i = 0; i < type.area_share.size(); ++i) s.node_pull[i] *= type.area_share[i];
  SurfaceArrays arrays = arrays_of(type, s);
  arrays.pressure = whole.pressure;
  arrays.surface_tension = whole.surface_tension;
  run_loop<ActOnTriangles>(arrays);
}

void SurfaceForces::run(Worker worker, Surfaces& surfaces) {
  const CellNumbers cells = surfaces.own_cells(worker);
  if (cells.empty()) return;
  Scratch& s = scratch_of(cells.first_place());
  for (const int c : cells) {
    const CellRange& cell = surfaces.cells[c];
    const Type& type = types_[cell.type];
    Whole whole = measure(type, type.filter ? look_ahead(surfaces, cell, s) : surfaces.nodes(c), s);
    apply(type, *surfaces.types[cell.type], s, whole, nullptr);
    if (type.viscosity) type.viscosity->step(type.mesh, arrays_of(type, s), surfaces, cell, s.straining);
    act(type, whole, s);
    const std::array<const double*, 3> of_corners{s.force[0].data(), s.force[1].data(), s.force[2].data()};
    for (int i = 0; i < cell.count; ++i) {
      const auto [x, y, z] = type.mesh.sums_of_corners(of_corners, i);
      surfaces.force[0][cell.first + i] = x, surfaces.force[1][cell.first + i] = y,
                                     surfaces.force[2][cell.first + i] = z;
    }
    if (type.filter) soften(type, surfaces, cell, s);
  }
}

Nodes SurfaceForces::look_ahead(const Surfaces& surfaces, const CellRange& cell, Scratch& s) {
  const auto add = [&](const std::vector<double>& place, const std::vector<double>& step, std::vector<double>& to) {
    to.resize(s.curvature.size());
    for (int i = 0; i < cell.count; ++i) to[i] = place[cell.first + i] + step[cell.first + i];
  };
  add(surfaces.position[0], surfaces.velocity[0], s.ahead[0]);
  add(surfaces.position[1], surfaces.velocity[1], s.ahead[1]);
  add(surfaces.position[2], surfaces.velocity[2], s.ahead[2]);
  return {s.ahead[0].data(), s.ahead[1].data(), s.ahead[2].data()};
}

void SurfaceForces::soften(const Type& type, Surfaces& surfaces, const CellRange& cell, Scratch& s) {
  const auto held = [&](int component) { return &surfaces.state[type.held_force[component]].value[cell.first]; };
  type.filter->apply({&surfaces.force[0][cell.first], &surfaces.force[1][cell.first], &surfaces.force[2][cell.first]},
                     {held(0), held(1), held(2)}, s.filtered);
}

MembraneEnergy SurfaceForces::energies(const Surfaces& surfaces, const Ranks<3>& ranks) {
  MembraneEnergySum sum;
  for (const int c : surfaces.own_cells()) {
    const Type& type = types_[surfaces.cells[c].type];
    Scratch& s = scratch_of(0);
    Whole whole = measure(type, surfaces.nodes(c), s);
    MembraneEnergy energy;
    apply(type, surfaces.type_of(c), s, whole, &energy);
    if (type.viscosity)
      energy.dissipation = type.viscosity->power(type.mesh, arrays_of(type, s), surfaces, surfaces.cells[c]);
    sum.add(c, energy);
  }
  return sum.of_all(ranks);
}

std::vector<double> SurfaceForces::curvatures(const Surfaces& surfaces, int cell) {
  const RestSurface& rest = surfaces.type_of(cell);
  std::vector<double> curvature = integrated_curvature(rest.mesh, surfaces.nodes(cell));
  for (std::size_t i = 0; i < curvature.size(); ++i) curvature[i] /= rest.node_area[i];
  return curvature;
}

std::vector<double> SurfaceForces::tensions(const Surfaces& surfaces, int cell) {
  const Type& type = types_[surfaces.cells[cell].type];
  Scratch& s = scratch_of(0);
  Whole whole = measure(type, surfaces.nodes(cell), s);
  apply(type, surfaces.type_of(cell), s, whole, nullptr);
  std::vector<double> tension;
  for (int t = 0; t < type.mesh.count; ++t) {
    // T1 + T2 = 2 ((l1^2 + l2^2) w1 + 2 l1^2 l2^2 w2) / (l1 l2)
    const double squares = s.invariant[0][t] + 2, product = s.invariant[1][t] + 1;
    const double sum = 2 * (squares * s.stress[0][t] + 2 * product * s.stress[1][t]) / std::sqrt(product);
    tension.push_back(sum / 2 + whole.surface_tension);
  }
  return tension;
}

}  // namespace rouleau::core
