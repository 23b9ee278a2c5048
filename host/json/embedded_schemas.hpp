// The text of the shipped schemas; CMake writes the definitions from the schema files (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::json {

extern const std::string_view scene_schema_text;
extern const std::string_view manifest_schema_text;
extern const std::string_view lock_schema_text;

}  // namespace rouleau::json
