#include "log.hpp"

#include <cmath>

namespace rouleau::files {

void Log::go_on(double elapsed) {
  file_.end_line();
  before_ = elapsed;
}

double Log::elapsed() const {
  return before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Log::write(const std::string& event, const nlohmann::json& details) {
  nlohmann::ordered_json line{{"wall_s", std::round(elapsed() * 1e6) * 1e-6}, {"event", event}};
  if (details.is_object())
    // A detail named like a part of every line must not stand in its place: when something happened is never lost.
    for (const auto& [key, value] : details.items()) line[line.contains(key) ? event + "_" + key : key] = value;
  else if (!details.is_null())
    line["details"] = details;
  // A path or a loader's message may hold bytes that are no UTF-8; that must not end a run.
  file_.write(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file_.flush();
}

}  // namespace rouleau::files
