// How text is laid out for a terminal.
#include "base/text.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using rouleau::folded;
using rouleau::reflowed;

TEST_CASE("a line that is too long is broken at spaces, below its last column or a little further in") {
  CHECK(folded("one two three", 13) == "one two three");
  CHECK(folded("one two three", 12) == "one two\nthree");
  CHECK(folded("  run SCENE   simulate a scene\n", 24) == "  run SCENE   simulate a\n              scene\n");
  CHECK(folded("  name: because of this and that\n\nend", 20) == "  name: because of\n    this and that\n\nend");
  CHECK(folded("a \xc2\xb5m", 4) == "a \xc2\xb5m");  // characters count, not bytes
  CHECK(folded("", 40).empty());
}

TEST_CASE("no word is broken, however narrow the terminal, and none is lost") {
  const std::string text =
      "  /a/very/long/path/that/no/terminal/holds and   three  words\n  1.5         limit of a name  x\n";
  for (std::size_t width = 1; width < 90; ++width) {
    std::istringstream before(text), after(folded(text, width));
    std::string word, same;
    while (before >> word) {
      REQUIRE(after >> same);
      CHECK(same == word);
    }
    CHECK(!(after >> same));
    std::istringstream lines(folded(text, width));
    for (std::string line; std::getline(lines, line);)
      if (line.find(' ', line.find_first_not_of(' ')) != std::string::npos && width > 30) CHECK(line.size() <= width);
  }
}

TEST_CASE("paragraphs are laid out anew; what is indented stays as it is") {
  CHECK(reflowed("One two\nthree four.\n\nExample:\n  rouleau run\n  rouleau plan\nThe end\nof it\n", 80) ==
        "One two three four.\n\nExample:\n  rouleau run\n  rouleau plan\nThe end of it\n");
}
