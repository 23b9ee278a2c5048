// Limits of the method (stability, accuracy), with all that was measured of them: by kernel, coupling and stiffness.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/coupling/kernel_kind.hpp"
#include "error_model.hpp"
#include "json/json.hpp"
#include "plugin/model_setup.hpp"

namespace rouleau::plan {

/// The flow presses on a cell with a few times viscosity times shear rate, and the lattice's fluid gives way to it: by this
/// share of the cell's area, measured with a capsule at tau 1.5 to 3 (2.6 to 2.9 times (tau - 1/2) times the shear rate;
/// docs/accuracy.md). Lattice units.
constexpr double compression_by_shear(double tau, double shear_rate) { return 2.7 * (tau - 0.5) * shear_rate; }
constexpr double largest_compression_by_shear = 0.01;

/// Cells that attract each other press on their fluid with the strongest attraction, and the lattice's fluid gives way to it by
/// three times that (lattice units): what leaks while cells snap together. Of pairs at rest, both corrections on, 0.9 to 1.3 %
/// leaked at 0.064 to 0.13, and more than 2 %, which stops a run, at 0.17 and 0.19 (3e-6 and 1.1e-5 J/m2) and at 0.10 (6e-5 J/m2,
/// ten times the shear modulus); without corrections two sheared cells leaked 2 % between 0.16 and 0.19 (limits/adhesion.json).
constexpr double largest_compression_by_attraction = 0.1;

struct Plan;

/// Deepest well between cells, in units of bending modulus over radius squared, where nothing keeps a cell's own faces apart.
/// In the minimum of the energy (tests/reference/rouleau_minimum.py) two red cells have theirs 1.0 um apart at 55 and touching at
/// 86 (88 with a bending modulus of 2e-19 J), four of them 1.0 um apart at 25 and touching at 42.
constexpr double deepest_well_of_bare_faces = 40;
/// Depth of a well over bending modulus / radius^2, the largest of the two types that it holds together and that have no
/// potential within their membranes; lattice units. 0 where there is nothing to say.
double depth_over_bending(const Plan& plan, const scene::Interaction& interaction, double depth,
                          const plugin::ModelSetting& setting);

/// The setting that "numerics": "auto" changes where a limit is exceeded.
enum class RemediedBy { nothing, density_factor, resolution };

/// A limit of the method: the scene's value, where it ends, and limit / value.
struct Limit {
  std::string name;
  double value, limit, margin;
  std::string remedy;
  RemediedBy remedied_by = RemediedBy::nothing;
  int stage = 0;  ///< whose density factor is the remedy
  /// The power of the density factor with which the value grows, or a little less than that.
  double power_of_density = 1;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Limit, name, value, limit, margin, remedy)
};

/// Limits for this scene, sharpest first. Opens the libraries of active models, whose own derivatives give the stiffness
/// that explicit coupling must bear.
std::vector<Limit> find_limits(const Plan& plan);

/// A kernel that a scene can choose, and what it does badly.
struct KernelFacts {
  core::KernelKind kind;
  const char* name;
  double first_moment;   ///< largest |sum w (x - X)|, spacings
  double stretch_limit;  ///< largest stretching stiffness with explicit coupling over that of peskin4
  double bending_limit;  ///< the same for bending stiffness
  /// Relaxation time from which on the semi-implicit step bears more; infinite: it never does, and bears half as much as the
  /// explicit one.
  double semi_implicit_from;
  const char* defect;  ///< what a user has to expect, for `plan`; empty: nothing
};

/// The kernel of this name, which the schema has checked. The limits were measured with one cell at rest, 20 spacings a
/// radius, tau 1.
const KernelFacts& kernel_named(const std::string& name);

/// Limit over value, the smallest over stages, of the stretching and bending stiffness that explicit coupling bears.
/// Infinite without membrane laws. Opens the libraries of active laws.
double explicit_margin(const Plan& plan);

/// Whether the semi-implicit step bears more than the explicit one with the scene's kernel, at its relaxation time.
bool semi_implicit_gains(const Plan& plan);

/// Of all cell types; nothing without cells.
std::optional<RecoveryRates> recovery_rates(const Plan& plan);

/// With a margin below this one `"coupling": "auto"` takes the semi-implicit step.
inline constexpr double comfortable_margin = 1.3;

/// Longest mean segment, in lattice spacings, whose nodes still hold the fluid back: beyond it the 4-point kernel lets
/// fluid pass between them, ten times more with every half spacing (measured, docs/accuracy.md).
inline constexpr double longest_segment = 2.0;

}  // namespace rouleau::plan
