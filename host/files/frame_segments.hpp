// The files that frames are in: sealed segments, and frames.h5, which leads to them.
//
// An HDF5 file that is open when its writer is killed may be damaged. So a run writes frames-0001.h5, and whenever a
// checkpoint is due that segment is closed, synchronised with the disk and never touched again (sealed); the next frame
// begins frames-0002.h5. At the end a single segment is renamed to frames.h5. Several stay where they are, beside a
// small frames.h5 of external links to their frames, so that no frame is ever written twice.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::files {

/// A sealed segment, the k-th of which is frames-000k.h5 (or frames.h5, when it is the only one of a run that ended).
struct FrameSegment {
  std::size_t frames = 0;
  std::uintmax_t bytes = 0;
  std::uint64_t checksum = 0;  ///< XXH3, 64 bits, of the whole file
  bool operator==(const FrameSegment&) const = default;
};

/// What a checkpoint keeps of the frames: every segment since the run began.
struct FramesSaved {
  std::vector<FrameSegment> segments;
  [[nodiscard]] std::size_t frames() const;
  bool operator==(const FramesSaved&) const = default;
};

/// {"segments": [{"frames": 12, "bytes": 34567, "checksum": "0123456789abcdef"}, ...]}; reading throws
/// nlohmann::json::exception or std::invalid_argument.
void to_json(nlohmann::json& json, const FramesSaved& saved);
void from_json(const nlohmann::json& json, FramesSaved& saved);

/// "frames-0012.h5" for 12, counted from 1.
std::string segment_name(std::size_t number);
/// The number in such a name; nothing for any other name.
std::optional<std::size_t> segment_number(const std::string& name);

/// Verifies every segment of `saved` against the files beside `frames` (the path of frames.h5), and changes nothing.
/// Throws Error(input_output) naming the file, what differs and the remedy.
void require_segments(const std::filesystem::path& frames, const FramesSaved& saved);

/// Leaves these segments under their names and no other frames, so that a run can go on behind them. They must be
/// there (require_segments). Throws Error(input_output).
void take_up_segments(const std::filesystem::path& frames, const FramesSaved& saved);

}  // namespace rouleau::files
