// Limits of the method (stability, accuracy), with all that was measured of them: by kernel, coupling and stiffness.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/coupling/kernel_kind.hpp"
#include "error_model.hpp"
#include "json/json.hpp"

namespace rouleau::plan {

/// The flow presses on a cell with a few times viscosity times shear rate, and the lattice's fluid gives way to it: by this
/// share of the cell's area, measured with a capsule at tau 1.5 to 3 (2.6 to 2.9 times (tau - 1/2) times the shear rate;
/// docs/accuracy.md). Lattice units.
constexpr double compression_by_shear(double tau, double shear_rate) { return 2.7 * (tau - 0.5) * shear_rate; }
constexpr double largest_compression_by_shear = 0.01;

struct Plan;

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
