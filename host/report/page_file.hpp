// Puts the data of a page into its template: what report.html, study.html and limits.html have in common.
#pragma once

#include <string>
#include <string_view>

#include "json/json.hpp"

namespace rouleau::report {

/// `page` with its mark for the data replaced by `data`, in such a way that no text in the data can end it early or
/// become markup.
std::string page_with(std::string_view page, const nlohmann::json& data);

}  // namespace rouleau::report
