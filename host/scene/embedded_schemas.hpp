// The texts of this folder's schemas, which CMake compiles into the program (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::scene {

extern const std::string_view scene_schema_text, cell_schema_text;

}  // namespace rouleau::scene
