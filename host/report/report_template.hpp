// The pages report.html, study.html and limits.html without their data: those of page/ with all they include, compiled
// in by CMake (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::report {

extern const std::string_view space_template;  ///< what a report of surfaces has besides
extern const std::string_view report_template, study_template, limits_template;

}  // namespace rouleau::report
