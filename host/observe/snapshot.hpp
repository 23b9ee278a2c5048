// What one output time looks like: cells, aggregates, stresses and, when due, fields. Everything in SI units.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rouleau::observe {

struct CellSnapshot {
  int cell;  ///< its number in the scene, from 0, which no other cell gets when it has left
  std::string type;
  double x, y;         ///< centroid, m; x is not wrapped into the box
  double angle;        ///< of the long axis of the inertia ellipse, rad, continuous in time; NaN for a circle
  double deformation;  ///< (L - B) / (L + B) of the inertia ellipse
  /// m2 and m, of an outline; none of a surface.
  std::optional<double> area = {}, perimeter = {};
  double tank_treading_angle;  ///< of the first node about the centroid, rad, continuous in time
  double min_gap;      ///< m, to the nearest membrane of another cell or of an image; infinite when there is none
  double wall_gap;     ///< m, to the nearer wall; NaN without walls
  int aggregate;       ///< label: smallest index of a cell of the aggregate it belongs to
  bool through_image;  ///< its aggregate is held together by a contact across the periodic boundary
  int bonded;          ///< likewise a label, of the cells that bonds join (Snapshot::bonds); its own where none does
  double stretch_min, stretch_max;  ///< of its segments or edges: length over rest length
  double length_along_force = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN: none acts on the cell
  double width_across_force = length_along_force;                        ///< m, likewise
  // Of a surface, angle and deformation of which are those of the plane of x and y; 0 of an outline.
  double z = 0;                        ///< centroid, m
  double volume = 0;                   ///< m3
  double surface_area = 0;             ///< m2
  std::array<double, 3> semi_axes{};   ///< m, of the inertia ellipsoid, largest first
  std::array<double, 3> short_axis{};  ///< unit vector, its first component that is not 0 positive
  std::array<double, 3> extent{};      ///< m, along x, y and z
  double velocity = 0;                 ///< m/s, along x, mean over what the cell encloses
  double treading = 0;                 ///< 1/s, turns of the membrane within its shape, counter-clockwise about z
  double rear_hollow = 0;  ///< m, along x from the rim at the rear to the membrane on the line through the centroid
  double offset_from_axis = 0;  ///< m, of the centroid from the middle between walls; NaN where there is no such axis
};

/// Two cells (or a cell and an image) whose gap is below Output::aggregate_gap.
struct ContactSnapshot {
  int cell_a, cell_b;
  std::array<int, 3> image;  ///< periodic shift of cell_b, in boxes
  double gap;                ///< m, smallest
  double contact_length =
      std::numeric_limits<double>::quiet_NaN();  ///< m, of an outline a, nearer than the aggregate gap
  double contact_area = std::numeric_limits<double>::quiet_NaN();  ///< m2, the same of a surface
  double bond_share = std::numeric_limits<double>::quiet_NaN();  ///< of the energy that a face would win; NaN: unknown
};

/// Outlines or surfaces of all cells that are there, one after another, as frames keep them.
struct OutlineSnapshot {
  std::vector<int> cell;        ///< their numbers, ascending
  std::vector<int> first;       ///< first node of each of them, and the total at the end
  std::vector<double> x, y, z;  ///< m, not wrapped; the last is empty in two dimensions
  std::vector<double> tension;  ///< N/m of segment i (elastic and viscous laws together); of surfaces, the mean of the
                                ///< triangles around node i
  // Of surfaces.
  std::vector<double> curvature;              ///< 1/m, sum of both principal curvatures at node i, positive where a
                                              ///< surface bulges outward
  std::vector<std::array<int, 3>> triangles;  ///< of nodes, counter-clockwise seen from outside
};

/// A field on the nodes of the fluid or of the membranes, given some at a time so that nobody holds all of it.
struct Field {
  /// Values of the next nodes: of the fluid, those that the scene wants (FieldStorage) in whole rows, x fastest; of
  /// membranes, cell after cell. The components of a node beside each other.
  using Take = std::function<void(const std::vector<double>& values)>;
  std::string name;    ///< velocity, density (relative deviation from the mean), viscosity, vorticity; MembraneSnapshot
  std::string unit;    ///< m/s, 1, Pa s, 1/s
  int components = 1;  ///< 3: a vector, whose last component is 0 in two dimensions
  /// Calls take() on the first rank until it has had all; rows count over y, then over z. All ranks together, and
  /// before the next step.
  std::function<void(const Take& take)> give;
};

/// What ranks do that do not write: they give their part to the one that does.
inline void give_all(const std::vector<Field>& fields) {
  for (const Field& field : fields) field.give([](const std::vector<double>&) {});
}

using Triangles = std::vector<std::array<int, 3>>;

/// Outlines or surfaces of all cells that are there, one after another. Without cells in the scene there are no fields.
struct MembraneSnapshot {
  std::vector<int> cell;      ///< their numbers, ascending
  std::vector<int> first;     ///< first node of each of them, and the total at the end
  std::vector<Field> fields;  ///< points, tension and, of surfaces, curvature (as OutlineSnapshot has them)
  /// Of surfaces: the triangles of the cell of this number, their nodes counted from its first; null of outlines.
  std::function<const Triangles&(int cell)> triangles = nullptr;
  [[nodiscard]] bool empty() const { return fields.empty(); }
};

/// The fields that the scene wants. Empty: not due.
struct FieldSnapshot {
  int nx = 0, ny = 0;
  int nz = 1;  ///< 1 in two dimensions
  std::vector<Field> fields;
  std::vector<Field> on_walls;  ///< of the facets of WallBorder: wall_shear_stress, if it is wanted
  [[nodiscard]] bool empty() const { return nx == 0; }
};

/// Energies and powers per depth, in three dimensions that of the domain along z (docs: physics, energy); NaN where the
/// scene has no such thing, or nobody tells it.
struct EnergySnapshot {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double kinetic = none, elastic = none, bending = none, interaction = none, total = none;  ///< J/m
  double viscous_dissipation = none, membrane_dissipation = none;                           ///< W/m, lost
  double wall_power = none, body_force_power = none, external_power = none;                 ///< W/m, put in
  std::string unknown;  ///< why the total is not known; empty: it is
};

/// Up to so many cells a run remembers of each at every output what its summary says of it: of more, that would take
/// more memory than anything else. Tables have all of them.
inline constexpr std::size_t most_cells_remembered = 10'000;

struct Snapshot {
  long step = 0;
  double time = 0;    ///< s since the first stage began
  double strain = 0;  ///< accumulated over the stages
  int stage = 0;
  std::string stage_name;
  int dimension = 2;
  std::vector<CellSnapshot> cells;  ///< those that are there, by their numbers
  std::vector<ContactSnapshot> contacts;
  std::vector<ContactSnapshot> bonds;  ///< pairs of different cells that are joined, close or not
  bool attracts = false;               ///< whether any could be: else nothing is said of bonds
  int aggregate_count = 0;             ///< single cells count too
  /// Angle of the line through an aggregate's outermost cells against x, rad, by its label, followed over turns while
  /// its members stay the same. Not there for lone cells, nor where an aggregate closed through images has no ends.
  std::map<int, double> rotation;
  std::map<int, int> aggregate_sizes;     ///< number of aggregates by their number of cells
  double aggregate_size_number_mean = 0;  ///< cells per aggregate; NaN without cells
  double aggregate_size_weight_mean = 0;  ///< cells in the aggregate of a cell, averaged over cells; NaN without cells
  std::map<int, int> bonded_sizes = {};   ///< as aggregate_sizes, by bonds
  double bonded_size_number_mean = std::numeric_limits<double>::quiet_NaN(),
         bonded_size_weight_mean = bonded_size_number_mean;  ///< likewise; NaN where nothing attracts
  double contacts_per_cell = 0, contact_gap = 0;             ///< of close cells; m, mean of them; NaN without
  double relative_viscosity = 0;  ///< wall shear stress / (viscosity x shear rate), or of the flow rate; NaN: neither
  double shear_rate = 0;          ///< 1/s, of the walls over the last step; NaN where they do not move
  double wall_stress_lower = 0, wall_stress_upper = 0;  ///< Pa, on each wall along x; NaN without
  double pressure_gradient = 0;     ///< Pa/m, that drives the fluid beside fluid.body_force; NaN where none does
  double flow_rate = 0;             ///< m2/s, per depth, of a driven channel; NaN elsewhere
  double mean_velocity = 0;         ///< m/s, of a driven channel: the flow rate over the cross-section; NaN elsewhere
  double discharge_hematocrit = 0;  ///< flux of cells over the flow rate; NaN where there is none, or no cells
  double inlet_flow = std::numeric_limits<double>::quiet_NaN(),
         outlet_flow = inlet_flow;  ///< m2/s, in three dimensions m3/s, along the open axis; NaN without openings
  double inlet_pressure = inlet_flow, outlet_pressure = inlet_flow;  ///< Pa, likewise
  std::array<std::vector<double>, 2> opening_flow{};                 ///< of each opening of both ends, as inlet_flow
  std::array<std::vector<double>, 2> volume_through{};  ///< m2 or m3, likewise, since the run began (CellTraffic)
  double cell_free_layer_lower = 0, cell_free_layer_upper = 0;  ///< m; NaN without walls or cells
  double cell_free_layer_empty = 0;  ///< share of the columns in which there is no cell; NaN as the layers
  double particle_stress = 0;        ///< xy, Pa: membranes and viscosity contrast, per area of the domain
  double first_normal_stress = std::numeric_limits<double>::quiet_NaN(),
         second_normal_stress = first_normal_stress;  ///< Pa, differences of the same, xx - yy and yy - zz
  std::vector<double> velocity_profile = {}, hematocrit_profile = {};  ///< m/s, 1, in each bin; empty: not wanted
  double mach_max = 0;
  double area_drift_max = 0;  ///< relative
  double area_leakage_max =
      0;  ///< relative: what the area correction kept from leaking within a strain of one, of the worst cell
  double mass_drift = 0;                               ///< relative
  long cells_in = 0, cells_inside = 0, cells_out = 0;  ///< since the run began (CellTraffic)
  std::array<std::vector<long>, 2> cells_through{};    ///< in less out, of each opening; those without cells may lack
  EnergySnapshot energy;
  MembraneSnapshot membranes;
  FieldSnapshot fields;
};

}  // namespace rouleau::observe
