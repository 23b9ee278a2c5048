// The text of this folder's schemas, which CMake compiles into the program (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::stability {

extern const std::string_view limits_schema_text;
extern const std::string_view limits_result_schema_text;

}  // namespace rouleau::stability
