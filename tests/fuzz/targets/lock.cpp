// Locks: which plugins a scene may use.
#include "plugin/lock.hpp"

#include "input/schema.hpp"
#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const fuzz::MemoryFile file(bytes);
    const auto lock = host::read_lock(file.path(), "scene.json");
    // A lock that can be read can be written, and says the same then.
    const fuzz::MemoryFile again(host::lock_text(lock.plugins));
    if (host::read_lock(again.path(), "scene.json").plugins.size() != lock.plugins.size()) {
      fuzz::broken_promise("a lock written again", std::string(bytes));
    }
    for (const std::string& id : {lock.plugins.empty() ? "trt" : lock.plugins.front().id, std::string("no-such-id")}) {
      host::Manifest manifest{};
      manifest.file = file.path();
      manifest.id = id;
      fuzz::may_refuse([&] { host::require_locked(lock, manifest, {"scene.json", "/fluid/collision/model", 1, 1}); });
    }
  });
}

fuzz::Form fuzz_form() { return {&host::lock_schema(), {"trt", "1.0.0"}}; }
