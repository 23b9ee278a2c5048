// The opening of libraries: what is checked before loading, the loader's own words, and the tables inside.
#include "plugin/library.hpp"
#include "base/input_file.hpp"

#include <sys/stat.h>

#include <cstdlib>

#include "plugin/manifest_reader.hpp"
#include "plugin/model.hpp"
#include "plugin_folder.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::plugin;
using namespace rouleau::test;
using namespace rouleau::units;
using namespace rouleau::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Manifest manifest_in(const PluginFolder& folder, const std::string& id = "good") {
  Json manifest = good_manifest();
  manifest["id"] = id;
  return read_manifest(folder.write(id + ".json", manifest), Units());
}

/// The error of opening the library; it always names the manifest and the library.
Error refusal(const Manifest& manifest) {
  const Error error = thrown_by([&] { open_model(manifest); });
  INFO(error.what());
  CHECK(error.cause() == Cause::plugin_refused);
  CHECK_THAT(error.what(), Contains(manifest.file.string()) && Contains(manifest.library.string()));
  return error;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

ModelSetting setting() { return {{1e-7, 1e-6, 1e-15}, 1.25, false}; }

}  // namespace

TEST_CASE("a library that lies beside its manifest and agrees with it is opened") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  const Manifest manifest = manifest_in(folder);
  const rouleau_model& model = open_model(manifest);
  CHECK(model.id == std::string("good"));
  CHECK(&open_model(manifest) == &model);
}

TEST_CASE("a library that was built anew is loaded beside the old one, for a manifest that is read anew") {
  const PluginFolder folder;
  const fs::path library = folder.copy(TESTED_models, "libgood.so");
  const Manifest before = manifest_in(folder);
  keep_libraries_apart();
  const rouleau_model& old = open_model(before);
  const std::string old_hash = library_sha256(before);
  for (const bool in_place : {false, true}) {
    if (!in_place) fs::remove(library);
    // ELF files may have anything at their end.
    std::ofstream(library, std::ios::binary) << bytes_of(TESTED_models) << (in_place ? "in place" : "another file");
    const Manifest after = manifest_in(folder);
    const rouleau_model& anew = open_model(after);
    CHECK(&anew != &old);
    CHECK(&open_model(after) == &anew);
    CHECK(library_sha256(after) == rouleau::sha256(library));
    CHECK(&open_model(before) == &old);  // whoever has begun with it goes on with it
    CHECK(library_sha256(before) == old_hash);
  }
}

TEST_CASE("a library that is loaded stays what it is when its file is written to or cut short") {
  const PluginFolder folder;
  const fs::path library = folder.copy(TESTED_models, "libgood.so");
  const Manifest manifest = manifest_in(folder);
  keep_libraries_apart();
  const rouleau_model& model = open_model(manifest);
  std::ofstream(library, std::ios::binary) << std::string(fs::file_size(library), '\0');
  fs::resize_file(library, 0);
  CHECK(model.id == std::string("good"));
  CHECK_NOTHROW(ModelInstance(manifest, {1e-6, 1e6, 310, 0}, setting()));
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("is no shared library"));
}

TEST_CASE("a library that has changed since its manifest was read is refused") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  const Manifest manifest = manifest_in(folder);
  std::ofstream(folder.path() / "libgood.so", std::ios::app) << "x";
  CHECK_THAT(refusal(manifest).what(), Contains("has changed since its manifest was read"));
}

TEST_CASE("a stripped library is opened") {
  const PluginFolder folder;
  const auto library = folder.copy(TESTED_models, "libgood.so");
  const std::string command = std::string(STRIP_PROGRAM) + " '" + library.string() + '\'';
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK_NOTHROW(open_model(manifest_in(folder)));
}

TEST_CASE("a library that is a link within its folder is opened") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so.1.0");
  fs::create_symlink("libgood.so.1.0", folder.path() / "libgood.so");
  CHECK_NOTHROW(open_model(manifest_in(folder)));
}

TEST_CASE("a library that a link leads out of the folder for is refused") {
  const PluginFolder folder, elsewhere;
  const auto library = elsewhere.copy(TESTED_models, "libgood.so");
  fs::create_symlink(library, folder.path() / "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("leads out of the folder") && Contains(library.string()));
}

TEST_CASE("a library in a sub-folder that a link leads to is refused") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "sub/libgood.so");
  fs::create_symlink("sub/libgood.so", folder.path() / "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("leads out of the folder"));
}

TEST_CASE("a library that does not exist is refused") {
  const PluginFolder folder;
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("does not exist"));
  fs::create_symlink("nowhere", folder.path() / "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("link to a file that does not exist"));
}

TEST_CASE("folders and pipes in the place of a library are refused without waiting for them") {
  const PluginFolder folder;
  fs::create_directory(folder.path() / "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("not a regular file"));
  fs::remove(folder.path() / "libgood.so");
  REQUIRE(mkfifo((folder.path() / "libgood.so").c_str(), 0600) == 0);
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("not a regular file"));
}

TEST_CASE("files that are no libraries are refused in words") {
  const PluginFolder folder;
  for (const std::string& text : {std::string(), std::string("text"), std::string(5000, 'x')}) {
    folder.write("libgood.so", text);
    CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("is no shared library"));
  }
}

TEST_CASE("a library for another machine or word size is refused in words") {
  const PluginFolder folder;
  std::string bytes = bytes_of(TESTED_models);
  bytes[18] = static_cast<char>(bytes[18] == 20 ? 21 : 20);  // e_machine: PowerPC
  folder.write("libgood.so", bytes);
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("another kind of processor"));
  bytes[4] = 1;  // EI_CLASS: 32 bits
  folder.write("libgood.so", bytes);
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("32-bit"));
}

TEST_CASE("a library that is cut short at any place is refused and does not crash the program") {
  const PluginFolder folder;
  const std::string bytes = bytes_of(TESTED_models);
  const Manifest manifest = manifest_in(folder);
  for (std::size_t size = 0; size + 64 < bytes.size(); size += 509) {
    folder.write("libgood.so", bytes.substr(0, size));
    (void)refusal(manifest);
  }
}

TEST_CASE("a library whose section table is damaged is refused or opened, but never read out of bounds") {
  const PluginFolder folder;
  const std::string bytes = bytes_of(TESTED_models);
  const Manifest manifest = manifest_in(folder);
  // Offsets of e_phoff, e_shoff, e_phentsize, e_phnum, e_shentsize, e_shnum in a 64-bit header.
  for (const std::size_t at : {32, 40, 54, 56, 58, 60}) {
    std::string damaged = bytes;
    for (std::size_t i = 0; i < 2; ++i) damaged[at + i] = '\xff';
    folder.write("libgood.so", damaged);
    INFO(at);
    (void)refusal(manifest);
  }
}

TEST_CASE("a library without the plugin's function is refused before it is loaded") {
  const PluginFolder folder;
  folder.copy(TESTED_without_symbol, "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("does not export the function rouleau_open_v1"));
}

TEST_CASE("the loader's own words are in the message") {
  const PluginFolder folder;
  folder.copy(TESTED_missing_symbol, "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder)).what(), Contains("undefined symbol: function_that_nobody_has"));
}

TEST_CASE("a library that refuses the host or is older than the interface is refused") {
  const PluginFolder refusing, old;
  refusing.copy(TESTED_refusing, "libgood.so");
  CHECK_THAT(refusal(manifest_in(refusing)).what(), Contains("cannot work with this host"));
  old.copy(TESTED_old_plugin, "libgood.so");
  CHECK_THAT(refusal(manifest_in(old)).what(), Contains("rouleau_plugin with struct_size 8"));
}

TEST_CASE("a table that disagrees with its manifest is refused with what both say") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"newer", "has version 1.0.1"},
      {"without-version", "has version (none)"},
      {"membrane", "of the kind membrane, its manifest is for the kind interaction"},
      {"without-create", "no create or no destroy"},
      {"without-destroy", "no create or no destroy"},
      {"without-table", "has no rouleau_interaction"},
      {"two-tables", "more than one function table"},
      {"small-table", "struct_size 4"},
      {"half-table", "without all of its functions"},
      {"small", "struct_size 16"}};
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  for (const auto& [id, words] : cases) {
    INFO(id);
    CHECK_THAT(refusal(manifest_in(folder, id)).what(), Contains(words));
  }
}

TEST_CASE("a manifest whose id the library does not have is refused with the ids it has") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  CHECK_THAT(refusal(manifest_in(folder, "goood")).what(),
             Contains("did you mean \"good\"?") && Contains("small, good, newer, membrane"));
}

TEST_CASE("a model gets its parameters in lattice units, and in SI what holds a temperature") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  const Manifest manifest = manifest_in(folder);
  const ModelInstance model(manifest, {2e-6, 3.84e6, 310, 1}, setting());
  const auto* echo = static_cast<const double*>(model.self());
  // 1 J/m2 is kg/s2: in lattice units divided by mass / time^2.
  CHECK(echo[0] == Approx(2e-6 / (1e-15 / 1e-12)).epsilon(1e-14));
  CHECK(echo[1] == Approx(3.84e6 * 1e-7).epsilon(1e-14));
  CHECK(echo[2] == 310);
  CHECK(echo[3] == 1);
  CHECK(echo[8] == 1.25);
  CHECK(echo[9] == 1e-7);
  CHECK(model.interaction().cutoff(model.self()) == 1);
}

TEST_CASE("a model that cannot be made is refused with the plugin's own words") {
  const PluginFolder folder;
  folder.copy(TESTED_models, "libgood.so");
  const auto failure = [&](const char* id) {
    const Manifest manifest = manifest_in(folder, id);
    return thrown_by([&] { const ModelInstance model(manifest, {0, 1, 310, 0}, setting()); });
  };
  CHECK_THAT(failure("failing").what(), Contains("the depth is too deep"));
  CHECK_THAT(failure("silent").what(), Contains("gave no reason"));
  CHECK_THAT(failure("unterminated").what(), Contains("xxx"));
  CHECK_THAT(failure("endless").what(), Contains("cutoff inf"));
}

TEST_CASE("the SHA-256 of a file is the one of the standard") {
  const PluginFolder folder;
  // FIPS 180-2, appendix B.1, and the digest of no bytes at all.
  CHECK(rouleau::sha256(folder.write("abc", std::string("abc"))) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(rouleau::sha256(folder.write("empty", std::string())) ==
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(thrown_by([&] { rouleau::sha256(folder.path() / "absent"); }).cause() == Cause::input_output);
  CHECK(thrown_by([&] { rouleau::sha256(folder.path()); }).cause() == Cause::input_output);
}
