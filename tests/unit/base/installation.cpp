// Where an installation lies, from the place of its programs.
#include "base/installation.hpp"

#include <catch2/catch.hpp>

namespace rouleau {

TEST_CASE("the installation of a program is the folder above its own, whatever it is called by and where from") {
  REQUIRE(installation().folder.is_absolute());
  CHECK(std::filesystem::equivalent(installation().folder / "bin/unit_base", "/proc/self/exe"));
  CHECK(installation().data.parent_path() == installation().folder);
  CHECK(std::filesystem::exists(installation().programs / "conform-check"));
  CHECK(std::filesystem::exists(installation().libraries.front() / "rouleau/plugins"));
}

}  // namespace rouleau
