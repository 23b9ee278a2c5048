// Errors as values: place, problem and remedy, and the message made of them.
#include "base/error.hpp"
#include "base/text.hpp"

#include <catch2/catch.hpp>

using namespace rouleau;

TEST_CASE("a place leaves out what is unknown") {
  CHECK(to_string({"a.json", "/b/0", 3, 14}) == "a.json:3:14 /b/0");
  CHECK(to_string({"a.json", "", 3}) == "a.json:3");
  CHECK(to_string({"", "/b"}) == "/b");
  CHECK(to_string({}).empty());
}

TEST_CASE("an error's message is its place, its problem and its remedy") {
  const Error whole(Cause::bad_input, {"a.json", "/b"}, "is too large", {"write less", {Way::elsewhere}});
  CHECK(whole.what() == std::string("a.json /b\n  is too large\n  write less"));
  CHECK(whole.words() == "is too large\n  write less");
  CHECK(whole.problem() == "is too large");
  CHECK(whole.remedy().words == "write less");
  CHECK(whole.remedy().ways == std::vector{Way::elsewhere});
  CHECK(whole.place().pointer == "/b");
  CHECK(whole.cause() == Cause::bad_input);
  CHECK(Error(Cause::bad_input, "no place").what() == std::string("no place"));
}

TEST_CASE("control characters that a file holds are escaped wherever they stand, but for the ends of lines") {
  const Error error(Cause::bad_input, {"a\n.json", "/\x1b"}, "found\x1b\nline two", {"write\tless"});
  CHECK(error.what() == std::string("a\\u000a.json /\\u001b\n  found\\u001b\nline two\n  write\\u0009less"));
}

TEST_CASE("no character that steers a terminal is printed as it is, and every other one is") {
  CHECK(printable("\x1b[31m \x7f") == "\\u001b[31m \\u007f");
  CHECK(printable("\xc2\x9b"
                  "31m") == "\\u009b31m");  // the control sequence introducer of Latin-1
  CHECK(printable("a\xe2\x80\xae"
                  "b \xe2\x81\xa6 \xd8\x9c") == "a\\u202eb \\u2066 \\u061c");  // directions of writing
  CHECK(printable("\x9b alone") == "\\u009b alone");
  for (const char* text :
       {"\xc2\xb5m \xc2\xb0 \xc3\xa9", "\xe2\x80\x93 \xe4\xb8\xad", "\xf0\x9f\xa9\xb8", "\xff\xc3", ""}) {
    CHECK(printable(text) == text);
  }
  CHECK(printable_lines("a\n\tb\n") == "a\n\\u0009b\n");
}
