#include "companions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.hpp"
#include "json/document.hpp"
#include "plan/estimate.hpp"
#include "plan/stage_scales.hpp"
#include "scene/driving_flow.hpp"
#include "shape/outline.hpp"

namespace rouleau::accuracy {

namespace {

using Json = nlohmann::json;

// Nearer lattices differ too little, and on coarser ones nothing was measured (docs/accuracy.md, "Error bars").
constexpr double least_refinement = 4.0 / 3, most_refinement = 2.5;
constexpr double least_radius = 4;  ///< of the smallest cell on a companion's lattice, spacings
// Shares of the run's time: of steps, at most and where starting the companions takes the rest; seconds to start one.
constexpr double most_share = 0.32, least_share = 0.2, start_s = 0.08;
/// The companion for inertia keeps its time step, for the relaxation time makes up for its density: it shows nothing of
/// the step's own error, which is the lattice's, and costs less. Half the density is nearer to the truth; where that
/// would want a relaxation time beyond this one, whose own error is large, it is twice the density. In the plain scheme
/// slip and leak change with tau, which stays.
constexpr double light = 0.5, dense = 2, largest_tau = 3;
/// A start that makes a stage late by less than this share of its strain changes in proportion to the density, and the
/// companion for inertia shows it.
constexpr double slight_start = 0.1;
/// Checks end a run before it writes garbage; a companion's coarse lattice comes nearer to them, and how wrong it is is
/// what is asked.
constexpr double wider_checks = 4;

bool starts_at_rest(const scene::Stage& stage, const scene::Scene& scene) {
  return stage.density_factor > 1 && scene::start_up_strain(stage, scene) > 0;
}

double strain_of(const scene::Stage& stage, const scene::Scene& scene) {
  const double rate = scene::mean_shear_rate(stage, scene);
  const double by_time = stage.duration ? *stage.duration * rate : INFINITY;
  return stage.strain ? std::min(*stage.strain, by_time) : by_time;
}

/// Whether the start of a flow does more than what is proportional to the density.
bool start_matters(const scene::Scene& scene) {
  return std::any_of(scene.stages.begin(), scene.stages.end(), [&](const scene::Stage& stage) {
    return starts_at_rest(stage, scene) &&
           stage.density_factor * scene::start_up_strain(stage, scene) > slight_start * strain_of(stage, scene);
  });
}

double membrane_nodes(const scene::Scene& scene) {
  double nodes = 0;
  for (const scene::CellPlacement& cell : scene.cells) nodes += scene.cell_types[cell.type].segments;
  return nodes;
}

/// Cost of a run on a lattice with `coarser` times fewer nodes along each side, over that of the run.
double share_of(const scene::Scene& scene, double coarser) {
  const double nodes = static_cast<double>(scene.domain.nodes[0]) * scene.domain.nodes[1];
  const double membranes = membrane_nodes(scene);
  const auto cost = [&](double by) {
    return plan::step_cost(nodes / (by * by), membranes / by, scene.numerics.precision) / (by * by);
  };
  return cost(coarser) / cost(1);
}

void set_density(Json& scene, double factor) {
  const auto scale = [&](Json& holder, double otherwise) {
    holder["density_factor"] = factor * holder.value("density_factor", otherwise);
  };
  scale(scene["numerics"], 1);
  for (Json& stage : scene["stages"]) {
    if (stage.contains("density_factor")) scale(stage, 1);
  }
}

Json on_lattice(const scene::Scene& scene, const std::array<int, 2>& nodes) {
  Json changed = scene.document->root();
  const double coarser = static_cast<double>(scene.domain.nodes[1]) / nodes[1];
  changed["domain"]["nodes"] = nodes;
  for (const scene::CellType& type : scene.cell_types) {
    const long segments = std::lround(type.segments / coarser);
    changed["cell_types"][type.name]["segments"] = std::max(8L, segments);
  }
  if (!changed.contains("numerics") || !changed["numerics"].is_object()) changed["numerics"] = Json::object();
  changed["numerics"].erase("auto");  // what it chose stands beside it
  // The semi-implicit step changes next to nothing, and a coarse lattice is nearer to the explicit one's limit.
  if (scene.numerics.coupling == "explicit") changed["numerics"]["coupling"] = "auto";
  Json& checks = changed["checks"];
  checks["mach"] = std::min(1.0, wider_checks * scene.checks.mach);
  checks["area_drift"] = std::min(1.0, wider_checks * scene.checks.area_drift);
  // Error bars need tables alone; rows come at the same instants.
  if (!changed.contains("output")) changed["output"] = Json::object();
  changed["output"].erase("fields");
  changed["output"]["checkpoint"] = "never";
  return changed;
}

}  // namespace

const char* name_of(Role role) {
  switch (role) {
    case Role::lattice:
      return "lattice";
    case Role::start:
      return "start";
    case Role::inertia:
      return "inertia";
  }
  return "";
}

Companions choose_companions(const scene::Scene& scene, double run_s, double outputs_s) {
  Companions chosen;
  double densest = 1;
  for (const scene::Stage& stage : scene.stages) densest = std::max(densest, stage.density_factor);
  chosen.relaxed = 1 - 1 / densest;
  chosen.order = scene.cells.empty() || scene.numerics.slip_correction ? 2 : 1;
  const bool inertia = chosen.relaxed > 0, start = start_matters(scene);
  const double tau = scene.numerics.tau;
  const auto tau_of_same_step = [&](double density) { return 0.5 + (tau - 0.5) / density; };
  chosen.density = std::max(light, 1 / densest);
  if (chosen.order == 2 && tau_of_same_step(chosen.density) > largest_tau) chosen.density = dense;
  const double companion_tau = chosen.order == 2 ? tau_of_same_step(chosen.density) : tau;
  const double runs = 1 + (start ? 1 : 0) + (inertia ? (chosen.order == 2 ? 1 : 1 / chosen.density) : 0);
  const int processes = 1 + (start ? 1 : 0) + (inertia ? 1 : 0);
  const double affordable = std::max(least_share, most_share - processes * (start_s + outputs_s) / run_s);

  const std::array<int, 2>& nodes = scene.domain.nodes;
  const int parts = std::gcd(nodes[0], nodes[1]);
  int best = 0;
  for (int k = parts - 1; k > 0 && best == 0; --k) {
    const double coarser = static_cast<double>(parts) / k;
    if (coarser < least_refinement) continue;
    if (coarser > most_refinement || nodes[0] / parts * k < 4 || nodes[1] / parts * k < 4) break;
    if (runs * share_of(scene, coarser) <= affordable) best = k;
  }
  if (best == 0) {
    chosen.why_none = "no coarser lattice has the shape of " + std::to_string(nodes[0]) + " x " +
                      std::to_string(nodes[1]) + " nodes and 1.4 to " + number(most_refinement) +
                      " times their distance at a small part of the cost; take numbers with a larger common divisor";
    return chosen;
  }
  chosen.refinement = static_cast<double>(parts) / best;
  chosen.expected_share = runs * share_of(scene, chosen.refinement);
  if (const double radius = shape::smallest_radius(scene) / plan::lattice_spacing(scene) / chosen.refinement;
      !scene.cells.empty() && radius < least_radius) {
    chosen.why_none = "on a lattice that costs a small part of this one a cell's radius would be " + number(radius, 2) +
                      " spacings, fewer than " + number(least_radius);
    return chosen;
  }
  const std::array coarse{nodes[0] / parts * best, nodes[1] / parts * best};
  Json companion = on_lattice(scene, coarse);
  const std::string lattice = std::to_string(coarse[0]) + " x " + std::to_string(coarse[1]) + " nodes";
  chosen.runs.push_back({Role::lattice, companion, lattice});
  if (start) {
    for (std::size_t i = 0; i < scene.stages.size(); ++i) {
      if (starts_at_rest(scene.stages[i], scene)) companion["stages"][i]["start"] = "developed";
    }
    chosen.runs.push_back({Role::start, companion, "the flow developed from the start"});
  }
  if (inertia) {
    set_density(companion, chosen.density);
    companion["numerics"]["tau"] = companion_tau;
    std::string differs = "density factor times " + number(chosen.density, 3);
    if (companion_tau != tau) differs += ", tau " + number(companion_tau, 3);
    chosen.runs.push_back({Role::inertia, companion, differs});
  }
  return chosen;
}

}  // namespace rouleau::accuracy
