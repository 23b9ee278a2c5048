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

TEST_CASE("the fault that comes first in the text is the one that is told") {
  const auto schema = Json::parse(R"({"type": "object", "additionalProperties": false, "required": ["b"],
      "properties": {"a": {"type": "number"}, "b": {"type": "number"}, "z": {"type": "number"}}})");
  CHECK_THAT(message_of(R"({"z": "1", "a": "2", "b": 1})", schema), Contains("a.json:1:7 /z"));
  CHECK_THAT(message_of(R"({"bb": 1})", schema), Contains("unknown key \"bb\"; did you mean \"b\"?"));
  CHECK_THAT(message_of(R"({"a": 1})", schema), Contains("\"b\" is missing"));
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
  const auto schema = Json::parse(
      R"({"type": "object", "additionalProperties": false, "patternProperties": {"^x-": {}}, "properties": {"a": {}}})");
  CHECK(message_of(R"({"x-mine": [1], "a": 2})", schema).empty());
  CHECK_THAT(message_of(R"({"y-mine": [1]})", schema), Contains("unknown key \"y-mine\""));
}

TEST_CASE("a value that fits two branches of a oneOf is refused") {
  const auto schema = Json::parse(R"({"properties": {"a": {"oneOf": [{"type": "number"}, {"type": "integer"}]}}})");
  CHECK(message_of(R"({"a": 1.5})", schema).empty());
  CHECK_THAT(message_of(R"({"a": 1})", schema), Contains("a.json:1:7 /a\n  a can be read in 2 ways"));
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
  const auto schema = Json::parse(
      R"({"properties": {"a": {"type": "string", "pattern": "^[a-z][a-z0-9]*(-[a-z0-9]+)*(\\.[a-z0-9]+(-[a-z0-9]+)*)*$"}}})");
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
