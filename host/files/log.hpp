// log.jsonl: what happened when, one JSON object a line, on the disk's doorstep as soon as it is written.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "file.hpp"
#include "json/json.hpp"

namespace rouleau::files {

class Log {
 public:
  /// Throws Error(input_output) when it cannot be made.
  explicit Log(const std::filesystem::path& file, Kept kept = Kept::on_disk) : file_(file, kept) {}
  /// Keeps a former run's lines but for a last one that was never ended; time goes on from `elapsed` seconds.
  void go_on(double elapsed);
  /// Seconds since the log was opened, and those of the run it goes on from.
  [[nodiscard]] double elapsed() const;
  /// {"wall_s": elapsed(), "event": event, ...details}; details that are no object become
  /// "details", and a detail called wall_s or event is written as EVENT_wall_s.
  void write(const std::string& event, const nlohmann::json& details);
  void close() { file_.close(); }

 private:
  AppendFile file_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double before_ = 0;
};

}  // namespace rouleau::files
