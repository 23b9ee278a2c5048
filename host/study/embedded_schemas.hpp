// The text of this folder's schemas, which CMake compiles into the program (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::study {

extern const std::string_view study_schema_text;
extern const std::string_view study_result_schema_text;

}  // namespace rouleau::study
