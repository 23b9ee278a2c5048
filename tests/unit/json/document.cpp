#include <algorithm>
#include <catch2/catch.hpp>

#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "json/parser.hpp"
#include "scratch_folder.hpp"

using Catch::Matchers::Contains;
using rouleau::Cause;
using rouleau::Error;
using rouleau::json::Document;

namespace {

std::string message_of(const std::string& text) {
  try {
    (void)Document::parse(text, "a.json");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  return "";
}

std::string message_of_set(Document document, const std::string& assignment) {
  try {
    document.set(assignment);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  return "";
}

std::string place(const Document& document, const std::string& pointer) { return to_string(document.place(pointer)); }

}  // namespace

TEST_CASE("every value and every key has its line and column") {
  const auto document =
      Document::parse("{ \"a\": [1, -2.5e3,\n  {\"b\" : true, \"c\":null}, \"x\\\"]\"],\n\t\"d\": {} }", "a.json");
  CHECK(place(document, "") == "a.json:1:1");
  CHECK(place(document, "/a") == "a.json:1:8 /a");
  CHECK(place(document, "/a/0") == "a.json:1:9 /a/0");
  CHECK(place(document, "/a/1") == "a.json:1:12 /a/1");
  CHECK(place(document, "/a/2") == "a.json:2:3 /a/2");
  CHECK(place(document, "/a/2/b") == "a.json:2:10 /a/2/b");
  CHECK(place(document, "/a/2/c") == "a.json:2:20 /a/2/c");
  CHECK(place(document, "/a/3") == "a.json:2:27 /a/3");
  CHECK(place(document, "/d") == "a.json:3:7 /d");
  CHECK(to_string(document.key_place("/a/2/c")) == "a.json:2:16 /a/2/c");
  CHECK(to_string(document.key_place("/d")) == "a.json:3:2 /d");
}

TEST_CASE("an absent value has the place of what would hold it") {
  const auto document = Document::parse("{\n \"a\": {\"b\": [1]} }", "a.json");
  CHECK(place(document, "/a/x") == "a.json:2:7 /a/x");
  CHECK(place(document, "/a/b/7") == "a.json:2:13 /a/b/7");
  CHECK(place(document, "/x/y") == "a.json:1:1 /x/y");
}

TEST_CASE("keys with slashes, tildes, escapes and nothing in them have their pointers") {
  const auto document = Document::parse(R"({"a/b": 1, "~": 2, "\u0041": 3, "": 4})", "a.json");
  CHECK(document.place("/a~1b").column == 9);
  CHECK(document.place("/~0").column == 17);
  CHECK(document.place("/A").column == 30);
  CHECK(document.place("/").column == 37);
}

TEST_CASE("a byte order mark in front does not shift columns") {
  CHECK(place(Document::parse("\xEF\xBB\xBF{\"a\": 1}", "a.json"), "/a") == "a.json:1:7 /a");
}

TEST_CASE("values come through as written") {
  const auto document =
      Document::parse(R"({"i": 7, "n": -7, "f": 0.1, "t": true, "s": "µ\u00b5\n", "z": null, "l": [[], {}]})", "");
  CHECK(document.root() == nlohmann::json::parse(document.text()));
}

TEST_CASE("malformed text is refused with line, column, the parser's words and what mends the usual slips") {
  CHECK(
      message_of("{\"a\": 1,\n}") ==
      "a.json:2:1\n  this is not JSON: while parsing object key - unexpected '}'; expected string literal; remove the "
      "comma before this '}'");
  CHECK_THAT(message_of("{\"a\": [1, 2}"), Contains("a.json:1:12 /a\n  this is not JSON: while parsing array"));
  CHECK_THAT(message_of("{\"a\": tru}"), Contains("needs double quotes"));
  CHECK_THAT(message_of("{\"a\": 5 mm}"), Contains("a.json:1:9\n") && Contains("a quantity with its unit"));
  CHECK_THAT(message_of("{a: 5}"), Contains("a.json:1:2\n") && Contains("\"a\" needs double quotes"));
  CHECK_THAT(message_of("{\"a\": True}"), Contains("write true in lower case"));
  CHECK_THAT(message_of("{\"a\": 'b'}"), Contains("not in single ones"));
  CHECK_THAT(message_of("{} // x"), Contains("JSON has no comments"));
  CHECK_THAT(message_of("[1 2]"), Contains("a.json:1:4\n") && Contains("expected ']'; a ',' is missing before it"));
  CHECK_THAT(message_of("\"abc"), Contains("missing closing quote"));
  CHECK_THAT(message_of("["), Contains("before the '[' of line 1 is closed"));
  CHECK_THAT(message_of("{\"a\""), Contains("before the '{' of line 1 is closed"));
  CHECK_THAT(message_of("]"), Contains("unexpected ']'"));
  CHECK_THAT(message_of("{\"a\": \"\xC3(\"}"), Contains("ill-formed UTF-8 byte"));
  CHECK_THAT(message_of("{\"a\": \"\\ud800\"}"), Contains("surrogate"));
  CHECK_THAT(message_of("{\"a\": \"x\ny\"}"), Contains("control character U+000A (LF) must be escaped"));
  CHECK_THAT(message_of("[1] [2]"), Contains("expected end of input"));
  CHECK_THAT(message_of("\x80"), Contains("invalid literal"));
}

TEST_CASE("no truncation of a document and no changed byte of it ends otherwise than in an error or a value") {
  const std::string text =
      R"({"a": [1, -2.5e3, {"b": true, "c": null}], "d": "x\u00e4\"\n", "e": {"f": 1e-9}, "g": false})";
  for (std::size_t length = 0; length < text.size(); ++length) CHECK_FALSE(message_of(text.substr(0, length)).empty());
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      auto changed = text;
      changed[at] = static_cast<char>(byte);
      const auto message = message_of(changed);
      if (message.find("parse_error") != std::string::npos ||
          (message.empty() != nlohmann::json::accept(changed) && byte != 0)) {
        // The only texts that nlohmann-json takes and we do not have a key twice.
        CHECK_THAT(message, Contains("stands twice"));
      }
    }
  }
}

TEST_CASE("a key that stands twice is refused with both lines") {
  CHECK(message_of("{\"a\": {\"b\": 1,\n \"c\": [2],\n\"b\": 3}}") ==
        "a.json:3:1 /a/b\n  the key \"b\" stands twice in the same object, first on line 1; keep one of them");
  CHECK(message_of(R"({"a": {"b": 1}, "c": {"b": 1}})").empty());
}

TEST_CASE("numbers that no double holds are refused") {
  CHECK_THAT(message_of("[1e309]"), Contains("too large"));
  CHECK_THAT(message_of("[-1e309]"), Contains("too large"));
  CHECK_THAT(message_of("[" + std::string(400, '9') + "]"), Contains("too large"));
  for (const char* word : {"NaN", "nan", "Infinity", "-Infinity", "inf"}) {
    CHECK_THAT(message_of(std::string("[") + word + "]"), Contains("write a finite number"));
  }
}

TEST_CASE("nesting, length and size have limits") {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK(message_of(nested(rouleau::json::deepest_nesting)).empty());
  CHECK_THAT(message_of(nested(rouleau::json::deepest_nesting + 1)), Contains("more than 200 deep"));
  CHECK_THAT(message_of(std::string(1'000'000, '[')), Contains("more than 200 deep"));
  CHECK(message_of("\"" + std::string(rouleau::json::longest_string, 'x') + "\"").empty());
  CHECK_THAT(message_of("\"" + std::string(rouleau::json::longest_string + 1, 'x') + "\""), Contains("at most 8192"));
  CHECK_THAT(message_of("[" + std::string(rouleau::json::largest_text, ' ') + "]"), Contains("more than 16 MiB"));
}

TEST_CASE("what follows a NUL byte is not overlooked") {
  CHECK_THAT(message_of(std::string("{}\0{", 4)), Contains("NUL byte"));
}

TEST_CASE("a file that cannot be read is trouble of input and output, and says why") {
  const rouleau::test::ScratchFolder folder;
  const auto cause_of = [](const std::filesystem::path& path, const std::string& reason) -> std::optional<Cause> {
    try {
      (void)Document::read(path);
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Contains(path.string() + "\n  this file cannot be read: " + reason));
      return error.cause();
    }
    return std::nullopt;
  };
  CHECK(cause_of(folder.path() / "absent.json", "No such file") == Cause::input_output);
  CHECK(cause_of(folder.path(), "it is a directory") == Cause::input_output);
  CHECK(cause_of("/dev/zero", "it is a device") == Cause::input_output);
  const auto large = folder.write("large.json", std::string(rouleau::json::largest_text + 1, ' '));
  CHECK_THROWS_WITH(Document::read(large), Contains("more than 16 MiB"));
  CHECK_THROWS_WITH(Document::read(folder.write("empty.json", "")), Contains("the file is empty"));
  CHECK(Document::read(folder.write("good.json", "{\"a\": 1}")).root()["a"] == 1);
}

TEST_CASE("the cause of a malformed text is the caller's") {
  try {
    (void)Document::parse("{", "m.json", Cause::plugin_refused);
    FAIL("it was accepted");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::plugin_refused);
  }
}

TEST_CASE("set takes any JSON value, and a bare word as text") {
  auto document = Document::parse(R"({"a": {"b": 1}, "l": [1, 2]})", "a.json");
  document.set("/a/b=2.5");
  document.set("/a/c=6 Pa");
  document.set("/a/d={\"e\": [1, true]}");
  document.set("/a/f=\"quoted\"");
  document.set("/new/deep/er=null");
  document.set("/l/0=x=y");
  document.set("/l/-=3");
  document.set("/l/-/k=4");
  CHECK(document.root() == nlohmann::json::parse(R"({"a": {"b": 2.5, "c": "6 Pa", "d": {"e": [1, true]}, "f": "quoted"},
                                                    "l": ["x=y", 2, 3, {"k": 4}], "new": {"deep": {"er": null}}})"));
}

TEST_CASE("a value that set made has the option as its place, and others keep theirs") {
  auto document = Document::parse("{\"a\": {\"b\": 1,\n\"c\": 2}}", "a.json");
  document.set("/a/b={\"x\": 1}");
  CHECK(place(document, "/a/b") == "--set /a/b");
  CHECK(place(document, "/a/b/x") == "--set /a/b/x");
  CHECK(place(document, "/a/c") == "a.json:2:6 /a/c");
  CHECK(place(document, "/a") == "a.json:1:7 /a");
  CHECK_FALSE(document.overridden("/a/bb"));
}

TEST_CASE("a pointer that set cannot follow is refused with the option and a remedy") {
  const auto document = Document::parse(R"({"a": {"b": 1}, "l": [1, 2], "none": []})", "a.json");
  CHECK(message_of_set(document, "/l/2=1") ==
        "--set /l/2=1\n  /l is a list of 2; \"2\" is no place in it: write 0 to 1, or - to append");
  CHECK_THAT(message_of_set(document, "/none/0=1"), Contains("write - to append"));
  CHECK_THAT(message_of_set(document, "/l/first=1"), Contains("\"first\" is no place in it"));
  CHECK_THAT(message_of_set(document, "/l/00=1"), Contains("no place in it"));
  CHECK_THAT(message_of_set(document, "/a/b/c=1"), Contains("/a/b is 1, which has nothing inside"));
  CHECK_THAT(message_of_set(Document::parse("{\"a\\u001b\": 1}", "a.json"), "/a\x1b/c=1"),
             Contains("/a\\u001b is 1, which has nothing inside"));
  CHECK_THAT(message_of_set(document, "a/b=1"), Contains("write --set /a/b=1"));
  CHECK_THAT(message_of_set(document, "/a/b"), Contains("there is no '='"));
  CHECK_THAT(message_of_set(document, "=1"), Contains("the pointer is empty"));
  CHECK_THAT(message_of_set(document, "/a~2b=1"), Contains("written ~0"));
  CHECK_THAT(message_of_set(document, "/a/b="), Contains("no value follows"));
  CHECK_THAT(message_of_set(document, "/a/b={\"x\": }"), Contains("not valid JSON, at its character 7"));
  CHECK_THAT(message_of_set(document, "/a/b={\"x\": 1, \"x\": 2}"), Contains("stands twice"));
}

TEST_CASE("no message holds a control character, whatever stands in the text, the pointer or the name of the file") {
  using rouleau::Place;
  const auto plain = [](const std::string& words) {
    return std::none_of(words.begin(), words.end(),
                        [](char c) { return (c >= 0 && c < 0x20 && c != '\n') || c == 0x7f; });
  };
  for (const std::string character : {"\x01", "\x1b[2J", "\x7f", "\r"}) {
    CAPTURE(character);
    for (const std::string& text : {character, "{\"a\": " + character, '"' + character, "{\"" + character}) {
      CHECK(plain(message_of(text)));
    }
    CHECK(plain(to_string(Place{"folder/" + character, "/a" + character, 1, 1})));
    CHECK(plain(rouleau::json::subject("/a/b" + character)));
    auto document = Document::parse(R"({"a": 1})", "a.json");
    for (const std::string& assignment : {character, "/a" + character, "/a={" + character, "/a/" + character + "=1"}) {
      try {
        document.set(assignment);
      } catch (const Error& error) {
        CHECK(plain(error.what()));
      }
    }
  }
}

TEST_CASE("set takes UTF-8 only, in pointer and value: what is set is written into files of JSON") {
  auto document = Document::parse(R"({"a": 1, "b": []})", "a.json");
  for (const std::string assignment :
       {"/a=w\xffrd", "/a=\"\xc3\"", "/\xfe=1", "/a=\xc0\xaf", "/a=\xed\xa0\x80", "/b/-=M\xfcller"}) {
    CAPTURE(assignment);
    CHECK_THAT(message_of_set(document, assignment), Contains("is no UTF-8"));
  }
  document.set("/a=M\xc3\xbcller");
  CHECK(document.root()["a"] == "M\xc3\xbcller");
}
