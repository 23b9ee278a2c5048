// Faults that are found together are said together: in the order of the text, some twenty of them, and how many more.
#include "base/error.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "base/synonyms.hpp"
#include "base/text.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

Error at(int line, int column, const std::string& problem, Cause cause = Cause::bad_input) {
  return {cause, {line > 0 ? "a.json" : "--set", "/p", line, column}, problem};
}

std::string message_of(const Faults& faults) {
  try {
    faults.raise();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("faults are said in the order of the text, those of --set last, and the first decides the cause") {
  Faults faults;
  CHECK(message_of(faults).empty());
  faults.add(at(0, 0, "set"));
  faults.add(at(3, 9, "later"));
  faults.add(at(3, 2, "middle"));
  faults.add(at(1, 5, "first", Cause::plugin_refused));
  CHECK(message_of(faults) ==
        "a.json:1:5 /p\n  first\na.json:3:2 /p\n  middle\na.json:3:9 /p\n  later\n--set /p\n  set");
  try {
    faults.raise();
  } catch (const SeveralFaults& several) {
    CHECK(several.cause() == Cause::plugin_refused);
    CHECK(several.problem() == "first");
    CHECK(several.faults().size() == 4);
  }
}

TEST_CASE("one fault is thrown as it is") {
  Faults faults;
  faults.attempt([] { throw Error(Cause::bad_input, Place{"a.json", "/p", 1, 2}, "wrong", {"mend it"}); });
  CHECK(faults.size() == 1);
  CHECK_THROWS_WITH(faults.raise(), "a.json:1:2 /p\n  wrong\n  mend it");
  try {
    faults.raise();
  } catch (const SeveralFaults&) {
    FAIL("one fault is not several");
  } catch (const Error&) {
  }
}

TEST_CASE("faults that were collected elsewhere are taken one by one") {
  Faults inner, outer;
  inner.add(at(2, 1, "second"));
  inner.add(at(4, 1, "fourth"));
  outer.add(at(3, 1, "third"));
  outer.attempt([&] { inner.raise(); });
  CHECK(outer.size() == 3);
  CHECK(message_of(outer) == "a.json:2:1 /p\n  second\na.json:3:1 /p\n  third\na.json:4:1 /p\n  fourth");
}

TEST_CASE("twenty faults are said, and how many more there are") {
  Faults faults;
  for (int line = 1; line <= 20; ++line) faults.add(at(line, 1, "wrong"));
  CHECK_THAT(message_of(faults), Contains("a.json:20:1") && !Contains("more"));
  faults.add(at(21, 1, "wrong"));
  CHECK_THAT(message_of(faults), !Contains("a.json:21:1") && Catch::Matchers::EndsWith("\nand 1 fault more"));
  faults.add(at(22, 1, "wrong"));
  CHECK_THAT(message_of(faults), Catch::Matchers::EndsWith("\nand 2 faults more"));
}

TEST_CASE("collecting ends where nobody reads on, however many collect along the way") {
  Faults faults;
  int tried = 0;
  const auto read = [&] {
    for (int i = 0; i < 100'000; ++i) {
      faults.attempt([&] {
        ++tried;
        throw at(i + 1, 1, "wrong");
      });
    }
  };
  CHECK_THROWS_AS(faults.attempt([&] { faults.attempt(read); }), SeveralFaults);
  CHECK(tried == 200);
  CHECK(faults.size() == 200);
  CHECK_THAT(message_of(faults), Catch::Matchers::EndsWith("\nand 180 faults more"));
}

TEST_CASE("each of several faults can be put another way") {
  Faults faults;
  faults.add(at(1, 1, "one"));
  faults.add(at(2, 1, "two"));
  const auto elsewhere = [](const Error& fault) {
    return Error(fault.cause(), Place{"b.json"}, "in a: " + fault.problem());
  };
  try {
    faults.raise();
  } catch (const Error& error) {
    CHECK_THROWS_WITH(throw_as(error, elsewhere), "b.json\n  in a: one\nb.json\n  in a: two");
  }
  CHECK_THROWS_WITH(throw_as(at(1, 1, "one"), elsewhere), "b.json\n  in a: one");
}

TEST_CASE("a common word for ours is found before the nearest in spelling, if ours may stand there") {
  CHECK(synonym("pressure_drop", {"strain", "pressure_gradient"}) == "pressure_gradient");
  CHECK(synonym("Omega", {"tau"}) == "tau");
  CHECK(synonym("pressure_drop", {"strain"}).empty());
  CHECK(synonym("tau", {"tau"}).empty());
  CHECK(likely("sphere", {"biconcave", "circle"}) == "circle");
  CHECK(likely("circel", {"biconcave", "circle"}) == "circle");
  CHECK(did_you_mean("acceleration", {"gravity", "density"}) == "; did you mean \"gravity\"?");
}
