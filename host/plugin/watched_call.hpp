// Calls of a plugin's functions at which it could do more than compute.
#pragma once

#include <string>
#include <type_traits>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "base/text.hpp"
#include "manifest.hpp"
#include "process_state.hpp"

namespace rouleau::plugin {

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

}  // namespace rouleau::plugin
