#include <catch2/catch.hpp>

#include "base/text.hpp"
#include "json/schema.hpp"

using Catch::Matchers::Contains;
using Json = nlohmann::json;
using rouleau::Cause;
using rouleau::Error;
using rouleau::json::Document;

namespace {

std::string message_of(const std::string& text, const Json& schema) {
  try {
    validate(Document::parse(text, "a.json"), schema, Cause::plugin_refused);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::plugin_refused);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the fault that comes first in the text is told first") {
  const auto schema = Json::parse(R"({"type": "object", "additionalProperties": false, "required": ["b"],
      "properties": {"a": {"type": "number"}, "b": {"type": "number"}, "z": {"type": "number"}}})");
  CHECK_THAT(message_of(R"({"z": "1", "a": "2", "b": 1})", schema), Contains("a.json:1:7 /z"));
  CHECK_THAT(message_of(R"({"bb": 1})", schema), Contains("unknown key \"bb\"; did you mean \"b\"?"));
  CHECK_THAT(message_of(R"({"a": 1})", schema), Contains("\"b\" is missing"));
}

TEST_CASE("all faults are told at once, in the order of the text") {
  const auto schema = Json::parse(R"({"type": "object", "additionalProperties": false, "required": ["a", "b"],
      "properties": {"a": {"type": "number", "minimum": 2}, "b": {"items": {"enum": ["x", "y"]}},
                     "c": {"type": "object", "additionalProperties": false, "properties": {"d": {}}}}})");
  CHECK(message_of("{\"a\": 1,\n\"b\": [\"x\", \"z\", 3],\n\"c\": {\"e\": 1, \"f\": 2}}", schema) ==
        "a.json:1:7 /a\n  1 is out of range; a must be at least 2\n"
        "a.json:2:12 /b/1\n  found the text \"z\"\n  b[1] can be: \"x\", \"y\"\n"
        "a.json:2:17 /b/2\n  found the number 3\n  b[2] can be: \"x\", \"y\"\n"
        "a.json:3:7 /c/e\n  unknown key \"e\"\n  allowed here: d\n"
        "a.json:3:15 /c/f\n  unknown key \"f\"\n  allowed here: d");
}

TEST_CASE("what follows from a fault is not told") {
  const auto schema = Json::parse(R"({"type": "object", "additionalProperties": false, "required": ["density", "size"],
      "properties": {"density": {"type": "number"},
                     "size": {"type": "array", "minItems": 2, "items": {"type": "number"}},
                     "shape": {"oneOf": [{"type": "object", "required": ["r"], "additionalProperties": false,
                                          "properties": {"r": {"type": "number"}, "s": {}}},
                                         {"type": "object", "required": ["q"], "additionalProperties": false,
                                          "properties": {"q": {}}}]}}})");
  // A key that is misspelt, or goes by another name, is not missing as well.
  CHECK(message_of(R"({"densty": 1, "length": [1, 2]})", schema) ==
        "a.json:1:2 /densty\n  unknown key \"densty\"; did you mean \"density\"?\n"
        "  allowed here: density, shape, size\n"
        "a.json:1:15 /length\n  unknown key \"length\"; did you mean \"size\"?\n"
        "  allowed here: density, shape, size");
  // One that nothing was meant to be is.
  CHECK(message_of(R"({"zzz": 1, "size": [1, 2]})", schema) ==
        "a.json:1:1\n  \"density\" is missing\n"
        "a.json:1:2 /zzz\n  unknown key \"zzz\"\n  allowed here: density, shape, size");
  // Of a list that is too short no element is judged, of a value of the wrong kind no part.
  CHECK(message_of(R"({"density": {"x": 1}, "size": ["a"]})", schema) ==
        "a.json:1:13 /density\n  found an object; density wants a number\n"
        "a.json:1:31 /size\n  found 1 value; size wants at least 2");
  // In a choice only the branch that is meant is judged, and there every part.
  CHECK(message_of(R"({"density": 1, "size": [1, 2], "shape": {"r": "1", "t": 2}})", schema) ==
        "a.json:1:47 /shape/r\n  found the text \"1\"; r wants a number; write 1 without quotes\n"
        "a.json:1:52 /shape/t\n  unknown key \"t\"\n  allowed here: r, s");
}

TEST_CASE("a document with faults beyond number is refused at once") {
  const auto schema = Json::parse(R"({"items": {"oneOf": [{"type": "number"}, {"const": "x"}]}})");
  std::string text = "[true";
  for (int i = 1; i < 100'000; ++i) text += ",true";
  const std::string message = message_of(text + "]", schema);
  CHECK_THAT(message, Catch::Matchers::StartsWith("a.json:1:2 /0\n"));
  CHECK_THAT(message, Catch::Matchers::EndsWith("\nand at least 180 faults more"));
}

TEST_CASE("messages name what was found and what is allowed") {
  const auto number = Json::parse(
      R"({"properties": {"a": {"type": "integer", "minimum": 2, "exclusiveMaximum": 9, "description": "Teeth."}}})");
  CHECK(message_of(R"({"a": 1})", number) ==
        "a.json:1:7 /a\n  1 is out of range; a must be at least 2 and below 9\n  a: Teeth.");
  CHECK_THAT(message_of(R"({"a": 9})", number), Contains("9 is out of range"));
  CHECK_THAT(message_of(R"({"a": 2.5})", number), Contains("found the number 2.5; a wants a whole number"));
  CHECK_THAT(message_of(R"({"a": 3.0})", number), Contains("write 3"));
  CHECK_THAT(message_of(R"({"a": "3"})", number), Contains("write 3 without quotes"));
  const auto text = Json::parse(
      R"({"properties": {"a": {"type": "string", "minLength": 1, "maxLength": 3, "pattern": "^[a-z]*$"}}})");
  CHECK_THAT(message_of(R"({"a": ""})", text), Contains("an empty text is too short for a"));
  CHECK_THAT(message_of(R"({"a": "abcd"})", text), Contains("has 4 characters; a may have 3"));
  CHECK_THAT(message_of(R"({"a": "A"})", text), Contains("\"A\" cannot be used for a"));
}

TEST_CASE("keys made for authors by a pattern are allowed") {
  const auto schema = Json::parse(R"({"type": "object", "additionalProperties": false, )"
                                  R"("patternProperties": {"^x-": {}}, "properties": {"a": {}}})");
  CHECK(message_of(R"({"x-mine": [1], "a": 2})", schema).empty());
  CHECK_THAT(message_of(R"({"y-mine": [1]})", schema), Contains("unknown key \"y-mine\""));
}

TEST_CASE("a value that fits two branches of a oneOf is refused") {
  const auto schema = Json::parse(R"({"properties": {"a": {"oneOf": [{"type": "number"}, {"type": "integer"}]}}})");
  CHECK(message_of(R"({"a": 1.5})", schema).empty());
  CHECK_THAT(message_of(R"({"a": 1})", schema), Contains("a.json:1:7 /a\n  a can be read in 2 ways"));
}

TEST_CASE("the branch of a oneOf is meant that has the fixed word of the value") {
  const auto schema = Json::parse(R"({"oneOf": [
      {"type": "object", "required": ["kind", "at"], "additionalProperties": false,
       "properties": {"kind": {"const": "gap"}, "at": {"type": "number"}}},
      {"type": "object", "required": ["kind"], "additionalProperties": false,
       "properties": {"kind": {"const": "turn"}, "at": {}, "times": {}}}]})");
  CHECK(message_of(R"({"kind": "turn", "at": true})", schema).empty());
  CHECK(message_of(R"({"kind": "gap", "at": true})", schema) == "a.json:1:23 /at\n  found true; at wants a number");
  CHECK(message_of(R"({"kind": "gap", "times": 2, "at": 1})", schema) ==
        "a.json:1:17 /times\n  \"times\" cannot stand here together with the other keys\n"
        "  allowed beside them: at, kind");
}

TEST_CASE("an object with more keys than it may have is refused") {
  const auto schema = Json::parse(R"({"properties": {"a": {"maxProperties": 1}}})");
  CHECK(message_of(R"({"a": {"b": 1}})", schema).empty());
  CHECK_THAT(message_of(R"({"a": {"b": 1, "c": 2}})", schema),
             Contains("a.json:1:7 /a\n  found 2 keys; a may have at most 1"));
}

TEST_CASE("a fault in a value that set made names the option") {
  auto document = Document::parse(R"({"a": {"b": 1}})", "a.json");
  document.set("/a/c=2");
  const auto schema = Json::parse(
      R"({"properties": {"a": {"type": "object", "additionalProperties": false, "properties": {"b": {}}}}})");
  CHECK_THROWS_WITH(validate(document, schema), "--set /a/c\n  unknown key \"c\"\n  allowed here: b");
}

TEST_CASE("a hostile text meets the pattern of a schema without harm") {
  const auto schema = Json::parse(R"({"properties": {"a": {"type": "string", )"
                                  R"("pattern": "^[a-z][a-z0-9]*(-[a-z0-9]+)*(\\.[a-z0-9]+(-[a-z0-9]+)*)*$"}}})");
  CHECK(message_of("{\"a\": \"" + std::string(1000, 'a') + "\"}", schema).empty());
  CHECK_THAT(message_of("{\"a\": \"" + std::string(8192, 'a') + "\"}", schema), Contains("is too long for a"));
  CHECK_FALSE(message_of("{\"a\": \"" + std::string(900, 'a') + "!\"}", schema).empty());
}

TEST_CASE("a key that stands elsewhere is told where") {
  const auto schema = Json::parse(R"({
    "type": "object", "additionalProperties": false,
    "properties": {
      "fluid": {"type": "object", "additionalProperties": false, "properties": {"density": {}}},
      "stages": {"items": {"$ref": "#/definitions/stage"}},
      "types": {"additionalProperties": {"oneOf": [{"properties": {"pressure_gradient_of_type": {}}}]}}
    },
    "definitions": {"stage": {"properties": {"pressure_gradient": {}, "again": {"$ref": "#/definitions/stage"}}}}
  })");
  CHECK_THAT(message_of(R"({"fluid": {"presure_gradient_of_type": 1}})", schema),
             Contains("did you mean /types/NAME/pressure_gradient_of_type?"));
  CHECK_THAT(message_of(R"({"fluid": {"stages": 1}})", schema), Contains("did you mean /stages?"));
  CHECK_THAT(message_of(R"({"fluid": {"densty": 1}})", schema), Contains("did you mean \"density\"?"));
  CHECK_THAT(message_of(R"({"fluid": {"rate": 1}})", schema), !Contains("did you mean"));
}

TEST_CASE("the nearest word is the one a user meant") {
  using rouleau::nearest;
  CHECK(nearest("tao", {"coupling", "tau", "kernel"}) == "tau");
  CHECK(nearest("viscosty", {"velocity", "viscosity"}) == "viscosity");
  CHECK(nearest("raduis", {"radius"}) == "radius");
  CHECK(nearest("Morse", {"morse"}) == "morse");
  CHECK(nearest("params", {"model", "parameters"}) == "parameters");
  CHECK(nearest("gravity", {"tau", "kernel"}).empty());
  CHECK(nearest("x", {"y"}).empty());
  CHECK(nearest("", {"y"}).empty());
  CHECK(nearest(std::string(100000, 'a'), {"aaaa"}).empty());
}
