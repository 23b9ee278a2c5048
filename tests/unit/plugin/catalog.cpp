// The search for manifests: order, duplicates, and folders that are not as they should be.
#include "plugin/catalog.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "plugin_folder.hpp"

using rouleau::Cause;
using rouleau::Error;
using rouleau::Place;
using namespace rouleau::plugin;
using namespace rouleau::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Json manifest_with_id(const std::string& id) {
  Json manifest = good_manifest();
  manifest["id"] = id;
  return manifest;
}

std::vector<std::string> ids_of(const Catalog& catalog) {
  std::vector<std::string> ids;
  for (const auto& manifest : catalog.manifests()) ids.push_back(manifest.id);
  return ids;
}

const Place somewhere{"scene.json", "/interactions/0/model", 3, 4};

/// Sets ROULEAU_PLUGIN_PATH for the length of a test.
struct PluginPath {
  explicit PluginPath(const std::string& value) { setenv("ROULEAU_PLUGIN_PATH", value.c_str(), 1); }
  ~PluginPath() { unsetenv("ROULEAU_PLUGIN_PATH"); }
  PluginPath(const PluginPath&) = delete;
  PluginPath& operator=(const PluginPath&) = delete;
};

}  // namespace

TEST_CASE("manifests are found in the order of the folders, then by name, then in sub-folders") {
  const PluginFolder first, second;
  first.write("z.json", manifest_with_id("z"));
  first.write("deep/er/a.json", manifest_with_id("a"));
  first.write("b.json", manifest_with_id("b"));
  second.write("0.json", manifest_with_id("zero"));
  const Catalog catalog({first.path(), second.path()});
  CHECK(ids_of(catalog) == std::vector<std::string>{"b", "z", "a", "zero"});
  CHECK(catalog.refused().empty());
  CHECK(catalog.find(ModelKind::interaction, "a", somewhere).file == first.path() / "deep/er/a.json");
}

TEST_CASE("folders of a scene are searched unless the environment says that scenes bring no plugins") {
  const PluginFolder folder;
  folder.write("mine.json", manifest_with_id("mine"));
  const auto found = [&] {
    const std::vector<fs::path> path = plugin_search_path({}, {folder.path()});
    return std::count(path.begin(), path.end(), folder.path());
  };
  CHECK(found() == 1);
  setenv("ROULEAU_SCENE_PLUGINS", "no", 1);
  CHECK(found() == 0);
  const Catalog catalog(plugin_search_path({}, {folder.path()}));
  CHECK_THAT(thrown_by([&] { (void)catalog.find(ModelKind::interaction, "mine", somewhere); }).what(),
             Contains("not searched: what a scene names in plugin_dirs"));
  setenv("ROULEAU_SCENE_PLUGINS", "maybe", 1);
  CHECK_THROWS_AS(found(), Error);
  unsetenv("ROULEAU_SCENE_PLUGINS");
}

TEST_CASE("JSON files without a manifest key are somebody else's and are not looked at") {
  const PluginFolder folder;
  folder.write("data.json", std::string(R"({"id": "data"})"));
  folder.write("list.json", std::string("[1, 2]"));
  folder.write("manifest.txt", good_manifest());
  const Catalog catalog({folder.path()});
  CHECK(catalog.manifests().empty());
  CHECK(catalog.refused().empty());
}

TEST_CASE("two manifests with one id are both refused and the error names both files") {
  const PluginFolder first, second;
  const auto one = first.write("one.json", manifest_with_id("twice"));
  const auto two = second.write("two.json", manifest_with_id("twice"));
  second.write("other.json", manifest_with_id("other"));
  const Catalog catalog({first.path(), second.path()});
  CHECK(ids_of(catalog) == std::vector<std::string>{"other"});
  CHECK(catalog.refused().size() == 2);
  const Error error = thrown_by([&] { (void)catalog.find(ModelKind::interaction, "twice", somewhere); });
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains(one.string()) && Contains(two.string()) && Contains("2 manifests have the id"));
}

TEST_CASE("a broken manifest is not silently replaced by another one with its id") {
  const PluginFolder mine, shipped;
  Json broken = manifest_with_id("morse");
  broken["parameters"][0]["unit"] = "no unit at all";
  const auto one = mine.write("morse.json", broken);
  const auto two = shipped.write("morse.json", manifest_with_id("morse"));
  const Catalog catalog({mine.path(), shipped.path()});
  const Error error = thrown_by([&] { (void)catalog.find(ModelKind::interaction, "morse", somewhere); });
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains(one.string()) && Contains(two.string()) && Contains("/parameters/0/unit"));
}

TEST_CASE("an id that nobody offers is bad input with the nearest name and the folders searched") {
  const PluginFolder folder;
  folder.write("morse.json", manifest_with_id("morse"));
  const auto unreadable = folder.write("x.json", std::string("{"));
  const Catalog catalog({folder.path()});
  const Error error = thrown_by([&] { (void)catalog.find(ModelKind::interaction, "morze", somewhere); });
  CHECK(error.cause() == Cause::bad_input);
  CHECK(error.place().line == 3);
  CHECK_THAT(error.what(),
             Contains("did you mean \"morse\"?") && Contains(folder.path().string()) && Contains(unreadable.string()));
}

TEST_CASE("a model of another kind is bad input that says which kind is wanted") {
  const PluginFolder folder;
  folder.write("morse.json", manifest_with_id("morse"));
  const Error error = thrown_by([&] { (void)Catalog({folder.path()}).find(ModelKind::membrane, "morse", somewhere); });
  CHECK(error.cause() == Cause::bad_input);
  CHECK_THAT(error.what(), Contains("interaction") && Contains("membrane"));
}

TEST_CASE("a folder or file that several ways lead to is found once") {
  const PluginFolder folder;
  folder.write("sub/a.json", manifest_with_id("a"));
  fs::create_directory_symlink("..", folder.path() / "sub/loop");
  fs::create_directory_symlink("sub", folder.path() / "again");
  fs::create_symlink("a.json", folder.path() / "sub/b.json");
  const Catalog catalog({folder.path(), folder.path() / "sub", folder.path() / "sub/../sub"});
  CHECK(catalog.manifests().size() == 1);
  CHECK(catalog.refused().empty());
}

TEST_CASE("links that lead nowhere, links to themselves and pipes are reported and skipped") {
  const PluginFolder folder;
  folder.write("good.json", good_manifest());
  fs::create_symlink("nowhere", folder.path() / "broken.json");
  fs::create_symlink("self.json", folder.path() / "self.json");
  fs::create_symlink("self", folder.path() / "self");
  REQUIRE(mkfifo((folder.path() / "pipe.json").c_str(), 0600) == 0);
  const Catalog catalog({folder.path(), folder.path() / "absent"});
  CHECK(ids_of(catalog) == std::vector<std::string>{"good"});
  CHECK(catalog.refused().size() == 5);
}

TEST_CASE("a folder that may not be read is reported and skipped") {
  if (geteuid() == 0) return;  // root may read everything
  const PluginFolder folder;
  folder.write("good.json", good_manifest());
  folder.write("secret/a.json", manifest_with_id("a"));
  fs::permissions(folder.path() / "secret", fs::perms::none);
  const Catalog catalog({folder.path()});
  fs::permissions(folder.path() / "secret", fs::perms::owner_all);
  CHECK(catalog.manifests().size() == 1);
  REQUIRE(catalog.refused().size() == 1);
  CHECK_THAT(catalog.refused()[0].reason, Contains("ermission"));
}

TEST_CASE("the search path is the command line, the scene, the environment and then the installation") {
  const PluginFolder line, scene, environment, other;
  const PluginPath variable("::" + environment.path().string() + ":/no/such/folder:" + other.path().string() + ":");
  const auto path = plugin_search_path({line.path()}, {scene.path()});
  REQUIRE(path.size() >= 4);
  CHECK(path[0] == line.path());
  CHECK(path[1] == scene.path());
  CHECK(path[2] == environment.path());
  CHECK(path[3] == other.path());
  for (std::size_t i = 4; i < path.size(); ++i) CHECK_THAT(path[i].string(), Contains("/rouleau/plugins"));
}

TEST_CASE("folders that the user named must exist and the environment's must be absolute") {
  const PluginFolder folder;
  const auto file = folder.write("file", std::string());
  for (const auto& wrong : {folder.path() / "absent", file}) {
    const Error line = thrown_by([&] { plugin_search_path({wrong}, {}); });
    CHECK(line.cause() == Cause::bad_input);
    CHECK_THAT(line.what(), Contains(wrong.string()));
    CHECK(thrown_by([&] { plugin_search_path({}, {wrong}); }).cause() == Cause::bad_input);
  }
  const PluginPath variable("plugins");
  CHECK(thrown_by([&] { plugin_search_path({}, {}); }).cause() == Cause::bad_input);
}

TEST_CASE("a folder that cannot be one of plugins, for it holds ten thousand others, is refused and not searched") {
  const PluginFolder folder;
  for (int i = 0; i <= 10'000; ++i) std::filesystem::create_directory(folder.path() / std::to_string(i));
  const Error error = thrown_by([&] { Catalog({folder.path()}); });
  CHECK(error.cause() == Cause::bad_input);
  CHECK(error.place().file == folder.path().string());
  CHECK_THAT(error.what(), Contains("more than 10000 folders") && Contains("name the folder that holds them"));
}
