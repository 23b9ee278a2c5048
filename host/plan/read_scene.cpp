#include "read_scene.hpp"

#include <algorithm>

#include "json/document.hpp"
#include "plan.hpp"
#include "plan_models.hpp"
#include "shape/outline.hpp"
#include "shape/random_cells.hpp"

namespace rouleau::plan {
namespace {

/// Every try at least halves what exceeds a limit, or nearly keeps it.
constexpr int most_tries = 20;
constexpr double to_spare = 1.02;

/// Wells deeper than this share of the membranes' stretching modulus leak with the slip correction: by 0.7 % of the
/// area at rest at 0.072, by nothing that was seen at 0.003 (docs/accuracy.md, cells in contact); between them nothing
/// was measured.
constexpr double deepest_corrected_well = 0.02;

bool attracts_strongly(const Plan& plan) {
  const double modulus = stretching_modulus(plan);
  for (const auto& well : plan.wells) {
    const auto& depth = well.at("depth_J_m2");
    if (depth.is_number() && !(depth.get<double>() <= deepest_corrected_well * modulus)) return true;
  }
  return false;
}

NumericsBounds tightened(NumericsBounds bounds, const Plan& plan) {
  if (attracts_strongly(plan)) bounds.slip_correction = false;
  for (const Limit& limit : plan.limits) {
    if (limit.margin >= 1 || !(limit.margin > 0)) continue;
    if (limit.remedied_by == RemediedBy::density_factor) {
      const double kept = plan.scene->numerics.density_factor * limit.margin / to_spare;
      bounds.most_density_factor = std::min(bounds.most_density_factor, kept);
    } else if (limit.remedied_by == RemediedBy::resolution) {
      const double radius = shape::smallest_radius(*plan.scene) / lattice_spacing(*plan.scene);
      bounds.least_radius = std::max(bounds.least_radius, radius / limit.margin);
    }
  }
  return bounds;
}

}  // namespace

scene::Scene read_unpacked_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                                 const NumericsBounds& bounds) {
  auto document = std::make_shared<json::Document>(scene::read_document(file, overrides));
  std::optional<scene::NumericsChoice> choice = fill_in_numerics(*document, bounds);
  scene::Scene scene = scene::read_scene(std::move(document));
  scene.numerics_choice = std::move(choice);
  shape::add_random_cells(scene);
  return scene;
}

scene::Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  scene::Scene scene = read_unpacked_scene(file, overrides);
  shape::pack_cells(scene);  // may take a while: after everything else has been found right
  return scene;
}

scene::Scene read_within_limits(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                                const std::function<plugin::Catalog(const scene::Scene&)>& catalog_of) {
  NumericsBounds bounds;
  scene::Scene scene = read_unpacked_scene(file, overrides, bounds);
  for (int tries = 0; tries < most_tries && scene.numerics_choice; ++tries) {
    const plugin::Catalog catalog = catalog_of(scene);
    const NumericsBounds tighter = tightened(bounds, make_plan(scene, catalog));
    if (tighter == bounds) break;
    bounds = tighter;
    scene = read_unpacked_scene(file, overrides, bounds);
  }
  shape::pack_cells(scene);
  return scene;
}

}  // namespace rouleau::plan
