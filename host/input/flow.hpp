// What drives the flow of a stage.
#pragma once

#include "scene.hpp"

namespace rouleau::host {

/// Force per volume that drives the fluid in a stage, N/m3.
Eigen::Vector2d driving_force(const Stage& stage, const Scene& scene);

/// Shear rate that a stage's numbers are made with, 1/s: that of the walls where they move; else that of the developed
/// flow between them, |du/dy| averaged over the height, G H / (4 mu), which is its largest velocity over half the
/// height. 0 at rest, and where no wall holds a flow that is driven.
double mean_shear_rate(const Stage& stage, const Scene& scene);

}  // namespace rouleau::host
