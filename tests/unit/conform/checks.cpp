// The list of checks: what a check builds on exists, stands before it, and is not for other models.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

#include "conform/check.hpp"

namespace {

using namespace rouleau::host;

}  // namespace

TEST_CASE("checks have names of their own and stand behind those that they build on") {
  std::set<std::string> before;
  for (const Check& check : all_checks()) {
    CAPTURE(check.name);
    for (const char* name : check.after) {
      CAPTURE(name);
      CHECK(before.contains(name));
      const Check* earlier = find_check(name);
      REQUIRE(earlier != nullptr);
      CHECK((!earlier->kind || !check.kind || earlier->kind == check.kind));
    }
    CHECK((check.after.empty() == (std::string(check.name) == "manifest")));
    CHECK(before.insert(check.name).second);
    CHECK(check.run != nullptr);
    CHECK(*check.says != '\0');
  }
}

TEST_CASE("a number passes up to its limit, and what is no number fails") {
  CHECK(Finding::at_most(1, 1, "x").verdict == Verdict::pass);
  CHECK(Finding::at_most(1.1, 1, "x").verdict == Verdict::fail);
  CHECK(Finding::at_most(std::nan(""), 1, "x").verdict == Verdict::fail);
}
