// The files that frames.h5 is made of: sealed segments while a run goes on, one file with their checksums at its end.
//
// An HDF5 file that is open when its writer is killed may be damaged. So a run writes frames-0001.h5, and whenever a
// checkpoint is due that segment is closed, synchronised with the disk and never touched again (sealed); the next frame
// begins frames-0002.h5. At the end one frames.h5 is made of all of them and takes its place by renaming; only then are
// the segments removed. A frames.h5 made of several segments carries their checksums and its own behind HDF5's end, in
// lines of text that HDF5 does not look at: so it can stand in for the segments of a checkpoint that was written
// before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rouleau::files {

/// A sealed segment, the k-th of which is frames-000k.h5 until frames.h5 is made.
struct FrameSegment {
  std::size_t frames = 0;
  std::uintmax_t bytes = 0;
  std::uint64_t checksum = 0;  ///< XXH3, 64 bits, of the whole file
  bool operator==(const FrameSegment&) const = default;
};

/// What a checkpoint keeps of the frames: every segment since the run began, also those that frames.h5 holds by now.
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

/// What of `saved` is on the disk, where.
struct FramesFound {
  std::size_t merged = 0;  ///< the first so many segments are in frames.h5
  bool more = false;       ///< frames.h5 has further frames behind them
};

/// Verifies every segment of `saved` against the files beside `frames` (the path of frames.h5): as sealed, or in
/// frames.h5. Throws Error(input_output) naming the file, what differs and the remedy.
FramesFound find_frames(const std::filesystem::path& frames, const FramesSaved& saved);

/// Removes all segments beside `frames` but those numbered first to last, and what an interrupted merge has left.
void remove_segments(const std::filesystem::path& frames, std::size_t first, std::size_t last);

/// Writes the checksums behind HDF5's end of a closed file that was made of these segments.
void append_checksums(const std::filesystem::path& file, const std::vector<FrameSegment>& segments);

}  // namespace rouleau::files
