#include "contact_remedy.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "observe/aggregates.hpp"
#include "plan/facts.hpp"
#include "plan/limits.hpp"

namespace rouleau::monitor {

namespace {

/// With all the rest, pairs of viscosity ratio 5 completed at 8.3 times the shear modulus and 0.05 of the compression
/// that `plan` limits to 0.1, and not at 10 times (docs/stability.md).
constexpr double calm_compression = plan::largest_compression_by_attraction / 2, deepest_over_shear_modulus = 8.4;

/// None: it remembers, so that it has no one shape.
const std::optional<plan::PotentialShape>& shape_of(const plan::Plan& plan, std::size_t interaction,
                                                    const scene::StageSetting& stage) {
  return plan.facts.stages[stage.index].models->potentials[interaction];
}

bool between_cells(const plan::Plan& plan, std::size_t i) {
  return plan.interactions[i].active() && !plan.scene->interactions[i].with_wall() &&
         !plan.scene->interactions[i].with_self();
}

bool repels_itself(const plan::Plan& plan, int type) {
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    const scene::Interaction& interaction = plan.scene->interactions[i];
    if (interaction.with_self() && interaction.between[0] == type && plan.interactions[i].active()) return true;
  }
  return false;
}

std::string all_of(const std::vector<std::string>& words) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i)
    all += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return all;
}

std::string new_repulsion(const std::string& type, const std::string& other, const std::string& how) {
  return "add an interaction \"repulsion\" between [" + in_quotes(type) + ", " + in_quotes(other) + "] with " + how;
}

/// With two digits.
std::string rounded(double value) { return number(std::stod(number(value, 2))); }

/// Of this stage and of those after it that have a larger one.
std::string lower_density(const plan::Plan& plan, const scene::StageSetting& stage, double share) {
  const double factor = stage.stage->density_factor * share;
  std::vector<std::string> keys;
  for (const scene::StageSetting& later : plan.stages) {
    const std::string& key = later.stage->density_factor_key;
    if (later.index >= stage.index && later.stage->density_factor > factor &&
        std::find(keys.begin(), keys.end(), key) == keys.end())
      keys.push_back(key);
  }
  return "lower " + all_of(keys) + " to " + rounded(factor);
}

std::string micrometres(double spacings, const scene::StageSetting& stage) {
  return number(spacings * stage.units.length * 1e6, 3) + " um";
}

const std::string finer = ", or raise the resolution";

std::string some_strength(const plan::Plan& plan) {
  const double modulus = plan::shear_modulus(plan);
  return std::isnan(modulus) ? "" : "a strength of " + number(modulus, 2) + " J/m2 and ";
}

std::string some_reach(const scene::StageSetting& stage) { return "a cutoff of " + micrometres(2, stage) + " or more"; }

}  // namespace

std::string attraction_remedy(const plan::Plan& plan, const scene::StageSetting& stage) {
  const scene::Scene& scene = *plan.scene;
  bool attracts = false;
  double depth = 0, compression = 0;
  std::vector<std::string> bare, ways;
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    if (!between_cells(plan, i)) continue;
    const std::optional<plan::PotentialShape>& shape = shape_of(plan, i, stage);
    if (shape && !shape->well) continue;
    attracts = true;
    if (!shape) continue;
    const plan::Well& well = *shape->well;
    depth = std::max(depth, stage.units.to_si(well.depth, units::dimension::tension));
    compression = std::max(compression, 3 * well.attraction);
    if (!(plan::depth_over_bending(plan, plan.facts, stage, scene.interactions[i], well.depth) >
          plan::deepest_well_of_bare_cells[scene.domain.dimension() - 2]))
      continue;
    for (const int type : scene.interactions[i].between) {
      const std::string& name = scene.cell_types[type].name;
      if (!repels_itself(plan, type) && std::find(bare.begin(), bare.end(), name) == bare.end()) bare.push_back(name);
    }
  }
  if (!attracts) return "";
  if (!scene.numerics.slip_correction || !scene.numerics.area_correction)
    ways.emplace_back("set numerics.slip_correction and numerics.area_correction to true");
  // In three dimensions the slip correction leaks with other kernels: pairs at rest 2 %, with this one 0.2 to 0.8 %.
  if (scene.domain.dimension() == 3 && scene.numerics.kernel != "sharp6")
    ways.emplace_back("set numerics.kernel to \"sharp6\"");
  const double deepest = deepest_over_shear_modulus * plan::shear_modulus(plan);
  if (depth > deepest) {
    ways.push_back("lower the attraction to a depth of " + number(deepest, 2) + " J/m2");
    compression *= deepest / depth;
    depth = deepest;
  }
  for (const std::string& type : bare)
    ways.push_back(new_repulsion(
        type, "self", "a strength of " + number(3 * depth, 2) + " J/m2 and a cutoff below the cells' least thickness"));
  if (compression > plan::largest_compression_by_attraction)
    ways.push_back(lower_density(plan, stage, calm_compression / compression));
  return all_of(ways);
}

std::string crossing_remedy(const plan::Plan& plan, const scene::StageSetting& stage, int cell, int other) {
  const scene::Scene& scene = *plan.scene;
  std::string attraction = attraction_remedy(plan, stage);
  if (!attraction.empty()) return attraction;
  const scene::CellType &mine = scene.cell_types[scene.cells[cell].type],
                        &its = scene.cell_types[scene.cells[other].type];
  const std::string strength = some_strength(plan), reach = some_reach(stage);
  if (cell == other) {
    if (repels_itself(plan, scene.cells[cell].type)) return "stiffen bending" + finer;
    return new_repulsion(mine.name, "self", strength + "a cutoff below the cells' least thickness") + finer;
  }
  for (std::size_t i = 0; i < plan.interactions.size(); ++i)
    if (between_cells(plan, i)) return "give the repulsion between cells more strength, or " + reach + finer;
  return new_repulsion(mine.name, its.name, strength + reach) + finer;
}

std::string wall_crossing_remedy(const plan::Plan& plan, const scene::StageSetting& stage, int cell) {
  const scene::Scene& scene = *plan.scene;
  const int type = scene.cells[cell].type;
  const std::string reach = some_reach(stage);
  for (std::size_t i = 0; i < plan.interactions.size(); ++i)
    if (scene.interactions[i].with_wall() && scene.interactions[i].between[0] == type && plan.interactions[i].active())
      return "give the repulsion from walls more strength, or " + reach + finer;
  return new_repulsion(scene.cell_types[type].name, "wall", some_strength(plan) + reach) + finer;
}

template <int D>
void blame_contact(Failure& failure, core::Surroundings<D>& around, const plan::Plan& plan,
                   const scene::StageSetting& stage) {
  struct Pressed {
    double pressure = 0, gap = 0;  // lattice units; positive: pushed apart
    int cell = 0, other = 0, interaction = 0;
  };
  const scene::Scene& scene = *plan.scene;
  Pressed most;
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    if (!between_cells(plan, i) || !shape_of(plan, i, stage)) continue;
    const core::Potential& potential = plan.made[stage.index]->interactions[i];
    const double cutoff = shape_of(plan, i, stage)->range;
    around.show(cutoff);
    const auto& between = scene.interactions[i].between;
    for (const observe::CellContact& contact :
         observe::find_touching_cells(around.cells(), scene::lattice_domain<D>(scene), cutoff)) {
      const int a = scene.cells[contact.cell_a].type, b = scene.cells[contact.cell_b].type;
      if (!(a == between[0] && b == between[1]) && !(a == between[1] && b == between[0])) continue;
      const double pressure = plan::force_at(potential, std::max(contact.gap, 1e-9 * cutoff));
      if (std::abs(pressure) > std::abs(most.pressure))
        most = {pressure, contact.gap, contact.cell_a, contact.cell_b, static_cast<int>(i)};
    }
  }
  most = core::best_of_all(around.ranks(), most, [](const Pressed& a, const Pressed& b) {
    const double here = std::abs(a.pressure), there = std::abs(b.pressure);
    return here != there ? here > there : a.cell != b.cell ? a.cell < b.cell : a.other < b.other;
  });
  if (!(3 * std::abs(most.pressure) > plan::largest_compression_by_attraction)) return;
  const auto i = static_cast<std::size_t>(most.interaction);
  const double pressure = stage.units.to_si(std::abs(most.pressure), units::dimension::pressure);
  failure.message += "; cells " + std::to_string(most.cell) + " and " + std::to_string(most.other) + " are " +
                     micrometres(most.gap, stage) + " apart, where " + plan.interactions[i].manifest->id +
                     (most.pressure > 0 ? " pushes them apart with " : " pulls them together with ") +
                     number(pressure, 2) + " Pa";
  if (most.pressure < 0) {
    failure.remedy = attraction_remedy(plan, stage);
    return;
  }
  const plan::PotentialShape& shape = *shape_of(plan, i, stage);
  failure.remedy = "move them apart, to " +
                   micrometres(shape.well ? std::max(shape.well->distance, most.gap) : shape.range, stage) + ", or " +
                   lower_density(plan, stage, calm_compression / (3 * most.pressure));
}

template void blame_contact(Failure&, core::Surroundings<2>&, const plan::Plan&, const scene::StageSetting&);
template void blame_contact(Failure&, core::Surroundings<3>&, const plan::Plan&, const scene::StageSetting&);

}  // namespace rouleau::monitor
