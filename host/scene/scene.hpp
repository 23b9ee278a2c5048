// A scene as the user wrote it: checked, in SI units, with the place of every value for later errors.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "core/geometry/region.hpp"
#include "dimension_words.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "vector.hpp"
#include "wall_shape.hpp"

namespace rouleau::scene {

/// A plugin named by the scene. Its parameters stay as written (JSON) until a manifest gives them unit and meaning.
struct ModelChoice {
  std::string model;          ///< plugin id
  nlohmann::json parameters;  ///< object: name -> "6e-3 dyn/cm" | number in SI | choice word
  std::string pointer;        ///< JSON pointer of the object that names the model
};

/// A wall between two neighbouring nodes of the fluid that holds none itself: the flow goes through it.
struct UnseenWall {
  double thickness = 0;  ///< spacings, of the thickest one; 0: there is none
  Vector at = {};        ///< a place in it, m
};

/// What the lattice makes of the fluid between walls of any shape.
struct Passages {
  double narrowest =
      std::numeric_limits<double>::infinity();  ///< from wall to wall, spacings; infinite: none is narrow
  Vector narrowest_at = {};                     ///< m
  double apart = 0;                             ///< nodes that no way leads to from most others
  Vector apart_at = {};                         ///< one of them, m
  bool through = true;              ///< whether a way leads through a period along x, or from inlet to outlet
  std::array<double, 2> open = {};  ///< m2, or m in two dimensions, at the lower end of the flow axis and the upper one
  double least_open = 0;            ///< the same at the place along it where it is least
  double beside_walls = 0;          ///< nodes of the fluid within a spacing of walls of a shape
  UnseenWall unseen = {};
};

/// Cells that come in through an opening while the run goes on.
struct Feed {
  int type;            ///< index into Scene::cell_types
  double hematocrit;   ///< cell volume that comes in over all volume that comes in: a discharge hematocrit
  std::uint32_t seed;  ///< of places and angles
  double length;       ///< m, of the piece behind the opening in which they appear; 0: not written
  std::string pointer;
};

/// What an open end of the domain is kept at: a pressure or a mean velocity.
struct Opening {
  std::optional<double> mean_velocity = {};  ///< m/s into the domain, over the open part of its end
  std::optional<double> pressure = {};       ///< Pa
  std::optional<Feed> cells = {};
  std::string pointer;
};

struct Domain {
  Vector size{0, 0};                ///< m, along two axes or three
  std::vector<int> nodes = {0, 0};  ///< of the lattice along each axis; the spacing is the same along all
  /// Inlet and outlet, at the lower and the upper end of the open axis; none: no axis is open.
  std::optional<std::array<Opening, 2>> openings = {};
  /// By axis; false: solid walls at both ends, or openings. z is where there is none.
  std::array<bool, 3> periodic{true, false, true};
  int open_axis = -1;  ///< that fluid goes through the ends of; -1: none
  /// Of a tube along x through the middle, in place of walls across y and z, m; in three dimensions.
  std::optional<double> tube_radius = {};
  /// All outside of `within`, and all inside of an obstacle, is wall, beside whatever lies across y and z.
  std::optional<WallShape> within = {};
  std::vector<WallShape> obstacles = {};
  std::vector<std::string> obstacles_outside = {};  ///< pointers of those without a part in it; by shape::build_walls()
  /// What these leave to the fluid, by dimension, with images along periodic axes, in m; null: there are none. And its
  /// area or volume, m2 or m3. All made by shape::build_walls().
  core::RegionPointer<2> region_in_plane = {};
  core::RegionPointer<3> region_in_space = {};
  double region_content = 0;
  double shape_speed = 0;                         ///< the largest of a wall that is no plane, m/s
  std::shared_ptr<const Passages> passages = {};  ///< made by shape::survey_walls(); null: not looked for
  double region_width = 0;                        ///< twice the largest distance of a place in it to a wall, m

  [[nodiscard]] int dimension() const { return size.dimension(); }
  [[nodiscard]] bool in_plane() const { return dimension() < 3; }
  [[nodiscard]] const DimensionWords& words() const { return words_of(dimension()); }
  /// Of the whole lattice.
  [[nodiscard]] double node_count() const {
    double all = 1;
    for (const int count : nodes) all *= count;
    return all;
  }
  /// Of what the walls enclose: m2, or m3 in three dimensions.
  [[nodiscard]] double content() const {
    if (tube_radius) return std::numbers::pi * *tube_radius * *tube_radius * size.x();
    if (has_shapes()) return region_content;
    return size.product();
  }
  /// Whether fluid goes through the ends of an axis; `openings` may be wrong still.
  [[nodiscard]] bool is_open() const { return open_axis >= 0; }
  /// That a flow from end to end goes along: the open one, else x.
  [[nodiscard]] int flow_axis() const { return is_open() ? open_axis : 0; }
  /// Whether there are solid walls at both ends of an axis.
  [[nodiscard]] bool walled(int axis) const { return !periodic[axis] && axis != open_axis; }
  /// The cells that come in; null: none do.
  [[nodiscard]] const Feed* feed() const { return openings && (*openings)[0].cells ? &*(*openings)[0].cells : nullptr; }
  [[nodiscard]] bool has_shapes() const { return within || !obstacles.empty(); }
  template <int D>
  [[nodiscard]] const core::RegionPointer<D>& region() const {
    return std::get<const core::RegionPointer<D>&>(std::tie(region_in_plane, region_in_space));
  }
  template <int D>
  core::RegionPointer<D>& region() {
    return std::get<core::RegionPointer<D>&>(std::tie(region_in_plane, region_in_space));
  }
  /// Whether walls close it along z, too.
  [[nodiscard]] bool is_duct() const { return walled(2); }
  /// From wall to wall along y or z, m; at the widest place between walls of any shape.
  [[nodiscard]] double across(int axis) const {
    return tube_radius ? 2 * *tube_radius : has_shapes() ? region_width : size[axis];
  }
};

/// A part of the suspending fluid that has another viscosity, between two heights.
struct FluidLayer {
  double from, to;   ///< m, from the lower wall, or the lower edge of the domain
  double viscosity;  ///< Pa s
};

struct FluidProperties {
  double density;                  ///< kg/m3
  double viscosity;                ///< Pa s, of the suspending fluid
  std::vector<FluidLayer> layers;  ///< beside each other, from below
  bool inertia = false;            ///< false: linear (Stokes) equilibrium
  Vector body_force;               ///< N/m3, in every stage
  Vector gravity;                  ///< m/s2, on what cells enclose: what lies around them is held
  ModelChoice collision;           ///< "trt" when the scene names none
};

enum class Precision { f32, f64 };

struct Numerics {
  double tau = 1.0;             ///< relaxation time of the suspending fluid, in time steps
  double density_factor = 1.0;  ///< the fluid is simulated this many times denser than it is
  std::string kernel = "peskin4";
  Precision precision = Precision::f64;
  std::string coupling = "explicit";  ///< or "semi-implicit", or "auto": the limits of the plan decide
  bool slip_correction = false;       ///< take the tangential slip of the immersed boundary out
  bool area_correction = false;       ///< keep the cells' areas or volumes, and report what would have leaked
};

struct Biconcave {
  double radius;
};  ///< m; reduced-volume red cell, long axis along x at angle 0; in three dimensions turned about its axis, along y
struct Circle {
  double radius;
  double prestretch = 1.0;
};  ///< radius as placed (m); rest length = length / prestretch
struct Ellipse {
  Vector semi_axes;
};  ///< m, first along x at angle 0
struct Sphere {
  double radius;
  double prestretch = 1.0;
};  ///< in three dimensions, as a circle
struct Ellipsoid {
  Vector semi_axes;
  bool even = false;  ///< a spheroid with nodes at equal distances along meridians, as the disc has them
};                    ///< m, along x, y and z at angle 0
struct MeshFile {
  std::filesystem::path file;
  double unit;
};  ///< a surface of triangles from a file, whose coordinates are in this unit, m
/// Circle and ellipse are of two dimensions, sphere, ellipsoid and mesh of three.
using Shape = std::variant<Biconcave, Circle, Ellipse, Sphere, Ellipsoid, MeshFile>;

/// Where the laws in the plane of a membrane rest, if that is not the shape that the cell begins with.
struct StressFree {
  Shape shape;
  bool sized;           ///< else it has the area, or in two dimensions the perimeter, of the first shape
  std::string pointer;  ///< its place in the scene
};

struct CellType {
  std::string name;
  Shape shape;
  int segments;                       ///< of an outline; 0 in three dimensions
  double interior_viscosity;          ///< Pa s
  std::vector<ModelChoice> membrane;  ///< laws that add up
  double interior_density = 0;        ///< kg/m3; that of the fluid where it is not written
  int triangles = 0;                  ///< of a surface: 20 n^2; 0 in two dimensions, and of a mesh, whose file has them
  std::optional<StressFree> stress_free = {};

  /// Of its outline or, but of a mesh, its surface.
  [[nodiscard]] int nodes() const { return segments > 0 ? segments : triangles / 2 + 2; }
};

/// One cell to be placed; rows, lists and files are read already.
struct CellPlacement {
  int type;             ///< index into Scene::cell_types
  Vector center;        ///< m
  double angle;         ///< rad, counter-clockwise
  std::string pointer;  ///< entry of /cells that asked for it
  int line = 0;         ///< of the file of cells that it comes from; 0: of none
  /// Unit vector that the shape's y axis is turned to; `angle` is then about it, not about z.
  std::optional<Eigen::Vector3d> axis = {};
};

/// Cells that were placed at random.
struct RandomPacking {
  int type;                          ///< index into Scene::cell_types
  int first, count;                  ///< its cells are Scene::cells[first] ... [first + count - 1] once they are added
  std::optional<double> hematocrit;  ///< asked for, a share of the region; empty: a number of cells was
  double reached;                    ///< share of the region that the cells fill at rest
  std::uint32_t seed;
  double gap;           ///< m, kept from other cells, their images and walls
  Vector lower, upper;  ///< m, corners of the region that holds the cells
  std::string pointer;  ///< entry of /cells
};

/// Stand for both walls, and for other parts of the same membrane, where an interaction names what it acts between; no
/// cell type may be called so.
inline constexpr const char *wall_name = "wall", *self_name = "self";

struct Interaction {
  static constexpr int wall = -1, self = -2;
  std::array<int, 2> between;  ///< indices into Scene::cell_types; unordered; `wall` or `self` may be the second
  ModelChoice potential;
  [[nodiscard]] bool with_wall() const { return between[1] == wall; }
  [[nodiscard]] bool with_self() const { return between[1] == self; }
};

/// Names of cell types that attract each other, in alphabetical order, and how deep their wells are together, J/m2;
/// NaN: a potential between them tells no energy, or has no well.
using Attractions = std::map<std::array<std::string, 2>, double>;

enum class WallStart { impulsive, developed };

/// What is added to what drives a stage: amplitudes times sin(2 pi frequency t), t from the start of the stage.
struct Oscillation {
  double frequency = 0;          ///< Hz; 0: nothing oscillates
  bool ramp = false;             ///< in place of the sine, from minus to plus these over the stage's duration
  double shear_rate = 0;         ///< 1/s
  double mean_wall_speed = 0;    ///< m/s
  double pressure_gradient = 0;  ///< Pa/m
};

/// A force on each of some cells, in N, in two dimensions N/m.
struct CellForce {
  std::vector<int> cells;  ///< ascending; empty: all
  Vector toward;         ///< unit vector: it acts on what lies furthest that way of the cell as placed; 0: on all of it
  double share = 1;      ///< how much of the membrane that is
  Vector force, before;  ///< in the end, and as the stage begins
  double ramp = 0;       ///< s, from the one to the other
  std::string pointer;

  [[nodiscard]] bool pulls_at(int cell) const {
    return cells.empty() || std::binary_search(cells.begin(), cells.end(), cell);
  }
};

/// What a stage multiplies an interaction by: one value, two with a ramp between them, or `steps` of equal length.
struct Strength {
  std::vector<double> values = {1};
  bool steps = false;
};

struct Stage {
  std::string name;
  std::optional<double> duration;  ///< s
  std::optional<double> strain;    ///< strain of this stage, |shear_rate| x time
  bool until_at_rest = false, until_equilibrium = false, until_parted = false;
  std::string until_mean;           ///< column of series.csv; empty: it does not end by a mean
  double until_standard_error = 0;  ///< of that mean, in the column's unit
  double shear_rate = 0.0;  ///< 1/s, of either sign: speed of the upper wall less that of the lower, over the height
  double mean_wall_speed = 0.0;  ///< m/s, of both walls together, along x
  WallStart start = WallStart::impulsive;
  Vector pressure_gradient;             ///< force per volume that drives the flow, Pa/m, along x
  std::optional<double> mean_velocity;  ///< m/s, of the fluid in a channel: the pressure gradient is what it takes
  Oscillation oscillation;
  std::vector<CellForce> forces;
  std::vector<Strength> strengths;                         ///< of each interaction of the scene; empty: all are whole
  double density_factor;                                   ///< Numerics::density_factor unless the stage has its own
  std::string density_factor_key = common_density_factor;  ///< what to change for another one
  std::string pointer;

  static constexpr const char* common_density_factor = "numerics.density_factor";
  [[nodiscard]] bool has_own_density_factor() const { return density_factor_key != common_density_factor; }
  [[nodiscard]] bool oscillates() const { return oscillation.frequency != 0; }
  /// Whether what drives it changes in time, as the scene says.
  [[nodiscard]] bool changes() const { return oscillates() || oscillation.ramp; }
  /// Whether interactions do, which then give or take energy.
  [[nodiscard]] bool changes_strengths() const {
    return std::any_of(strengths.begin(), strengths.end(), [](const Strength& s) { return s.values.size() > 1; });
  }
  /// Whether it may end before its duration or strain.
  [[nodiscard]] bool may_end_early() const {
    return until_at_rest || until_equilibrium || until_parted || !until_mean.empty();
  }
  /// Whether its walls shear at one rate: strain is counted by it.
  [[nodiscard]] bool shears_steadily() const { return shear_rate != 0 && !changes(); }
};

/// When an output is due: every so much strain, every so many seconds of simulated time, or both. Empty: never.
struct Cadence {
  std::optional<double> strain;
  std::optional<double> seconds;
  [[nodiscard]] bool never() const { return !strain && !seconds; }
};

/// Which nodes of the lattice the fields in frames.h5 hold, and how.
struct FieldStorage {
  std::array<int, 3> first{0, 0, 0};       ///< node along x, y and z
  std::optional<std::array<int, 3>> last;  ///< none: to the lattice's end
  int stride = 1;                          ///< every so many nodes from the first
  Precision precision = Precision::f32;
  int compression = 1;  ///< level of deflate, behind a shuffle of the bytes; 0: none
  [[nodiscard]] bool whole() const { return !last && stride == 1; }
  /// Nodes along an axis of a lattice that has `nodes` of them.
  [[nodiscard]] int count(int axis, int nodes) const;
};

/// What is measured across a channel, over y, or across a tube, over the distance from its axis.
struct Profiles {
  bool radial;
  int bins;
};

struct Output {
  Cadence cells;                        ///< rows of cells.csv, aggregates.csv and membranes in frames.h5
  Cadence fields;                       ///< fluid fields in frames.h5
  std::vector<std::string> quantities;  ///< of "velocity", "density", "viscosity", "vorticity", "wall_shear_stress"
  FieldStorage field_storage;
  std::optional<double> checkpoint_seconds = 600;  ///< of wall-clock time between checkpoints; absent: none are written
  double aggregate_gap = 0.75e-6;                  ///< m; two cells are aggregated while their smallest gap is below
  std::optional<Profiles> profiles = {};
  double bond_share = 0.15;  ///< two cells are joined from this share of the energy on that a whole face would win

  [[nodiscard]] bool wants(std::string_view quantity) const {
    return std::find(quantities.begin(), quantities.end(), quantity) != quantities.end();
  }
};

/// "at rest": no node moved more than `displacement` within the last `window`.
struct AtRest {
  double displacement = 0.01e-6;  ///< m
  double window = 0.2;            ///< s
};

/// "equilibrium": the energy of membranes and interactions has changed by less than `rate` of itself in a second, taken
/// over the last `window`.
struct Equilibrium {
  double rate = 1e-3;   ///< 1/s
  double window = 0.2;  ///< s
};

/// Limits beyond which a run stops before it writes garbage.
struct Checks {
  double mach = 0.3;         ///< largest Mach number of the lattice flow
  double node_step = 0.5;    ///< largest displacement of a membrane node in one step, lattice spacings
  double area_drift = 0.02;  ///< largest relative change of a cell's area
  double stretch = 5;        ///< largest length of a segment over the one it was placed with, and the other way round
  double energy_growth = 0.01;  ///< largest gain of energy in a stage at rest, over the energies there are
  int every_steps = 200;        ///< steps between checks of fields, area, segments and crossings
};

struct Scene {
  std::string title;
  Domain domain;
  FluidProperties fluid;
  Numerics numerics;
  std::vector<CellType> cell_types;
  std::vector<CellPlacement> cells;
  /// The last so many of `cells` are not placed: the inlet's, in the order in which they come in.
  std::size_t fed = 0;
  std::vector<RandomPacking> packings;
  std::vector<Interaction> interactions;
  std::vector<Stage> stages;
  Output output;
  AtRest at_rest;
  Equilibrium equilibrium;
  Checks checks;
  std::vector<std::filesystem::path> plugin_dirs;  ///< relative ones begin with the scene's folder
  std::shared_ptr<const json::Document> document;  ///< for places in later errors, and for the report

  /// The cells that are there at the beginning.
  [[nodiscard]] std::span<const CellPlacement> placed() const { return {cells.data(), cells.size() - fed}; }
  /// Names of what an interaction acts between.
  [[nodiscard]] std::array<std::string, 2> names_of(const Interaction& interaction) const {
    const auto name = [&](int type) -> std::string {
      if (type == Interaction::wall) return wall_name;
      return type == Interaction::self ? self_name : cell_types[type].name;
    };
    return {name(interaction.between[0]), name(interaction.between[1])};
  }
  /// Place of a JSON pointer in the scene file, for an Error.
  [[nodiscard]] Place place(const std::string& pointer) const {
    return document ? document->place(pointer) : Place{"", pointer, 0, 0};
  }
};

}  // namespace rouleau::scene
