// Errors at the end of the program: exit codes, and remedies in the options of the command line.
#include "command/process/program.hpp"
#include "json/json.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "command/manage_plugins.hpp"

using namespace rouleau;
using namespace rouleau::command;

namespace {

/// Exit code, and what is said on standard error.
std::pair<int, std::string> end_of(const std::function<int()>& body) {
  const std::ostringstream said;
  std::streambuf* const terminal = std::cerr.rdbuf(said.rdbuf());
  const int code = run_program(body, " for this");
  std::cerr.rdbuf(terminal);
  return {code, said.str()};
}

}  // namespace

TEST_CASE("each cause has its exit code") {
  CHECK(exit_code_of(Cause::bad_input) == 2);
  CHECK(exit_code_of(Cause::plugin_refused) == 3);
  CHECK(exit_code_of(Cause::input_output) == 4);
}

TEST_CASE("the ways of a remedy are named by the options that take them, in their order, where the command has them") {
  know_options({"dir"});
  CHECK(in_options({"choose another directory, or replace it", {Way::elsewhere, Way::anew}}) ==
        "choose another directory, or replace it (--dir)");
  know_options({});
  CHECK(in_options({"choose another directory", {Way::elsewhere}}) == "choose another directory");
  know_options({"out", "overwrite", "resume", "force"});
  CHECK(in_options({"check the path"}) == "check the path");
  CHECK(in_options({"choose another directory", {Way::elsewhere}}) == "choose another directory (--out)");
  CHECK(in_options({"go on, begin anew, or accept it", {Way::resume, Way::anew, Way::accept}}) ==
        "go on, begin anew, or accept it (--resume, --overwrite, --force)");
}

TEST_CASE("an error ends the program with its code and its message in options") {
  const auto refused = end_of([]() -> int {
    throw Error(Cause::plugin_refused, Place{"runs/a", "/b", 3, 4}, "holds\ta run", {"replace it", {Way::anew}});
  });
  CHECK(refused.first == 3);
  CHECK(refused.second == "runs/a:3:4 /b\n  holds\\u0009a run\n  replace it (--overwrite)\n");
  CHECK(end_of([] { return 1; }) == std::pair(1, std::string()));
}

TEST_CASE("with ROULEAU_ERRORS=json each fault is an object in one line, with its place and its remedy in options") {
  ::setenv("ROULEAU_ERRORS", "json", 1);
  const auto two = end_of([]() -> int {
    Faults faults;
    faults.add({Cause::bad_input, Place{"a.json", "/b", 3, 4}, "holds \"\u00b5\"", {"replace it", {Way::anew}}});
    faults.add({Cause::bad_input, "is no scene"});
    faults.raise();
    return 0;
  });
  ::unsetenv("ROULEAU_ERRORS");
  CHECK(two.first == 2);
  CHECK(two.second.find('\n') == two.second.size() - 1);
  const nlohmann::json expected = {
      {"exit_code", 2},
      {"faults",
       {{{"file", "a.json"},
         {"pointer", "/b"},
         {"line", 3},
         {"column", 4},
         {"problem", "holds \"\u00b5\""},
         {"remedy", "replace it (--overwrite)"}},
        {{"file", ""}, {"pointer", ""}, {"line", 0}, {"column", 0}, {"problem", "is no scene"}, {"remedy", ""}}}}};
  CHECK(nlohmann::json::parse(two.second) == expected);
}

TEST_CASE("what is no Error ends the program with code 4 and words") {
  CHECK(end_of([]() -> int { throw std::bad_alloc(); }) ==
        std::pair(4, std::string("rouleau: there is not enough memory for this\n")));
  CHECK(end_of([]() -> int { throw std::logic_error("never"); }) ==
        std::pair(4, std::string("rouleau: internal error, please report it: never\n")));
}

TEST_CASE(
    "the renewal of a lock names the file when it does not lie beside the scene, in quotes where a shell needs them") {
  using Catch::Matchers::EndsWith;
  CHECK_THAT(lock_renewal("s.lock.json", "s.json"), EndsWith("rouleau plugins --lock s.json"));
  CHECK_THAT(lock_renewal("team.json", "s.json"), EndsWith("rouleau plugins --lock s.json --out team.json"));
  CHECK_THAT(lock_renewal("my s.lock.json", "my s.json"), EndsWith("rouleau plugins --lock 'my s.json'"));
}
