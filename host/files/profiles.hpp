// profiles.csv: means across a channel or a tube.
#pragma once

#include <string>

#include "observe/profiles.hpp"

namespace rouleau::files {

inline constexpr const char* profiles_file = "profiles.csv";

/// A row for each stage and bin: the means of observe::statistics; where it finds none, those over the second half of
/// the stage with errors that are no numbers.
std::string profiles_csv(const observe::ProfileHistory& history, const scene::Scene& scene);

}  // namespace rouleau::files
