#include "estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/process.hpp"
#include "base/text.hpp"
#include "constants.hpp"
#include "scene/lattice.hpp"
#include "scene/output_schedule.hpp"
#include "shape/extent.hpp"
#include "shape/random_cells.hpp"

namespace rouleau::plan {

namespace {

/// Outputs of a stage behind its first state, its end included; of one that has too many to count, extrapolated.
struct Counts {
  double cells = 0, fields = 0;
};

Counts count_outputs(const scene::Scene& scene, const scene::StageSetting& stage) {
  const scene::OutputSchedule cells(scene.output.cells, stage, true), fields(scene.output.fields, stage, false);
  constexpr int most = 20000;
  Counts counts;
  long step = 0;
  for (int events = 0; events < most; ++events) {
    step = std::min(cells.next(step), fields.next(step));
    if (step >= stage.max_steps) break;
    ++counts.cells;
    if (fields.due(step)) ++counts.fields;
  }
  if (step < stage.max_steps) {
    const double more = static_cast<double>(stage.max_steps) / static_cast<double>(step);
    counts.cells *= more;
    counts.fields *= more;
  }
  ++counts.cells;
  if (!scene.output.fields.never()) ++counts.fields;
  return counts;
}

OutputEstimate estimate_output(const scene::Scene& scene, const std::vector<scene::StageSetting>& stages) {
  OutputEstimate estimate;
  for (const scene::StageSetting& stage : stages) {
    const Counts counts = count_outputs(scene, stage);
    estimate.outputs += counts.cells;
    estimate.field_outputs += counts.fields;
  }
  ++estimate.outputs;  // the first state
  if (!stages.empty() && scene::OutputSchedule(scene.output.fields, stages.front(), false).due(0))
    ++estimate.field_outputs;

  const auto cells = static_cast<double>(shape::cells_at_once(scene).size());
  const double membrane = membrane_nodes(scene);
  const scene::FieldStorage& storage = scene.output.field_storage;
  estimate.fields_compressed = storage.compression > 0 && estimate.field_outputs > 0;
  double nodes = 1;
  for (int axis = 0; axis < scene.domain.dimension(); ++axis) nodes *= storage.count(axis, scene.domain.nodes[axis]);
  double components = 0;
  for (const std::string& quantity : scene.output.quantities)
    components += quantity == "velocity" ? 3 : quantity == "wall_shear_stress" ? 0 : 1;

  constexpr double per_node = 16 + 8 + 4;  // place, tension, aggregate
  estimate.fields_bytes =
      estimate.field_outputs * nodes * components * (storage.precision == scene::Precision::f64 ? 8 : 4);
  estimate.frames_bytes = hdf5::file + estimate.outputs * hdf5::frame + estimate.fields_bytes;
  if (cells > 0)
    estimate.frames_bytes += estimate.outputs * (hdf5::membranes + membrane * per_node) + membrane * 8 +
                             cells * 8;  // and the topology, once
  estimate.frames_bytes += estimate.field_outputs *
                           (hdf5::fields + static_cast<double>(scene.output.quantities.size()) *
                                               (storage.compression > 0 ? hdf5::compressed_dataset : hdf5::dataset));
  estimate.tables_bytes = row::all_headers + estimate.outputs * (cells > 0 ? row::series : row::series_of_fluid);
  if (cells > 0) {
    double names = 0;
    for (const scene::CellPlacement& cell : shape::cells_at_once(scene))
      names += static_cast<double>(scene.cell_types[cell.type].name.size());
    const double of_cell =
        row::cells + (!scene.domain.walled(1) && !scene.domain.has_shapes() ? 0 : row::wall_gap) + row::aggregates;
    estimate.tables_bytes += estimate.outputs * (cells * of_cell + names + row::sizes);
  }
  return estimate;
}

/// A cell's surface, m2, and half of its longest axis.
struct Body {
  double enclosed, area, radius;

  explicit Body(const scene::CellType& type)
      : enclosed(shape::enclosed_by(type)), area(0), radius(shape::shape_radius(type.shape)) {
    const double spacing = shape::node_spacing(type);
    area = std::sqrt(0.75) * spacing * spacing * shape::node_count(type);
  }
  /// What lies outside within this distance, by Steiner's formula.
  [[nodiscard]] double around(double distance) const {
    return distance * (area + 4 * std::numbers::pi * distance * (radius + distance / 3));
  }
  /// Cross-section of all that lies within this distance, the mean over directions.
  [[nodiscard]] double shadow(double distance) const {
    return area / 4 + std::numbers::pi * distance * (2 * radius + distance);
  }
};

template <class Function>
double sum_over_cells(const scene::Scene& scene, Function function) {
  std::vector<double> of_type;
  for (const scene::CellType& type : scene.cell_types) of_type.push_back(function(Body(type)));
  double sum = 0;
  for (const scene::CellPlacement& cell : shape::cells_at_once(scene)) sum += of_type[cell.type];
  return sum;
}

/// Surfaces of other cells within the largest cutoff of a node where cells lie anywhere: those in the free volume,
/// times what lies within the cutoff of one. A half at least, as of a doublet whose faces touch.
double surfaces_near_a_node(const scene::Scene& scene, double cutoff) {
  const double content = scene.domain.content(), cells = static_cast<double>(shape::cells_at_once(scene).size());
  const double room = content - sum_over_cells(scene, [](const Body& body) { return body.enclosed; });
  const double within = sum_over_cells(scene, [&](const Body& body) { return body.around(cutoff); });
  return std::max(0.5, within * (cells - 1) / cells / std::max(room, 0.1 * content));
}

/// Nodes of the lattice in reach of membranes, the inside of cells among them, where cells lie anywhere.
double active_nodes(const scene::Scene& scene, double reach) {
  const double spacing = scene::lattice_spacing(scene), distance = reach * spacing,
               rounding = (cost::nodes_at_once - 1) * spacing;
  const double reached = sum_over_cells(scene, [&](const Body& body) {
    return body.enclosed + body.around(distance) + rounding * body.shadow(distance);
  });
  return scene::fluid_nodes(scene.domain) * -std::expm1(-reached / scene.domain.content());
}

/// Of the lists of contacts in a step, the mean over stages: lists last as long as the fastest cells let them.
double renewals_in_a_step(const Plan& plan) {
  double renewals = 0, steps = 0;
  for (const scene::StageSetting& stage : plan.stages) {
    const double speed = std::max(stage.fastest_wall(), fastest_driven_speed(stage, *plan.scene)),
                 count = static_cast<double>(stage.max_steps);
    renewals += count * std::min(1.0, std::max(1 / cost::lifetime_of_lists, speed / cost::travel_of_lists));
    steps += count;
  }
  return renewals / std::max(steps, 1.0);
}

double cost_of_membrane_node(int dimension, scene::Precision precision, const MembraneScheme& scheme) {
  const cost::OfMembraneNode& of = cost::of_membrane_node[dimension - 2];
  double all = of.alone + scheme.active_nodes * of.active[precision == scene::Precision::f64 ? 1 : 0];
  // The triangles of a surface within the cutoff are as many as its square says; lists reach a spacing farther.
  if (scheme.cutoff > 0) {
    const double listed = scheme.cutoff + 2 * cost::travel_of_lists;
    all += scheme.near * (of.near + of.near_by_square * scheme.cutoff * scheme.cutoff +
                          scheme.renewals * of.listed_by_square * listed * listed);
  }
  if (scheme.sharp_kernel) all += of.sharp_kernel;
  if (scheme.slip_correction) all += scheme.viscosity_contrast ? of.slip_of_contrast : of.slip;
  if (scheme.semi_implicit) all += of.semi_implicit;
  return all;
}

/// Seconds of a step that rows take in three dimensions beside their nodes.
double cost_of_rows(const scene::Scene& scene) {
  const int along = scene.domain.nodes[0];
  const double word = scene.numerics.precision == scene::Precision::f64 ? 8 : 4;
  if (scene.domain.dimension() == 2 || std::fmod(along * word, cost::bytes_of_register) == 0) return 0;
  return scene::fluid_nodes(scene.domain) / along * cost::of_ragged_row;
}

}  // namespace

double membrane_nodes(const scene::Scene& scene) {
  std::vector<double> of_type;
  for (const scene::CellType& type : scene.cell_types) of_type.push_back(shape::node_count(type));
  double nodes = 0;
  for (const scene::CellPlacement& cell : shape::cells_at_once(scene)) nodes += of_type[cell.type];
  return nodes;
}

MembraneScheme membrane_scheme(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  if (scene.domain.dimension() == 2) return {};
  const double cutoff = plan.facts.stages.front().models->cutoff;
  const bool sharp = kernel_named(scene.numerics.kernel).kind == core::KernelKind::sharp6;
  const double reach = cost::reach_of_membranes + (sharp ? 1 : 0) + (scene.numerics.slip_correction ? 1 : 0);
  return {.cutoff = cutoff,
          .near = surfaces_near_a_node(scene, cutoff * scene::lattice_spacing(scene)),
          .renewals = renewals_in_a_step(plan),
          .active_nodes = active_nodes(scene, reach) / std::max(membrane_nodes(scene), 1.0),
          .sharp_kernel = sharp,
          .slip_correction = scene.numerics.slip_correction,
          .viscosity_contrast = plan.viscosity_contrast,
          .semi_implicit = plan.semi_implicit};
}

double step_cost(double lattice_nodes, double membrane_nodes, scene::Precision precision, int dimension,
                 const MembraneScheme& scheme) {
  const double of_node = cost::of_node[dimension - 2][precision == scene::Precision::f64 ? 1 : 0];
  return lattice_nodes * of_node + membrane_nodes * cost_of_membrane_node(dimension, precision, scheme);
}

double membrane_memory(const scene::Scene& scene) {
  return membrane_nodes(scene) * cost::bytes_of_node[scene.domain.dimension() - 2];
}

void require_memory(double bytes, const std::string& what) {
  const double left = available_memory();
  if (bytes <= left) return;
  const auto gigabytes = [](double value) { return number(std::max(value, 0.0) / 1e9, 3) + " GB"; };
  throw Error(Cause::input_output,
              what + " would take " + gigabytes(bytes) + " of memory, and there are " + gigabytes(left),
              {"take fewer nodes or cells, or a machine with more memory"});
}

Estimate estimate(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const double nodes = scene::fluid_nodes(scene.domain);
  const int dimension = scene.domain.dimension(), velocities = cost::velocities[dimension - 2];
  const double membrane = membrane_nodes(scene);
  const double word = scene.numerics.precision == scene::Precision::f64 ? 8 : 4;
  Estimate estimate;
  for (const scene::StageSetting& stage : plan.stages) estimate.steps += static_cast<double>(stage.max_steps);
  estimate.wall_s =
      estimate.steps *
      (step_cost(nodes, membrane, scene.numerics.precision, dimension, membrane_scheme(plan)) +
       (scene.domain.passages ? scene.domain.passages->beside_walls : 0) * cost::of_wall_node[dimension - 2] +
       cost_of_rows(scene));
  estimate.memory_bytes = nodes * word *
                              (velocities + (plan.has_cells ? dimension : 0) +
                               (plan.viscosity_contrast || !scene.fluid.layers.empty() ? 1 : 0)) +
                          membrane_memory(scene);
  estimate.output = estimate_output(scene, plan.stages);
  if (scene.output.checkpoint_seconds) {  // of all nodes of the box, and places and velocities of membranes
    estimate.output.checkpoint_bytes = scene.domain.node_count() * velocities * word +
                                       membrane * dimension * (plan.viscosity_contrast ? 3 : 2) * sizeof(double);
  }
  estimate.wall_s += estimate.output.outputs * membrane * cost::of_membrane_node[dimension - 2].output;
  return estimate;
}

}  // namespace rouleau::plan
