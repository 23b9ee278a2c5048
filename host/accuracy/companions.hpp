// The cheap runs of the same scene that error bars are made of: which there are, and their scenes.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "scene/scene.hpp"

namespace rouleau::accuracy {

/// What a companion shows, by its difference from another run.
enum class Role {
  lattice,  ///< on a coarser lattice, all else as in the run: the lattice's error
  order,    ///< on a still coarser one: how fast that error falls
  start,    ///< flows are developed when their stages begin: the error of the start
  inertia   ///< in a fluid of another density: the error of the relaxed density
};
const char* name_of(Role role);

struct Companion {
  Role role;
  nlohmann::json scene;
  std::string differs;  ///< "88 x 44 nodes", for people
  std::string beyond;   ///< name of the stage that was added at its end; empty: none
  int against = -1;     ///< from which other companion of the choice it differs by its role alone; -1: from the run
};

struct Companions {
  std::vector<Companion> runs;  ///< the one for the lattice first; what a scene does not need is left out
  /// Spacing of the companion for the lattice over the run's; with a smaller relaxation time, on which the lattice's
  /// error depends, as if all of its error came from the spacing.
  double refinement = 1;
  double coarsest = 1;        ///< the same of the companion for the order
  double order = 2;           ///< at which the lattice's error falls in the end
  double usual_order = 2;     ///< at which it was measured to fall, where companions do not show it
  double density = 1;         ///< density factors of the companion for inertia over the run's
  double relaxed = 0;         ///< share of the density that is not the fluid's own: 1 - 1/density_factor, the largest
  double expected_share = 0;  ///< of what the run costs
  std::string why_none;       ///< why there are no companions; empty: there are
};

/// What a run has shown before its companions are chosen.
struct RunCost {
  double run_s = 0, outputs_s = 0;  ///< it took so many seconds, `outputs_s` of them for its outputs
  long outputs = 0;                 ///< how many
  bool moments = false;             ///< it reports when something happens
};

/// The companions of a scene that has been read: the finest coarser lattice of the same shape with which the steps of
/// all of them are expected to cost a third of the run, by plan::step_cost, less what starting them and their outputs
/// take, and one that is 1.25 times coarser again. The start and the density are changed on the coarser one; on the
/// finer where the run reports moments, for a coarse cell may come too late to what the run's has reached: for the same
/// reason companions then go on beyond the end of the scene. `most_compressed`: where the fluid of a coarser lattice
/// would give way to the shear by a larger share, companions take shorter steps at a smaller relaxation time.
Companions choose_companions(const scene::Scene& scene, const RunCost& cost, double most_compressed = INFINITY);

}  // namespace rouleau::accuracy
