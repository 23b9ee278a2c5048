#include "companions.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>

#include "base/text.hpp"
#include "json/document.hpp"
#include "plan/error_model.hpp"
#include "plan/estimate.hpp"
#include "plan/limits.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"
#include "scene/stage_scales.hpp"
#include "shape/extent.hpp"

namespace rouleau::accuracy {

namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

// Nearer lattices differ too little, and on coarser ones nothing was measured (docs/accuracy.md, "Error bars").
constexpr double least_refinement = 4.0 / 3, most_refinement = 2.5;
// Shares of the run's time: of steps, at most and where starting the companions takes the rest; seconds to start one.
constexpr double most_share = 0.38, least_share = 0.28, start_s = 0.004;
constexpr double at_most_beyond = 2;       ///< times those shares, where no lattice that they allow is fine enough
constexpr double outputs_of_tables = 0.2;  ///< what they cost over those of a run, which writes frames

constexpr double to_the_coarsest = 1.25;  ///< spacing of the companion for the order over that for the lattice
constexpr double least_to_the_coarsest = 1.15, most_to_the_coarsest = 1.4;
/// Half the density is nearer to the truth. Between its companion and the one before only the density's error is to
/// change: the lattice's fluid gives way to pressures as much as before, (tau - 1/2)^2 times the density, for cells
/// beside the middle drift by that, and stiff ones deform too much. The same step would double it and hide the
/// density's error; the same tau would halve it, and show what a coarse lattice has and the run has not. Where this
/// wants a relaxation time beyond this one, whose own error is large, it is twice the density. In the plain scheme slip
/// and leak change with tau, and it keeps that instead.
constexpr double light = 0.5, dense = 2, largest_tau = 3;
/// A start that makes a stage late by less than this share of its strain changes in proportion to the density, and the
/// companion for inertia shows it.
constexpr double slight_start = 0.1;
/// Checks end a run before it writes garbage; a companion's coarse lattice comes nearer to them, and how wrong it is is
/// what is asked. What leaks through a membrane grows faster than the square of the spacing, and with the strain: a
/// capsule on 64, 44 and 36 rows would have lost 1.1, 2.7 and 4.4 % of its area within a strain of 40.
constexpr double wider_mach = 4, wider_area = 20;

/// Outputs of a run that reports moments, beyond which companions have `fewer` times fewer of them: between theirs
/// moments are known well enough (Quantity::uncertainty).
constexpr long many_outputs = 200, fewer = 4;

/// Where moments are reported a companion goes on beyond the scene by this share of its last stage.
constexpr double beyond_the_end = 0.25;
constexpr const char* name_beyond = "beyond the end of the scene";

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

/// Of second order in the spacing.
bool is_corrected(const scene::Scene& scene) { return scene.cells.empty() || scene.numerics.slip_correction; }

using scene::LatticeSize;

std::string in_words(const LatticeSize& size) { return scene::by_axes(size) + " nodes"; }

/// What small lattices cost beside their nodes, s: each step; each row, and once more if its nodes do not fill
/// registers. Measured in two dimensions.
constexpr double step_s = 1.5e-6, row_s = 45e-9, ragged_row_s = 60e-9;
constexpr int full_registers = 8;

/// Cost of a run on a lattice with `coarser` times fewer nodes along each side, over that of the run.
double share_of(const scene::Scene& scene, double coarser) {
  const LatticeSize size = scene.domain.nodes;
  const double nodes = std::accumulate(size.begin(), size.end(), 1.0, std::multiplies<>());
  const int dimension = static_cast<int>(size.size());
  const double membranes = plan::membrane_nodes(scene);
  const auto cost = [&](double by) {
    const double of_membranes = membranes / std::pow(by, dimension - 1);
    const long row = std::lround(size[0] / by);
    const double rows = nodes / size[0] / std::pow(by, dimension - 1);
    const double of_rows = rows * (row_s + (row % full_registers != 0 ? ragged_row_s : 0));
    return (plan::step_cost(nodes / std::pow(by, dimension), of_membranes, scene.numerics.precision, dimension) +
            of_rows + step_s) /
           (by * by);
  };
  return cost(coarser) / cost(1);
}

void set_density(Json& scene, double factor) {
  const auto scale = [&](Json& holder, double otherwise) {
    holder["density_factor"] = factor * holder.value("density_factor", otherwise);
  };
  scale(scene["numerics"], 1);
  for (Json& stage : scene["stages"])
    if (stage.contains("density_factor")) scale(stage, 1);
}

Json on_lattice(const scene::Scene& scene, const LatticeSize& nodes) {
  Json changed = scene.document->root();
  const double coarser = static_cast<double>(scene.domain.nodes[1]) / nodes[1];
  changed["domain"]["nodes"] = nodes;
  for (const scene::CellType& type : scene.cell_types) {
    Json& cell = changed["cell_types"][type.name];
    const bool fixed = type.stress_free && std::holds_alternative<scene::MeshFile>(type.stress_free->shape);
    if (type.triangles > 0 && !fixed) cell["triangles"] = shape::divided_triangles(type.triangles, coarser);
    if (type.segments > 0) cell["segments"] = std::max(8L, std::lround(type.segments / coarser));
  }
  if (!changed.contains("numerics") || !changed["numerics"].is_object()) changed["numerics"] = Json::object();
  changed["numerics"].erase("auto");  // what it chose stands beside it
  // A coarse lattice is nearer to the limit of the explicit step.
  if (scene.numerics.coupling == "explicit") changed["numerics"]["coupling"] = "auto";
  Json& checks = changed["checks"];
  checks["mach"] = std::min(1.0, wider_mach * scene.checks.mach);
  checks["area_drift"] = std::min(1.0, wider_area * scene.checks.area_drift);
  // Error bars need tables alone; rows come at the same instants.
  if (!changed.contains("output")) changed["output"] = Json::object();
  changed["output"].erase("fields");
  changed["output"]["checkpoint"] = "never";
  return changed;
}

/// output.cells with fewer outputs; nothing where it is not an interval of strain.
std::optional<Json> thin_outputs(const scene::Scene& scene) {
  Json cells = scene.document->root().value("/output/cells"_json_pointer, Json());
  if (!cells.is_object() || !cells.value("strain", Json()).is_number()) return std::nullopt;
  cells["strain"] = fewer * cells["strain"].get<double>();
  return cells;
}

/// Lets the last stage go on; false where it has no end of its own. What drives it does not change, nor does the flow.
bool go_on(Json& scene) {
  Json stage = scene["stages"].back();
  if (!(stage.contains("strain") && stage["strain"].is_number()) || stage.contains("oscillation")) return false;
  stage["name"] = name_beyond;
  stage["strain"] = beyond_the_end * stage["strain"].get<double>();
  for (const char* key : {"start", "duration", "until"}) stage.erase(key);
  scene["stages"].push_back(std::move(stage));
  return true;
}

/// Numbers of equal parts of the lattice's sides that a coarser one of the same shape may have, the finest first.
struct CoarserLattices {
  explicit CoarserLattices(const scene::Scene& scene) : nodes_(scene.domain.nodes), radius_(INFINITY) {
    for (const int nodes : nodes_) parts_ = std::gcd(parts_, nodes);
    if (!scene.cells.empty()) radius_ = shape::smallest_radius(scene) / scene::lattice_spacing(scene);
    least_ = plan::least_radii(scene, plan::membrane_coupling(scene.numerics));
  }
  [[nodiscard]] int parts() const { return parts_; }
  [[nodiscard]] double refinement(int part) const { return static_cast<double>(parts_) / part; }
  [[nodiscard]] double radius(int part) const { return radius_ / refinement(part); }
  [[nodiscard]] double least_radius() const { return least_.companion; }
  [[nodiscard]] bool wants_fine_ones() const { return least_.companion > plan::LeastRadii{}.companion; }
  [[nodiscard]] LatticeSize nodes(int part) const {
    LatticeSize size = nodes_;
    for (int& nodes : size) nodes = nodes / parts_ * part;
    return size;
  }
  [[nodiscard]] bool too_small(int part) const {
    const LatticeSize size = nodes(part);
    return *std::min_element(size.begin(), size.end()) < 4;
  }
  /// The lattice nearest to one that is to_the_coarsest times as coarse; 0: none will do.
  [[nodiscard]] int coarser_than(int part) const {
    const int next = static_cast<int>(std::lround(part / to_the_coarsest));
    if (next < 1 || radius(next) < least_.coarsest || too_small(next)) return 0;
    const double ratio = static_cast<double>(part) / next;
    return ratio >= least_to_the_coarsest && ratio <= most_to_the_coarsest ? next : 0;
  }

 private:
  LatticeSize nodes_;
  int parts_ = 0;
  double radius_;
  plan::LeastRadii least_;
};

/// Where the start and the density are changed, and by what.
struct Changes {
  bool start, inertia;
  double density = light, tau = 1;  ///< of the companion for inertia
  bool on_the_finer;
  /// Of these lattices (0: none) the one on which they are made.
  [[nodiscard]] int lattice(int fine, int coarse) const { return on_the_finer || coarse == 0 ? fine : coarse; }
  /// What they cost over a companion on their lattice, whose relaxation time is given.
  [[nodiscard]] double cost(double tau_of_lattice) const {
    const double steps = (tau_of_lattice - 0.5) / (tau - 0.5) / density;
    return (start ? 1 : 0) + (inertia ? steps : 0);
  }
};

/// By how much the lattice's fluid gives way to the shear: of the stage where it is most.
double compression(const scene::Scene& scene) {
  double most = 0;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const double step = scene::make_stage_setting(scene, static_cast<int>(i)).units.time;
    most = std::max(
        most, plan::compression_by_shear(scene.numerics.tau, step * scene::mean_shear_rate(scene.stages[i], scene)));
  }
  return most;
}

/// On a lattice with this relaxation time. `wanted`: light or dense, where either will do.
Changes choose_changes(const scene::Scene& scene, double densest, bool moments, double tau, double wanted) {
  Changes changes{start_matters(scene), densest > 1, std::max(wanted, 1 / densest), tau, moments};
  if (!is_corrected(scene)) return changes;
  const auto tau_with = [&](double density) { return 0.5 + (tau - 0.5) / std::sqrt(density); };
  if (tau_with(changes.density) > largest_tau) changes.density = dense;
  changes.tau = tau_with(changes.density);
  return changes;
}

/// Companions for the lattice and for the order (0: none) on these lattices, with this relaxation time, and the others.
struct Choice {
  int fine = 0, coarse = 0;
  double tau = 1;
  Changes changes;
};

/// What all companions of a choice cost over the run.
double cost_of_all(const scene::Scene& scene, const CoarserLattices& lattices, const Choice& choice) {
  const auto& [fine, coarse, tau, changes] = choice;
  const auto share = [&](int part) { return part == 0 ? 0 : share_of(scene, lattices.refinement(part)); };
  const double steps = (scene.numerics.tau - 0.5) / (tau - 0.5);
  return steps * (share(fine) + share(coarse) + changes.cost(tau) * share(changes.lattice(fine, coarse)));
}

/// The companions of a choice: on coarser lattices, and one for each change on the lattice that it is made on.
/// `thinned`: with fewer outputs.
void add_runs(const scene::Scene& scene, const CoarserLattices& lattices, const Choice& choice, bool moments,
              bool thinned, Companions& chosen) {
  const int fine = choice.fine, coarse = choice.coarse;
  const double tau = choice.tau;
  const Changes& changes = choice.changes;
  const auto add_lattice = [&](Role role, int part) {
    const LatticeSize size = lattices.nodes(part);
    Json coarser = on_lattice(scene, size);
    const bool same_tau = tau == scene.numerics.tau;
    if (!same_tau) coarser["numerics"]["tau"] = tau;
    if (thinned) coarser["output"]["cells"] = *thin_outputs(scene);
    const bool longer_run = moments && go_on(coarser);
    chosen.runs.push_back({role, std::move(coarser), in_words(size) + (same_tau ? "" : ", tau " + number(tau, 3)),
                           longer_run ? name_beyond : ""});
  };
  add_lattice(Role::lattice, fine);
  if (coarse > 0) add_lattice(Role::order, coarse);
  int last = changes.lattice(fine, coarse) == fine ? 0 : 1;
  Json companion = chosen.runs[static_cast<std::size_t>(last)].scene;
  const std::string beyond = chosen.runs[static_cast<std::size_t>(last)].beyond;
  const auto add_change = [&](Role role, const std::string& differs) {
    chosen.runs.push_back({role, companion, differs, beyond, last});
    last = static_cast<int>(chosen.runs.size()) - 1;
  };
  if (changes.start) {
    for (std::size_t i = 0; i < scene.stages.size(); ++i)
      if (starts_at_rest(scene.stages[i], scene)) companion["stages"][i]["start"] = "developed";
    add_change(Role::start, "the flow developed from the start");
  }
  if (changes.inertia) {
    set_density(companion, chosen.density);
    companion["numerics"]["tau"] = changes.tau;
    add_change(Role::inertia, "density factor times " + number(chosen.density, 3) +
                                  (changes.tau != tau ? ", tau " + number(changes.tau, 3) : ""));
  }
}

}  // namespace

const char* name_of(Role role) {
  constexpr std::array words{"lattice", "order", "start", "inertia"};
  return words.at(static_cast<std::size_t>(role));
}

Companions choose_companions(const scene::Scene& scene, const RunCost& cost, double most_compressed) {
  Companions chosen;
  double densest = 1;
  for (const scene::Stage& stage : scene.stages) densest = std::max(densest, stage.density_factor);
  chosen.relaxed = 1 - 1 / densest;
  chosen.order = is_corrected(scene) ? 2 : 1;
  chosen.usual_order = std::max(chosen.order, plan::order_of_lattice_error(scene));
  const double compressed = compression(scene);
  const int processes = 2 + (start_matters(scene) ? 1 : 0) + (densest > 1 ? 1 : 0);
  const bool thinned = cost.moments && cost.outputs > many_outputs && thin_outputs(scene).has_value();
  const double outputs_s = outputs_of_tables * cost.outputs_s / (thinned ? fewer : 1);
  const double longer = cost.moments ? 1 + beyond_the_end : 1;
  const double affordable = std::max(least_share, most_share - processes * (start_s + outputs_s) / cost.run_s) / longer;

  const CoarserLattices lattices(scene);
  // With a companion for the lattice on that one.
  const auto choose = [&](int fine, double density) {
    Choice choice{fine, lattices.coarser_than(fine), scene.numerics.tau, {}};
    const double coarsest = lattices.refinement(choice.coarse > 0 ? choice.coarse : fine);
    const double shorter = std::min(1.0, std::sqrt(most_compressed / compressed) / coarsest);
    choice.tau = 0.5 + shorter * (scene.numerics.tau - 0.5);
    choice.changes = choose_changes(scene, densest, cost.moments, choice.tau, density);
    return choice;
  };
  const auto finest_within = [&](double share, double density) {
    for (int k = lattices.parts() - 1; k > 0; --k) {
      if (lattices.refinement(k) < least_refinement) continue;
      if (lattices.refinement(k) > most_refinement || lattices.too_small(k)) break;
      if (const Choice choice = choose(k, density); cost_of_all(scene, lattices, choice) <= share) return choice;
    }
    return Choice{};
  };
  Choice choice = finest_within(affordable, light);
  const bool too_coarse = choice.fine == 0 || lattices.radius(choice.fine) < lattices.least_radius();
  if (too_coarse && (lattices.wants_fine_ones() || std::isfinite(most_compressed))) {
    // A dense fluid takes half as many steps as a light one.
    choice = finest_within(at_most_beyond * affordable, lattices.wants_fine_ones() ? dense : light);
  }
  const int fine = choice.fine, coarse = choice.coarse;
  const double tau = choice.tau;
  const auto too_small = [&lattices](double radius) {
    return "on a lattice that costs a small part of this one a cell's radius would be " + number(radius, 2) +
           " spacings, fewer than " + number(lattices.least_radius());
  };
  if (const double most = lattices.radius(lattices.parts()) / least_refinement; most < lattices.least_radius()) {
    chosen.why_none = too_small(most);
    return chosen;
  }
  if (fine == 0) {
    chosen.why_none = "no coarser lattice has the shape of " + in_words(scene.domain.nodes) + " and 1.4 to " +
                      number(most_refinement) +
                      " times their distance at a small part of the cost; take numbers with a larger common divisor";
    return chosen;
  }
  chosen.density = choice.changes.density;
  const auto as_by_spacing = [&](int part) {
    const double change =
        plan::growth_of_lattice_error(scene, tau) / plan::growth_of_lattice_error(scene, scene.numerics.tau);
    return lattices.refinement(part) * std::pow(change, 1 / chosen.order);
  };
  chosen.refinement = as_by_spacing(fine);
  chosen.expected_share = longer * cost_of_all(scene, lattices, choice);
  if (const double radius = lattices.radius(fine); radius < lattices.least_radius()) {
    chosen.why_none = too_small(radius);
    return chosen;
  }
  add_runs(scene, lattices, choice, cost.moments, thinned, chosen);
  if (coarse > 0) chosen.coarsest = as_by_spacing(coarse);
  return chosen;
}

}  // namespace rouleau::accuracy
