// The cheap runs of the same scene that error bars are made of: which there are, and their scenes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::accuracy {

/// What a companion shows, by its difference from another run.
enum class Role {
  lattice,  ///< on a coarser lattice, all else as in the run: against the run, the lattice's error
  start,    ///< as that one, with flows that are developed when their stages begin: against it, the error of the start
  inertia   ///< as the one before, in a fluid of another density: against it, the error of the relaxed density
};
const char* name_of(Role role);

struct Companion {
  Role role;
  nlohmann::json scene;
  std::string differs;  ///< "88 x 44 nodes", for people
};

struct Companions {
  std::vector<Companion> runs;  ///< the one for the lattice first; what a scene does not need is left out
  double refinement = 1;        ///< spacing of the companions over the run's
  double order = 2;             ///< at which the lattice's error falls
  double density = 1;           ///< density factors of the companion for inertia over the run's
  double relaxed = 0;           ///< share of the density that is not the fluid's own: 1 - 1/density_factor, the largest
  double expected_share = 0;    ///< of what the run costs
  std::string why_none;         ///< why there are no companions; empty: there are
};

/// The companions of a scene that has been read, on the finest coarser lattice of the same shape with which the steps of
/// all of them are expected to cost a third of the run, by plan::step_cost, less what starting them and their outputs
/// take: of a short run that is a good part. The run took so many seconds, `outputs_s` of them for its outputs.
Companions choose_companions(const scene::Scene& scene, double run_s, double outputs_s);

}  // namespace rouleau::accuracy
