// The text of report.template.html, which CMake compiles into the program (embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::host {

extern const std::string_view report_template;

}  // namespace rouleau::host
