// The text of the schemas of a manifest (sdk/schema), of a lock and of a collection's index, which CMake compiles into
// the program (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::plugin {

extern const std::string_view manifest_schema_text;
extern const std::string_view lock_schema_text;
extern const std::string_view collection_schema_text;

}  // namespace rouleau::plugin
