// Locks: what they hold, how damaged ones are refused, and that nothing else than what is locked is found or opened.
#include "plugin/lock.hpp"
#include "base/input_file.hpp"

#include "plugin/catalog.hpp"
#include "plugin/library.hpp"
#include "plugin_folder.hpp"

using rouleau::Cause;
using rouleau::Error;
using rouleau::Place;
using namespace rouleau::plugin;
using namespace rouleau::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const Place somewhere{"scene.json", "/interactions/0/model", 3, 4};
constexpr auto interaction = ModelKind::interaction;

/// A folder with a plugin that opens, and its lock.
struct LockedFolder : PluginFolder {
  LockedFolder() {
    copy(TESTED_models, "libgood.so");
    write("good.json", good_manifest());
    const Catalog catalog({path()});
    write("scene.lock.json", lock_text({lock_plugin(catalog.find(interaction, "good", {}))}));
  }
  [[nodiscard]] fs::path scene() const { return path() / "scene.json"; }
  [[nodiscard]] fs::path lock_file() const { return path() / "scene.lock.json"; }
  [[nodiscard]] Catalog locked_catalog() const {
    Catalog catalog({path()});
    catalog.set_lock(read_lock(lock_file(), "lock it again"));
    return catalog;
  }
  /// The error with the lock changed by a JSON Patch.
  [[nodiscard]] Error damaged_by(const char* patch) const {
    const auto whole = Json::parse(std::ifstream(lock_file()));
    const auto file = write("damaged.json", whole.patch(Json::parse(patch)));
    return thrown_by([&] { (void)read_lock(file, "lock it again"); });
  }
};

}  // namespace

TEST_CASE("a lock lies beside its scene") {
  CHECK(lock_beside("scenes/shear.json") == "scenes/shear.lock.json");
  CHECK(lock_beside("shear.json") == "shear.lock.json");
  CHECK(lock_beside("/a.b/shear") == "/a.b/shear.lock.json");
}

TEST_CASE("a lock holds id, kind, version and the hashes of library and manifest") {
  const LockedFolder folder;
  const Lock lock = read_lock(folder.lock_file(), "lock it again");
  REQUIRE(lock.plugins.size() == 1);
  const LockedPlugin& plugin = *lock.find("good");
  CHECK(plugin.kind == "interaction");
  CHECK(plugin.version == "1.0.0");
  CHECK(plugin.library_sha256 == rouleau::sha256(folder.path() / "libgood.so"));
  CHECK(plugin.manifest_sha256 == rouleau::sha256(folder.path() / "good.json"));
  CHECK(lock.find("other") == nullptr);
  CHECK(lock.sha256 == rouleau::sha256(folder.lock_file()));
}

TEST_CASE("the text of a lock does not depend on the order in which a scene names its models") {
  const LockedPlugin a{"a", "membrane", "1.0.0", "l", "m"}, b{"b", "collision", "1.0.0", "l", "m"};
  CHECK(lock_text({a, b}) == lock_text({b, a}));
}

TEST_CASE("what is locked is found and opened") {
  const LockedFolder folder;
  const Catalog catalog = folder.locked_catalog();
  CHECK_NOTHROW(open_model(catalog.find(interaction, "good", somewhere)));
}

TEST_CASE("another library than the locked one is not opened, and both hashes are named") {
  const LockedFolder folder;
  const std::string before = rouleau::sha256(folder.path() / "libgood.so");
  std::ofstream(folder.path() / "libgood.so", std::ios::app) << "x";  // ELF files may have anything at their end
  const Catalog catalog = folder.locked_catalog();
  const Manifest& manifest = catalog.find(interaction, "good", somewhere);  // its manifest is the locked one
  const Error error = thrown_by([&] { (void)open_model(manifest); });
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains("expected SHA-256 " + before) &&
                               Contains("found SHA-256 " + rouleau::sha256(folder.path() / "libgood.so")) &&
                               Contains(folder.lock_file().string()) && EndsWith("\n  lock it again"));
  // Without the lock the changed library is a good one.
  const Catalog unlocked({folder.path()});
  CHECK_NOTHROW(open_model(unlocked.find(interaction, "good", somewhere)));
}

TEST_CASE("another manifest, version or kind than the locked one is not found") {
  const std::vector<std::pair<Json, std::string>> changes = {
      {{{"title", "Another title"}}, "expected SHA-256 of the manifest "},
      {{{"version", "1.0.1"}}, "expected version 1.0.0, by the lock "}};
  for (const auto& [change, words] : changes) {
    const LockedFolder folder;
    Json manifest = good_manifest();
    manifest.update(change);
    folder.write("good.json", manifest);
    const Catalog catalog = folder.locked_catalog();
    const Error error = thrown_by([&] { (void)catalog.find(interaction, "good", somewhere); });
    CHECK(error.cause() == Cause::plugin_refused);
    CHECK(error.place().line == 3);
    CHECK_THAT(error.what(), Contains(words) && Contains("\n  found ") && EndsWith("\n  lock it again"));
  }
  const LockedFolder folder;
  Lock lock = read_lock(folder.lock_file(), "lock it again");
  lock.plugins[0].kind = "membrane";
  Catalog catalog({folder.path()});
  catalog.set_lock(lock);
  CHECK_THAT(thrown_by([&] { (void)catalog.find(interaction, "good", somewhere); }).what(),
             Contains("expected kind membrane") && Contains("found kind interaction"));
}

TEST_CASE("a plugin that the lock does not hold is not found, and a change to the scene is no way round") {
  const LockedFolder folder;
  Json other = good_manifest();
  other["id"] = "other";
  folder.write("other.json", other);
  const Catalog catalog = folder.locked_catalog();
  const Error error = thrown_by([&] { (void)catalog.find(interaction, "other", somewhere); });
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains("\"other\" is not in the lock") && Contains("which holds: good"));
  CHECK_THAT(error.what(), !Contains("changed scene"));
  const Place set{"--set", "/interactions/0/model", 0, 0};
  CHECK_THAT(thrown_by([&] { (void)catalog.find(interaction, "other", set); }).what(),
             Contains("binds a changed scene, too"));
}

TEST_CASE("a damaged lock is bad input with its place, a missing one an input error") {
  const LockedFolder folder;
  const std::vector<std::pair<const char*, const char*>> damages = {
      {R"([{"op": "replace", "path": "/lock", "value": 2}])", "/lock"},
      {R"([{"op": "remove", "path": "/plugins"}])", ""},
      {R"([{"op": "add", "path": "/plugin", "value": []}])", "/plugin"},
      {R"([{"op": "remove", "path": "/plugins/0/library_sha256"}])", "/plugins/0"},
      {R"([{"op": "replace", "path": "/plugins/0/manifest_sha256", "value": "12ab"}])", "/plugins/0/manifest_sha256"},
      {R"([{"op": "replace", "path": "/plugins/0/kind", "value": "potential"}])", "/plugins/0/kind"},
      {R"([{"op": "copy", "from": "/plugins/0", "path": "/plugins/1"}])", "/plugins/1/id"}};
  for (const auto& [patch, pointer] : damages) {
    INFO(patch);
    const Error error = folder.damaged_by(patch);
    CHECK(error.cause() == Cause::bad_input);
    CHECK(error.place().pointer == pointer);
  }
  const auto cut = folder.write("cut.json", std::string(R"({"lock": 1, "plugins": [)"));
  CHECK(thrown_by([&] { (void)read_lock(cut, "lock it again"); }).cause() == Cause::bad_input);
  CHECK(thrown_by([&] { (void)read_lock(folder.path() / "absent", "lock it again"); }).cause() == Cause::input_output);
}

TEST_CASE("a plugin whose library is missing or leads elsewhere cannot be locked") {
  const LockedFolder folder;
  const Catalog catalog({folder.path()});
  fs::remove(folder.path() / "libgood.so");
  const Manifest& manifest = catalog.find(interaction, "good", somewhere);
  CHECK(thrown_by([&] { (void)lock_plugin(manifest); }).cause() == Cause::plugin_refused);
  fs::create_symlink(TESTED_models, folder.path() / "libgood.so");
  CHECK_THAT(thrown_by([&] { (void)lock_plugin(manifest); }).what(), Contains("leads out of the folder"));
}
