// Checks what a library's open function returned before anything in it is used.
#pragma once

#include <rouleau/plugin.h>

#include <string>

#include "manifest.hpp"

namespace rouleau::plugin {

struct FoundModel {
  const rouleau_model* model;  ///< null when there is a fault
  std::string fault;           ///< continues "the library FILE ..."
};

/// The model of the manifest in a plugin's table, complete and in agreement with the manifest.
FoundModel find_model(const rouleau_plugin& plugin, const Manifest& manifest);

}  // namespace rouleau::plugin
