// A run's directory as `rouleau report` reads it: summary.json, series.csv and cells.csv, split by lines of "====".
#include "report/report_data.hpp"

#include <fstream>

#include "scratch_folder.hpp"
#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  static const test::ScratchFolder folder;
  constexpr std::string_view border = "====\n";
  for (const char* name : {"summary.json", "series.csv", "cells.csv"}) {
    const auto file = folder.path() / name;
    std::filesystem::remove(file);
    if (bytes.empty()) continue;  // a run that was killed early
    const auto end = std::min(bytes.find(border), bytes.size());
    std::ofstream(file, std::ios::binary) << bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + border.size(), bytes.size()));
  }
  fuzz::may_refuse(
      [&] { report::report_data(folder.path()).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); });
}

fuzz::Form fuzz_form() { return {}; }
