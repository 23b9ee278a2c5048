#include "watched_call.hpp"

namespace rouleau::plugin {

void require_unchanged(const ProcessState& before, const Manifest& manifest, const std::string& function) {
  const std::vector<std::string> changed = before.restore();
  if (changed.empty()) return;
  throw Error(Cause::plugin_refused, Place{manifest.file.string()},
              "the plugin " + in_quotes(manifest.id) + " changes, in its function " + function + ", " +
                  listed(changed) + "\n  of the whole program; a plugin may only compute",
              {"report it to the plugin's author"});
}

}  // namespace rouleau::plugin
