// A run's directory: the only place, with the checkpoint, where the simulation writes files.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "error.hpp"
#include "input/scene.hpp"
#include "output/snapshot.hpp"
#include "output/summary.hpp"

namespace rouleau::host {

/// Writes a file whole or not at all: temporary file in the same folder, fsync, rename. Throws Error(input_output).
void write_file(const std::filesystem::path& file, const std::string& content);

/// Writes the run directory of PRODUCT.md section 4. Every member throws Error(input_output) with path and reason.
class RunDirectory {
 public:
  /// Makes the directory (and parents). Refuses one that holds another run's files unless they are only a former run's
  /// outputs, which are replaced.
  RunDirectory(std::filesystem::path directory, const Scene& scene);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Rows of cells.csv and aggregates.csv, outlines (and fields when not empty) into frames.h5.
  void write(const Snapshot& snapshot);
  /// One line of log.jsonl: {"wall_s":..., "event":..., ...details}.
  void log(const std::string& event, const nlohmann::json& details = nlohmann::json::object());
  /// Closes the data files, writes frames.xmf and summary.json. Nothing may be written after it.
  void finish(const Summary& summary);

  [[nodiscard]] const std::filesystem::path& path() const { return directory_; }

 private:
  struct Files;
  std::filesystem::path directory_;
  std::unique_ptr<Files> files_;
};

}  // namespace rouleau::host
