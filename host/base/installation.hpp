// Where what is installed with this code lies. It is found from the code's own place, so that an installation works
// wherever it is moved to, and a build as one does.
#pragma once

#include <filesystem>
#include <vector>

namespace rouleau {

/// The installation or build that the running program belongs to, or the Python module that this code is part of.
/// Absolute paths without symbolic links; empty where the system does not say where the code is.
struct Installation {
  std::filesystem::path folder;                  ///< with bin/ in it
  std::filesystem::path data;                    ///< share/
  std::filesystem::path programs;                ///< libexec/rouleau/: what only rouleau starts
  std::vector<std::filesystem::path> libraries;  ///< lib/, by the names that systems have for it
};

const Installation& installation();

}  // namespace rouleau
