// NAME=VALUE: the error that a study is to find the cheapest setting for.
#pragma once

#include <string>
#include <vector>

#include "quantity.hpp"

namespace rouleau::study {

struct StudyTarget {
  std::size_t quantity;  ///< index
  double error;          ///< relative, or in the quantity's unit
};

/// "deformation=1%", "angle=0.5 deg", "area_drift=1e-4". Throws Error(bad_input) that quotes the text.
StudyTarget read_target(const std::string& text, const std::vector<Quantity>& quantities);

}  // namespace rouleau::study
