// Where a run with finer numerics goes that follows another one.
#pragma once

#include <string_view>

namespace rouleau::files {

/// Folder of a run's directory that holds the run with finer numerics which followed because the first one missed its
/// target: a whole run's directory.
inline constexpr std::string_view refined_folder = "refined";

}  // namespace rouleau::files
