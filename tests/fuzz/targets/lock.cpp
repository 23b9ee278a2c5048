// Locks: which plugins a scene may use.
#include "plugin/lock.hpp"

#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const fuzz::MemoryFile file(bytes);
    const auto lock = plugin::read_lock(file.path(), "");
    // A lock that can be read can be written, and says the same then.
    const fuzz::MemoryFile again(plugin::lock_text(lock.plugins));
    if (plugin::read_lock(again.path(), "").plugins.size() != lock.plugins.size()) {
      fuzz::broken_promise("a lock written again", std::string(bytes));
    }
    for (const std::string& id : {lock.plugins.empty() ? "trt" : lock.plugins.front().id, std::string("no-such-id")}) {
      plugin::Manifest manifest{};
      manifest.file = file.path();
      manifest.id = id;
      manifest.kind = plugin::ModelKind::collision;
      fuzz::may_refuse([&] { plugin::require_locked(lock, manifest, {"scene.json", "/fluid/collision/model", 1, 1}); });
    }
  });
}

fuzz::Form fuzz_form() { return {&plugin::lock_schema(), {"trt", "1.0.0"}}; }
