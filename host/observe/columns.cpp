#include "columns.hpp"

#include <iterator>
#include <optional>
#include <span>
#include <string>

#include "rotation.hpp"

namespace rouleau::observe {

namespace {

template <auto member>
Value output(const Row& row) {
  return row.output.*member;
}
template <auto member>
Value energy(const Row& row) {
  return row.output.energy.*member;
}
template <auto member>
Value cell(const Row& row) {
  return row.cell->*member;
}
template <auto member, std::size_t axis>
Value cell(const Row& row) {
  return (row.cell->*member)[axis];
}
/// Of an outline; empty of a surface.
template <auto member>
Value of_outline(const Row& row) {
  const std::optional<double>& value = row.cell->*member;
  return value ? Value(*value) : Value();
}
template <auto member>
Value aggregate(const Row& row) {
  return row.aggregate->*member;
}
template <auto member>
Value contact(const Row& row) {
  return row.contact != nullptr ? Value(row.contact->*member) : Value();
}
template <std::size_t axis>
Value image(const Row& row) {
  return row.contact != nullptr ? Value(row.contact->image[axis]) : Value();
}

Value rotation_of_aggregate(const Row& row) {
  const auto found = row.output.rotation.find(row.aggregate->label);
  return found != row.output.rotation.end() ? Value(found->second) : Value();
}

/// In every row of many contacts the file would grow with the square of the number of cells.
Value members_of_aggregate(const Row& row) {
  constexpr int few = 16;
  const AggregateMembers& aggregate = *row.aggregate;
  const bool first = row.contact == nullptr || row.contact == aggregate.contacts.front();
  if (aggregate.count > few && !first) return std::string();
  return aggregate.members;
}

// Name, unit, doc, value and, where a chart draws it, its title and the name of the line.

/// What every table begins with.
/// The column with a mark of those that say when it is there, or that it has means.
template <auto mark>
constexpr Observable marked(Observable column) {
  column.*mark = true;
  return column;
}

constexpr Observable mean(Observable column) { return marked<&Observable::has_means>(column); }
constexpr Observable of_space(Observable column) { return marked<&Observable::in_space>(column); }
constexpr Observable of_bonds(Observable column) { return marked<&Observable::of_interactions>(column); }
constexpr Observable bonds_mean(Observable column) { return mean(of_bonds(column)); }

constexpr Observable instant_columns[] = {
    {"step", "", "number of the step, over all stages", output<&Snapshot::step>},
    {"time", "s", "simulated time since the first stage began", output<&Snapshot::time>},
    {"strain", "", "summed over the stages", output<&Snapshot::strain>},
};

constexpr Observable cell_columns[] = {
    {"cell", "",
     "number of the cell, from 0 in the scene's order; no other cell gets it. A row is there while the cell is",
     cell<&CellSnapshot::cell>},
    {"type", "", "its type", cell<&CellSnapshot::type>},
    {"x", "m", "centroid of what the membrane encloses; not wrapped into the periodic box", cell<&CellSnapshot::x>},
    {"y", "m", "likewise", cell<&CellSnapshot::y>},
    {"angle", "rad", "of the long axis against x, counter-clockwise, followed over turns; `nan` for a circle",
     cell<&CellSnapshot::angle>, "Angle of the long axis"},
    {"deformation", "", "(L - B)/(L + B) with the axes L > B of the inertia ellipse", cell<&CellSnapshot::deformation>,
     "Deformation (L − B)/(L + B)"},
    {"area", "m2", "that the outline encloses; empty in three dimensions", of_outline<&CellSnapshot::area>},
    {"perimeter", "m", "of the outline; empty in three dimensions", of_outline<&CellSnapshot::perimeter>},
    {"min_gap", "m", "to the nearest outline of another cell or of any periodic image; `inf` where there is none",
     cell<&CellSnapshot::min_gap>, "Smallest gap to another cell"},
    {"wall_gap", "m",
     "smallest distance of the membrane's nodes to a wall, whatever its shape; negative beyond it, `nan` without "
     "walls",
     cell<&CellSnapshot::wall_gap>, "Smallest gap to a wall"},
    {"aggregate", "", "label of the cell's aggregate: the smallest number of its cells",
     cell<&CellSnapshot::aggregate>},
    of_bonds({"bonded", "", "the same of the cells that bonds join: `output.bond_share`", cell<&CellSnapshot::bonded>}),
    {"tank_treading_angle", "rad",
     "of the outline's first node about the centroid, followed over turns; of a surface that of the node "
     "that was farthest from its axis along z at the start",
     cell<&CellSnapshot::tank_treading_angle>},
    {"through_image", "", "1 where the aggregate is held together through the periodic border",
     cell<&CellSnapshot::through_image>},
    {"stretch_min", "", "smallest stretch of a segment of the cell, length over rest length",
     cell<&CellSnapshot::stretch_min>},
    {"stretch_max", "", "largest stretch of a segment of the cell", cell<&CellSnapshot::stretch_max>},
};

constexpr Observable aggregate_columns[] = {
    {"aggregate_count", "", "number of aggregates; single cells included", output<&Snapshot::aggregate_count>},
    {"aggregate", "", "label: the smallest number of its cells", aggregate<&AggregateMembers::label>},
    {"members", "", "its cells, joined by `+`; of an aggregate of more than 16 cells they stand in its first row alone",
     members_of_aggregate},
    {"through_image", "", "1 where it is held together through the periodic border",
     aggregate<&AggregateMembers::through_image>},
    {"rotation", "rad", "angle of the line through its two outermost cells", rotation_of_aggregate},
    {"cell_a", "", "one cell of a contact", contact<&ContactSnapshot::cell_a>},
    {"cell_b", "", "the other; the same where a cell touches its own image", contact<&ContactSnapshot::cell_b>},
    {"image_x", "", "periodic shift of `cell_b` along x, in boxes", image<0>},
    {"image_y", "", "along y", image<1>},
    {"gap", "m", "smallest gap between the two", contact<&ContactSnapshot::gap>},
    {"contact_length", "m", "rest length of `cell_a`'s membrane that is nearer to `cell_b` than `aggregate_gap`",
     contact<&ContactSnapshot::contact_length>},
    of_space({"image_z", "", "along z", image<2>}),
    of_space({"contact_area", "m2", "rest area of `cell_a`'s surface nearer to the other than the aggregate gap",
              contact<&ContactSnapshot::contact_area>}),
    of_bonds({"bond_share", "",
              "energy that the two have won, over what a face of the smaller would; `nan` where no well is known",
              contact<&ContactSnapshot::bond_share>}),
};

constexpr Observable series_columns[] = {
    {"stage", "", "number of the stage, from 0", output<&Snapshot::stage>},
    {"stage_name", "", "its name", output<&Snapshot::stage_name>},
    {"aggregate_count", "", "number of aggregates; single cells included", output<&Snapshot::aggregate_count>,
     "Aggregates, single cells included"},
    {"rotation", "rad",
     "that of the largest aggregate in aggregates.csv (of equal ones the first); `nan` where it has none",
     [](const Row& row) -> Value { return largest_rotation(row.output); }},
    mean({"relative_viscosity", "",
          "in shear by the stress on the walls, in a driven flow by the flow rate; `nan` elsewhere",
          output<&Snapshot::relative_viscosity>, "Relative viscosity"}),
    {"shear_rate", "1/s",
     "of the walls during the last step: speed of the upper less that of the lower, over the height; `nan` "
     "where they do not move",
     output<&Snapshot::shear_rate>},
    mean({"wall_stress_lower", "Pa",
          "mean shear stress on the lower wall along +x in the last step; `nan` without walls and before they act",
          output<&Snapshot::wall_stress_lower>}),
    mean({"wall_stress_upper", "Pa", "likewise, on the upper wall", output<&Snapshot::wall_stress_upper>}),
    mean({"pressure_gradient", "Pa/m",
          "force per volume along x that drives the fluid at this instant, beside `fluid.body_force`; `nan` "
          "where the stage has none",
          output<&Snapshot::pressure_gradient>}),
    {"particle_stress", "Pa",
     "xy stress that the cells add: all forces on membranes, between cells too, and viscosity contrast, "
     "per area of the domain",
     output<&Snapshot::particle_stress>, "Particle stress xy"},
    mean({"first_normal_stress", "Pa",
          "first normal stress difference that the cells add, xx less yy: positive where they pull along x",
          output<&Snapshot::first_normal_stress>}),
    of_space(
        mean({"second_normal_stress", "Pa", "the second one, yy less zz", output<&Snapshot::second_normal_stress>})),
    {"mach_max", "", "largest Mach number of the lattice flow at this instant", output<&Snapshot::mach_max>,
     "Largest Mach number"},
    {"area_drift_max", "", "largest relative change of a cell's area since the start, of all cells, at this instant",
     output<&Snapshot::area_drift_max>, "Largest relative area drift"},
    {"mass_drift", "",
     "largest relative change of the fluid's mass within a stage, so far; "
     "between openings, beyond what came in and left, over what was there and came in",
     output<&Snapshot::mass_drift>, "Relative mass drift"},
    {"area_leakage_max", "",
     "largest change of a cell's area or volume that `numerics.area_correction` put back; `nan` without it",
     output<&Snapshot::area_leakage_max>, "Largest area kept from leaking, relative"},
    mean({"flow_rate", "m2/s",
          "of a driven channel, per depth: integral of the velocity over the cross-section; `nan` elsewhere",
          output<&Snapshot::flow_rate>}),
    mean({"mean_velocity", "m/s", "of a driven channel, along x: the flow rate over the cross-section; `nan` elsewhere",
          output<&Snapshot::mean_velocity>}),
    mean({"cell_free_layer_lower", "m",
          "mean distance from the lower wall to the nearest membrane; `nan` without walls or cells",
          output<&Snapshot::cell_free_layer_lower>, "Cell-free layer", "lower wall"}),
    mean({"cell_free_layer_upper", "m", "likewise, from the upper wall", output<&Snapshot::cell_free_layer_upper>,
          "Cell-free layer", "upper wall"}),
    mean({"cell_free_layer_empty", "",
          "share of these columns or rays without a cell: above 0.05 the layers are no result; `nan` as they are",
          output<&Snapshot::cell_free_layer_empty>}),
    mean({"discharge_hematocrit", "",
          "of a driven flow: flux of what the cells enclose over the flux of all; `nan` elsewhere and without cells",
          output<&Snapshot::discharge_hematocrit>, "Discharge hematocrit"}),
    mean({"aggregate_size_number_mean", "", "cells over aggregates; a single cell is an aggregate of one",
          output<&Snapshot::aggregate_size_number_mean>}),
    mean({"aggregate_size_weight_mean", "",
          "size of the aggregate a cell finds itself in, averaged over the cells: sum n^2 / sum n",
          output<&Snapshot::aggregate_size_weight_mean>, "Aggregate size, mean over cells"}),
    bonds_mean({"bonded_size_number_mean", "",
                "cells over aggregates by bonds: `output.bond_share`; `nan` where nothing attracts",
                output<&Snapshot::bonded_size_number_mean>}),
    bonds_mean({"bonded_size_weight_mean", "", "the same, averaged over the cells",
                output<&Snapshot::bonded_size_weight_mean>}),
    mean({"contacts_per_cell", "", "close cells of a cell, images included: mean over the cells",
          output<&Snapshot::contacts_per_cell>}),
    mean({"contact_gap", "m", "smallest gap of two close cells: mean over the pairs; `nan` where none are",
          output<&Snapshot::contact_gap>}),
    {"kinetic_energy", "J/m",
     "of the fluid as it is simulated, `density_factor` times denser than it is; docs/physics.md, "
     "\"Energy\", for this and all below, which are per depth",
     energy<&EnergySnapshot::kinetic>, "Kinetic energy of the fluid as simulated"},
    {"elastic_energy", "J/m", "in the membranes: laws of segments and of whole cells; `nan` without cells",
     energy<&EnergySnapshot::elastic>, "Energy of the cells", "elastic"},
    {"bending_energy", "J/m", "in the membranes: laws of curvature; `nan` without cells",
     energy<&EnergySnapshot::bending>, "Energy of the cells", "bending"},
    {"interaction_energy", "J/m",
     "of the active potentials between cells, and between cells and walls; `nan` where there is none",
     energy<&EnergySnapshot::interaction>, "Energy of the cells", "interaction"},
    {"total_energy", "J/m",
     "the sum of those that there are; `nan` where a law acts whose energy is not known (summary.json says "
     "which)",
     energy<&EnergySnapshot::total>, "Energy of the cells", "total"},
    {"viscous_dissipation", "W/m", "what the fluid's viscosity takes", energy<&EnergySnapshot::viscous_dissipation>,
     "Power", "dissipation in the fluid"},
    {"membrane_dissipation", "W/m", "what viscous membranes and those with a memory take; `nan` without cells",
     energy<&EnergySnapshot::membrane_dissipation>, "Power", "in membranes"},
    {"wall_power", "W/m",
     "what both walls together put in; 0 for walls at rest, `nan` without walls and before they have acted",
     energy<&EnergySnapshot::wall_power>, "Power", "from the walls"},
    {"body_force_power", "W/m",
     "what `fluid.body_force`, the pressure gradient and what balances cells' weight put in; `nan` without any",
     energy<&EnergySnapshot::body_force_power>, "Power", "from the body force"},
    marked<&Observable::of_forces>({"external_power", "W/m",
                                    "what a stage's `forces` and the cells' weight put in; `nan` in a stage without",
                                    energy<&EnergySnapshot::external_power>, "Power", "from forces on cells"}),
};

constexpr Observable size_columns[] = {
    {"cells", "", "the size: cells of an aggregate", [](const Row& row) -> Value { return row.size; }},
    {"aggregates", "", "how many aggregates have it", [](const Row& row) -> Value { return row.aggregates_of_size; }},
    of_bonds({"bonded", "", "how many by bonds: `output.bond_share`",
              [](const Row& row) -> Value { return row.bonded_of_size; }}),
};

std::vector<Observable> with_instant(std::span<const Observable> own) {
  std::vector<Observable> all(std::begin(instant_columns), std::end(instant_columns));
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace

std::vector<Observable> columns_of_cells() {
  std::vector<Observable> all = with_instant(cell_columns);
  const auto add = [&](auto name, auto unit, auto doc, Value (*value)(const Row&)) {
    all.push_back({.name = name, .unit = unit, .doc = doc, .value = value, .in_space = true});
  };
  add("z", "m", "centroid along z", cell<&CellSnapshot::z>);
  add("volume", "m3", "that the surface encloses", cell<&CellSnapshot::volume>);
  add("surface_area", "m2", "of the surface", cell<&CellSnapshot::surface_area>);
  add("semi_axis_a", "m", "largest semi-axis of the ellipsoid that has the enclosed volume's second moments",
      cell<&CellSnapshot::semi_axes, 0>);
  add("semi_axis_b", "m", "its middle semi-axis", cell<&CellSnapshot::semi_axes, 1>);
  add("semi_axis_c", "m", "its smallest semi-axis", cell<&CellSnapshot::semi_axes, 2>);
  add("axis_x", "", "direction of the smallest semi-axis, which is the axis of a red cell: a unit vector",
      cell<&CellSnapshot::short_axis, 0>);
  add("axis_y", "", "likewise", cell<&CellSnapshot::short_axis, 1>);
  add("axis_z", "", "likewise", cell<&CellSnapshot::short_axis, 2>);
  add("extent_x", "m", "length of the cell along x, from its first node to its last", cell<&CellSnapshot::extent, 0>);
  add("extent_y", "m", "likewise, along y", cell<&CellSnapshot::extent, 1>);
  add("extent_z", "m", "likewise, along z", cell<&CellSnapshot::extent, 2>);
  add("tank_treading_frequency", "1/s",
      "turns of the membrane within its shape, counter-clockwise; of a shape round in the plane of x and y all turns",
      cell<&CellSnapshot::treading>);
  add("velocity_x", "m/s", "of the cell along x: mean over what it encloses", cell<&CellSnapshot::velocity>);
  add("velocity_over_mean", "", "that over `mean_velocity_m_per_s` of series.csv; `nan` where this is",
      [](const Row& row) -> Value { return row.cell->velocity / row.output.mean_velocity; });
  add("rear_hollow", "m",
      "depth along x of the hollow at the rear, from its rim to the membrane behind the centroid; `nan` without one",
      cell<&CellSnapshot::rear_hollow>);
  add("offset_from_axis", "m",
      "of the centroid from the axis of a tube or duct, or the plane amid two walls (slipper); `nan` elsewhere",
      cell<&CellSnapshot::offset_from_axis>);
  const auto along_force = [&](auto name, auto doc, Value (*value)(const Row&), auto chart) {
    all.push_back({.name = name, .unit = "m", .doc = doc, .value = value, .chart = chart, .of_forces = true});
  };
  along_force(
      "length_along_force",
      "extent of the membrane's nodes along the first force of the stages that pulls at the cell, or along gravity",
      cell<&CellSnapshot::length_along_force>, "Length along the force");
  along_force("width_across_force",
              "their extent at right angles to it in the plane of x and y; along x where it acts along z",
              cell<&CellSnapshot::width_across_force>, "Width across the force");
  return all;
}
std::vector<Observable> columns_of_aggregates() { return with_instant(aggregate_columns); }
std::vector<Observable> columns_of_series() {
  std::vector<Observable> all = with_instant(series_columns);
  for (const Observable& observable : columns_at_openings()) all.push_back(observable);
  for (const Observable& column : columns_of_traffic()) all.push_back(column);
  return all;
}
std::vector<Observable> columns_of_aggregate_sizes() { return with_instant(size_columns); }

}  // namespace rouleau::observe
