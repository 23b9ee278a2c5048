// Opens a plugin's shared library (the only user of Boost.DLL and of the dynamic loader), holds its table against the
// manifest, and watches calls in which it could do more than compute.
#pragma once

#include <rouleau/plugin.h>
#include <filesystem>
#include <string>
#include <type_traits>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "base/text.hpp"
#include "manifest.hpp"
#include "process_state.hpp"

namespace rouleau::plugin {

struct FoundModel {
  const rouleau_model* model;  ///< null when there is a fault
  std::string fault;           ///< continues "the library FILE ..."
};

/// The model of the manifest in a plugin's table, complete and in agreement with the manifest.
FoundModel find_model(const rouleau_plugin& plugin, const Manifest& manifest);

/// Throws Error(plugin_refused) when a plugin has changed something in its function.
void require_unchanged(const ProcessState& before, const Manifest& manifest, const std::string& function);

/// call_foreign() for a function of this plugin; throws Error(plugin_refused), too, when the function has changed what
/// belongs to the process, which is put back as it was.
template <class Call>
auto call_watched(const Manifest& manifest, const char* function, Call&& call) {
  const ProcessState before;
  if constexpr (std::is_void_v<decltype(call())>) {
    call_foreign(manifest.id, function, call);
    require_unchanged(before, manifest, function);
  } else {
    const auto result = call_foreign(manifest.id, function, call);
    require_unchanged(before, manifest, function);
    return result;
  }
}

/// The model that a manifest describes. Opens its library (RTLD_NOW | RTLD_LOCAL) after checking that it lies beside
/// the manifest (no path, no link out), is the one that a lock may ask for, and exports rouleau_open_v1; never unloads
/// it, so the result is valid for ever. The library is the one that was there when the manifest was read: one that was
/// built anew is loaded beside the old one, of a manifest that is read anew. Throws Error(plugin_refused) with
/// manifest, library path and the loader's own words.
const rouleau_model& open_model(const Manifest& manifest);

/// From now on a library stays what it is even where somebody writes to its file or cuts it short: for processes in
/// which plugins are built. Profilers then know its code by address alone.
void keep_libraries_apart();

// The steps that open_model takes, for the conformance tests; each throws as it does.

/// The library's file with all links followed: beside the manifest, made for this machine, with the symbol exported.
std::filesystem::path checked_library(const Manifest& manifest);
/// Loads that file for good and returns its rouleau_open_v1.
rouleau_open_function load_library(const Manifest& manifest);
/// The manifest's model in the table that a library's open function gives this host.
const rouleau_model& model_of(rouleau_open_function open, const Manifest& manifest);

/// SHA-256 of a manifest's library as it was when the manifest was read. Throws Error(plugin_refused) for a library
/// that open_model would not look into, or that has changed since and was not asked for before.
std::string library_sha256(const Manifest& manifest);

}  // namespace rouleau::plugin
