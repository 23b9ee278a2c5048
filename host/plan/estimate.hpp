// What a run will take, known before its first step: time, memory, bytes on the disk.
#pragma once

#include "json/json.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// What a membrane node's part of a step depends on, in three dimensions; in two it takes the same time in all of them.
struct MembraneScheme {
  double cutoff = 3.7;        ///< of the interactions between cells and within them, spacings; 0: there are none
  double near = 0.2;          ///< surfaces of other cells within the cutoff of a node, in the mean
  double renewals = 0.01;     ///< of the lists of contacts, in a step
  double active_nodes = 0;    ///< of the lattice, in reach of membranes, over the membranes' nodes
  bool sharp_kernel = false;  ///< of six points along each axis
  bool slip_correction = false;
  bool viscosity_contrast = false;  ///< with the slip correction: forces act beside the nodes
  bool semi_implicit = false;
};
MembraneScheme membrane_scheme(const Plan& plan);

/// Seconds of one step on one core, without outputs, as measured with AVX-512 (docs/results/plan-constants.md); other
/// machines differ by their memory and vector width.
double step_cost(double lattice_nodes, double membrane_nodes, scene::Precision precision, int dimension = 2,
                 const MembraneScheme& scheme = {});

/// At most: stages that end at rest or at a fault write less. HDF5's own share was measured (tests/commands).
struct OutputEstimate {
  double outputs = 0, field_outputs = 0;  ///< how often rows and outlines are written, and fields with them
  double frames_bytes = 0;                ///< frames.h5; of compressed fields what they would take without compression
  double fields_bytes = 0;                ///< the part of it that compression makes smaller
  double tables_bytes = 0;                ///< the .csv files, to about a quarter
  double checkpoint_bytes = 0;            ///< of one, without what models remember; the one before it is kept beside it
  bool fields_compressed = false;
  [[nodiscard]] double bytes() const { return frames_bytes + tables_bytes; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(OutputEstimate, outputs, field_outputs, frames_bytes, fields_bytes, tables_bytes,
                                 checkpoint_bytes, fields_compressed)
};

struct Estimate {
  double steps = 0;  ///< at most
  double wall_s = 0;
  double memory_bytes = 0;
  OutputEstimate output;
};

Estimate estimate(const Plan& plan);

/// Throws Error(input_output) where a part of the work wants more memory than the process can get. `what` begins the
/// sentence: "the run".
void require_memory(double bytes, const std::string& what);

/// Nodes of all membranes of a scene.
double membrane_nodes(const scene::Scene& scene);
/// What these take, bytes.
double membrane_memory(const scene::Scene& scene);

}  // namespace rouleau::plan
