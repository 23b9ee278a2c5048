// Opens a plugin's shared library (the only user of Boost.DLL and of the dynamic loader).
#pragma once

#include <rouleau/plugin.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "manifest.hpp"

namespace rouleau::plugin {

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
