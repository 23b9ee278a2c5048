// The list of checks: what a check builds on exists, stands before it, and is not for other models.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "conform/check.hpp"

namespace {

using namespace rouleau::conform;

}  // namespace

TEST_CASE("a model meets each check's name once, and behind the checks that it builds on") {
  std::vector<Check> before;
  const auto meets = [&](const std::string& name, const Check& check) {
    return std::any_of(before.begin(), before.end(), [&](const Check& earlier) {
      return earlier.name == name && (!earlier.kind || !check.kind || earlier.kind == check.kind);
    });
  };
  for (const Check& check : all_checks()) {
    CAPTURE(check.name);
    for (const char* name : check.after) {
      CAPTURE(name);
      CHECK(meets(name, check));
    }
    CHECK((check.after.empty() == (std::string(check.name) == "manifest")));
    CHECK_FALSE(meets(check.name, check));
    CHECK(check.run != nullptr);
    CHECK(*check.says != '\0');
    before.push_back(check);
  }
}

TEST_CASE("a number passes up to its limit, and what is no number fails") {
  CHECK(Finding::at_most(1, 1, "x").verdict == Verdict::pass);
  CHECK(Finding::at_most(1.1, 1, "x").verdict == Verdict::fail);
  CHECK(Finding::at_most(std::nan(""), 1, "x").verdict == Verdict::fail);
}

TEST_CASE("of two dimensions the worse finding is kept: what fails before what crashes, warns, passes and is skipped") {
  const std::vector<Verdict> falling = {Verdict::fail, Verdict::crash, Verdict::timeout,
                                        Verdict::warn, Verdict::pass,  Verdict::skip};
  for (std::size_t i = 0; i < falling.size(); ++i) {
    for (std::size_t k = 0; k < falling.size(); ++k) {
      CHECK(worse({falling[i], "", {}, {}}, {falling[k], "", {}, {}}) == (i < k));
    }
  }
  CHECK(worse(Finding::at_most(2, 10, ""), Finding::at_most(1, 10, "")));
  CHECK_FALSE(worse(Finding::at_most(1, 10, ""), Finding::at_most(2, 10, "")));
}
