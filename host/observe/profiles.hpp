// Velocity and hematocrit across a channel or a tube, at one instant and over a stage.
#pragma once

#include <string>
#include <vector>

#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "json/json.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

/// What cells enclose in each bin of a scene's output.profiles, over what the bin holds. From the membranes alone: the
/// integral of x over the part of a surface that faces along it, in 2D exactly, in 3D by sixteenths of triangles. Over
/// all bins it is what the cells enclose, to rounding. All ranks together, of all cells.
std::vector<double> hematocrit_profile(const core::Membranes& cells, const scene::Scene& scene,
                                       const core::Ranks<2>& ranks = {});
std::vector<double> hematocrit_profile(const core::Surfaces& cells, const scene::Scene& scene,
                                       const core::Ranks<3>& ranks = {});

/// Mean velocity along x in each bin, of all that flows there, from the means of the lattice's rows
/// (core::FluidMeasures), each of which is spread over its height or, in a tube, stands where its middle is; NaN in a
/// bin without rows.
std::vector<double> velocity_profile(const std::vector<double>& row_velocities, const scene::Scene& scene);

/// Middle of a bin, m: from the lower edge of the domain, or the axis of a tube.
double place_of_bin(const scene::Scene& scene, int bin);

/// Follows the profiles of a run.
class ProfileHistory {
 public:
  struct Instant {
    double time;
    std::vector<double> velocity, hematocrit;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Instant, time, velocity, hematocrit)
  };
  struct StageProfiles {
    std::string stage;
    std::vector<Instant> instants;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(StageProfiles, stage, instants)
  };
  void follow(const Snapshot& snapshot);
  [[nodiscard]] const std::vector<StageProfiles>& stages() const { return stages_; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE_WITH_DEFAULT(ProfileHistory, stages_)

 private:
  std::vector<StageProfiles> stages_;
};

}  // namespace rouleau::observe
