// What every user of the machine may write to is not trusted: manifests, libraries, and the folders that hold them.
#include "plugin/trust.hpp"

#include <sys/stat.h>

#include "plugin/catalog.hpp"
#include "plugin_folder.hpp"

using namespace rouleau;
using namespace rouleau::plugin;
using namespace rouleau::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const Place somewhere{"scene.json", "/interactions/0/model", 3, 4};

void set_mode(const fs::path& path, unsigned mode) { REQUIRE(chmod(path.c_str(), mode) == 0); }

/// The reason for which the model "good" is refused by name; empty: it is found.
std::string refusal(const std::vector<fs::path>& folders) {
  const Catalog catalog(folders);
  try {
    (void)catalog.find(ModelKind::interaction, "good", somewhere);
    return {};
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::plugin_refused);
    CHECK(catalog.refused().size() == 1);
    CHECK(catalog.refused()[0].id == "good");
    return error.what();
  }
}

}  // namespace

TEST_CASE("a manifest or library that every user may write to is refused, with its mode and the remedy") {
  const PluginFolder folder;
  const auto manifest = folder.write("good.json", good_manifest());
  const auto library = folder.write("libgood.so", std::string("not opened"));
  CHECK(refusal({folder.path()}).empty());
  for (const auto& file : {manifest, library}) {
    set_mode(file, 0646);
    CHECK_THAT(refusal({folder.path()}),
               Contains("the file " + file.string() + " (mode 0646)") && Contains("chmod o-w " + file.string()));
    set_mode(file, 0644);
  }
  CHECK(refusal({folder.path()}).empty());
}

TEST_CASE("each folder from the searched one to the manifest's counts, and none above") {
  const PluginFolder folder;
  folder.write("plugins/mine/deep/good.json", good_manifest());
  const auto searched = folder.path() / "plugins";
  for (const auto& open : {searched, searched / "mine", searched / "mine/deep"}) {
    set_mode(open, 0777);
    CHECK_THAT(refusal({searched}), Contains("the folder " + open.string() + " (mode 0777)"));
    CHECK_THAT(refusal({searched.string() + "/"}), Contains("(mode 0777)"));
    set_mode(open, 0755);
  }
  set_mode(folder.path(), 0777);
  CHECK(refusal({searched}).empty());
  CHECK(refusal({searched / "mine"}).empty());
  CHECK_THAT(refusal({folder.path()}), Contains("the folder " + folder.path().string() + " (mode 0777)"));
}

TEST_CASE("the sticky bit keeps nobody from adding a plugin and is no excuse") {
  const PluginFolder folder;
  folder.write("good.json", good_manifest());
  set_mode(folder.path(), 01777);
  CHECK_THAT(refusal({folder.path()}), Contains("(mode 1777)"));
}

TEST_CASE("the owner and the group may write to folders and files") {
  const PluginFolder folder;
  const auto manifest = folder.write("good.json", good_manifest());
  set_mode(folder.path(), 0775);
  set_mode(manifest, 0664);
  CHECK(refusal({folder.path()}).empty());
}

TEST_CASE("links count as what they lead to") {
  const PluginFolder folder, elsewhere;
  const auto manifest = elsewhere.write("good.json", good_manifest());
  fs::create_symlink(manifest, folder.path() / "link.json");
  CHECK(refusal({folder.path()}).empty());
  set_mode(manifest, 0666);
  CHECK_THAT(refusal({folder.path()}), Contains("link.json (mode 0666)"));
  set_mode(manifest, 0644);
  set_mode(elsewhere.path(), 0777);
  CHECK_THAT(refusal({folder.path()}), Contains("the folder " + elsewhere.path().string()));

  const PluginFolder other;
  fs::create_directory_symlink(elsewhere.path(), other.path() / "sub");
  CHECK_THAT(refusal({other.path()}), Contains((other.path() / "sub").string() + " (mode 0777)"));
}

TEST_CASE("a manifest that anybody could have put there is not used in another's stead, nor replaced by it silently") {
  const PluginFolder open, mine;
  open.write("good.json", good_manifest());
  mine.write("good.json", good_manifest());
  set_mode(open.path(), 0777);
  const Error error = thrown_by([&] {
    (void)Catalog({open.path(), mine.path()}).find(ModelKind::interaction, "good", somewhere);
  });
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains("(mode 0777)") && Contains("2 manifests have the id"));
}

TEST_CASE("JSON that is no manifest may lie in open folders") {
  const PluginFolder folder;
  folder.write("data.json", std::string(R"({"id": "good"})"));
  set_mode(folder.path(), 0777);
  CHECK(Catalog({folder.path()}).refused().empty());
}
