# Writes a C++ source that holds a text file as a string: cmake -DINPUT=... -DOUTPUT=... -P report_template.cmake
file(READ "${INPUT}" content)
if(content MATCHES "\\)ROULEAU\"")
  message(FATAL_ERROR "${INPUT} holds the end mark of the raw string it is to be embedded in")
endif()
file(WRITE "${OUTPUT}" "// Made from ${INPUT} by report_template.cmake.
#include <string_view>

namespace rouleau::host {
extern const std::string_view report_template;
const std::string_view report_template = R\"ROULEAU(${content})ROULEAU\";
}  // namespace rouleau::host
")
