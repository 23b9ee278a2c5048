// A study as the user wrote it: scene, matrix, quantities and how they are timed, checked.
#pragma once

#include <filesystem>
#include <vector>

#include "json/json.hpp"
#include "quantity.hpp"
#include "trial/campaign.hpp"

namespace rouleau::study {

struct Study : trial::CampaignFile {
  int line = -1;  ///< index of an axis; -1 without axes
  trial::Point default_point;
  std::vector<Quantity> quantities;
  int threads = 1, repeats = 3;
  bool warm_up = true;
};

/// Throws Error(bad_input) with the place of the first fault, in the study or in its scene, Error(input_output) for a
/// file that cannot be read.
Study read_study(const std::filesystem::path& file);

/// The schemas of a study and of its study.json.
const nlohmann::json& study_schema();
const nlohmann::json& study_result_schema();

}  // namespace rouleau::study
