#include <cmath>
#include <functional>
#include <limits>

#include "core/fluid/developed_flow.hpp"
#include "exact_flow.hpp"
#include "files/field_nodes.hpp"
#include "plan/read_scene.hpp"
#include "quantity.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::study {

namespace {

/// Why the exact flows do not hold for a run; empty where they do.
std::string why_no_exact_flow(const scene::Scene& scene) {
  if (!scene.cells.empty() || !scene.packings.empty())
    return "the scene has cells, and the exact flow is of the fluid alone";
  if (!scene.fluid.layers.empty()) return "the fluid has layers, and the exact flow is of one viscosity";
  if (scene.domain.has_shapes()) return "the exact flow between walls of any shape is not known";
  if (scene.domain.walled(1)) return "";
  return scene.domain.is_duct() ? "the scene has no walls across y" : "the scene has no walls";
}
std::string why_no_exact_flow(const Quantity& quantity, const scene::Scene& scene, const scene::Stage& stage,
                              bool first) {
  if (quantity.poiseuille && scene::driving_force(stage, scene).x() == 0)
    return "nothing drives the fluid along x in the stage " + stage.name;
  if (stage.changes()) return "what drives the stage " + stage.name + " changes in time";
  if (stage.mean_wall_speed != 0) return "the walls of the stage " + stage.name + " have a mean speed";
  if (quantity.poiseuille && stage.shear_rate != 0) return "the walls move in the stage " + stage.name;
  if (!quantity.poiseuille && stage.shear_rate == 0) return "the walls do not move in the stage " + stage.name;
  if (!quantity.poiseuille && scene::driving_force(stage, scene).x() != 0)
    return "a force drives the fluid in the stage " + stage.name;
  if (!quantity.steady && !first)
    return "the start-up is known of a fluid at rest, and the stage " + stage.name + " is not the first";
  if (!quantity.steady && scene.domain.is_duct() && !scene.domain.tube_radius)
    return "the start-up is known between two walls and in a tube, and the scene has a duct";
  if (!quantity.steady && !quantity.poiseuille && stage.start == scene::WallStart::developed)
    return "the stage " + stage.name + " starts with the developed flow";
  return "";
}

/// Velocity along x at a time; y and z from the lower walls, SI units.
using ExactFlow = std::function<double(double y, double z)>;

ExactFlow exact_flow(const Quantity& quantity, const scene::Scene& scene, const scene::Stage& stage, double time) {
  const scene::Domain& domain = scene.domain;
  const double viscosity = scene.fluid.viscosity, force = scene::driving_force(stage, scene).x() / viscosity;
  const double kinematic = viscosity / (scene.fluid.density * stage.density_factor);  // as it is simulated
  constexpr double long_ago = std::numeric_limits<double>::infinity();
  const double height = domain.size.y(), half = height / 2, half_depth = domain.size.z() / 2;
  if (domain.tube_radius) {
    const double radius = *domain.tube_radius, fastest = force * radius * radius / 4;
    const double since = quantity.steady ? long_ago : time * kinematic / (radius * radius);
    return
        [=](double y, double z) { return fastest * tube_start(std::hypot(y - half, z - half_depth) / radius, since); };
  }
  if (domain.is_duct()) {
    const double wall = stage.shear_rate * half;
    const core::DuctFlow duct{height, 2 * half_depth, {-wall, wall}, force};
    return [=](double y, double z) { return duct.at(y - half, z - half_depth).velocity; };
  }
  const double since = quantity.steady ? long_ago : time * kinematic / (height * height);
  if (quantity.poiseuille) {
    const double fastest = force * height * height / 8;
    return [=](double y, double) { return fastest * poiseuille_start(y / height, since); };
  }
  const double fastest = stage.shear_rate * half;
  return [=](double y, double) { return fastest * couette_start(y / height - 0.5, since); };
}

}  // namespace

Measured velocity_error(const Quantity& quantity, const std::filesystem::path& run_directory) {
  const scene::Scene scene = plan::read_unpacked_scene(run_directory / "scene.json").scene;
  if (const std::string why_not = why_no_exact_flow(scene); !why_not.empty()) return undefined_because(why_not);
  const auto field = files::last_velocity(run_directory / "frames.h5");
  if (!field) return undefined_because("frames.h5 has no velocity: ask for it in output.fields");
  const scene::Stage& stage = scene.stages.at(field->stage);
  if (const std::string why_not = why_no_exact_flow(quantity, scene, stage, field->stage == 0); !why_not.empty())
    return undefined_because(why_not);

  const ExactFlow flow = exact_flow(quantity, scene, stage, field->time);
  std::vector<double> exact;
  for (const double z : field->z) {
    for (const double y : field->y) {
      const double u = flow(y, z);
      for (std::size_t x = 0; x < field->nx; ++x) exact.insert(exact.end(), {u, 0, 0});  // nothing flows across
    }
  }
  const double error = relative_l2(field->velocity, exact);
  return std::isfinite(error) ? Measured{error, 0, ""} : undefined_because("the velocity in frames.h5 is not finite");
}

}  // namespace rouleau::study
