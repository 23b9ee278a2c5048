#include <cmath>
#include <limits>

#include "exact_flow.hpp"
#include "files/velocity_reader.hpp"
#include "plan/read_scene.hpp"
#include "quantity.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::study {

namespace {

Measured no_velocity_error(std::string why_not) {
  return {std::numeric_limits<double>::quiet_NaN(), 0, std::move(why_not)};
}

/// Why the exact flows do not hold for a run; empty where they do.
std::string why_no_exact_flow(const scene::Scene& scene) {
  if (!scene.cells.empty() || !scene.packings.empty())
    return "the scene has cells, and the exact flow is of the fluid alone";
  if (scene.domain.depth) return "the exact flow is of two dimensions, and the scene has three";
  if (!scene.fluid.layers.empty()) return "the fluid has layers, and the exact flow is of one viscosity";
  return scene.domain.periodic_y ? "the scene has no walls" : "";
}
std::string why_no_exact_flow(const Quantity& quantity, const scene::Scene& scene, const scene::Stage& stage,
                              bool first) {
  if (quantity.poiseuille && scene::driving_force(stage, scene).x() == 0)
    return "nothing drives the fluid along x in the stage " + stage.name;
  if (stage.oscillates()) return "what drives the stage " + stage.name + " oscillates";
  if (stage.mean_wall_speed != 0) return "the walls of the stage " + stage.name + " have a mean speed";
  if (quantity.poiseuille && stage.shear_rate != 0) return "the walls move in the stage " + stage.name;
  if (!quantity.poiseuille && stage.shear_rate == 0) return "the walls do not move in the stage " + stage.name;
  if (!quantity.poiseuille && scene::driving_force(stage, scene).x() != 0)
    return "a force drives the fluid in the stage " + stage.name;
  if (!quantity.steady && !first)
    return "the start-up is known of a fluid at rest, and the stage " + stage.name + " is not the first";
  if (!quantity.steady && !quantity.poiseuille && stage.start == scene::WallStart::developed)
    return "the stage " + stage.name + " starts with the developed flow";
  return "";
}

}  // namespace

Measured velocity_error(const Quantity& quantity, const std::filesystem::path& run_directory) {
  const scene::Scene scene = plan::read_unpacked_scene(run_directory / "scene.json").scene;
  if (const std::string why_not = why_no_exact_flow(scene); !why_not.empty()) return no_velocity_error(why_not);
  const auto field = files::last_velocity(run_directory / "frames.h5");
  if (!field) return no_velocity_error("frames.h5 has no velocity: ask for it in output.fields");
  const scene::Stage& stage = scene.stages.at(field->stage);
  if (const std::string why_not = why_no_exact_flow(quantity, scene, stage, field->stage == 0); !why_not.empty())
    return no_velocity_error(why_not);

  const double height = scene.domain.size.y(), viscosity = scene.fluid.viscosity;
  const double kinematic = viscosity / (scene.fluid.density * stage.density_factor);  // as it is simulated
  const double time =
      quantity.steady ? std::numeric_limits<double>::infinity() : field->time * kinematic / (height * height);
  const double fastest = quantity.poiseuille
                             ? scene::driving_force(stage, scene).x() * height * height / (8 * viscosity)
                             : stage.shear_rate * height / 2;
  std::vector<double> value = field->velocity_x, exact;
  for (const double y : field->y) {
    const double s = y / height;
    const double u = fastest * (quantity.poiseuille ? poiseuille_start(s, time) : couette_start(s - 0.5, time));
    exact.insert(exact.end(), field->nx, u);
  }
  value.insert(value.end(), field->velocity_y.begin(), field->velocity_y.end());
  exact.resize(value.size(), 0.0);  // nothing flows across
  const double error = relative_l2(value, exact);
  return std::isfinite(error) ? Measured{error, 0, ""} : no_velocity_error("the velocity in frames.h5 is not finite");
}

}  // namespace rouleau::study
