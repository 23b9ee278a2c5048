// How many bytes a run will write, known before its first step.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "stage_scales.hpp"

namespace rouleau::plan {

struct OutputEstimate {
  double outputs = 0, field_outputs = 0;  ///< how often rows and outlines are written, and fields with them, at most
  double frames_bytes = 0;                ///< frames.h5; of compressed fields what they would take without compression
  double fields_bytes = 0;                ///< the part of it that compression makes smaller
  double tables_bytes = 0;                ///< the .csv files, to about a quarter
  bool compressed = false;
  [[nodiscard]] double bytes() const { return frames_bytes + tables_bytes; }
};

/// At most: stages that end at rest or at a fault write less. HDF5's own share was measured (tests/commands).
OutputEstimate estimate_output(const scene::Scene& scene, const std::vector<StageSetting>& stages);

nlohmann::json to_json(const OutputEstimate& estimate);

}  // namespace rouleau::plan
