// A video made of pictures by ffmpeg, where that is installed.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace rouleau::report {

/// Writes `file` (MP4, H.264), whole or not at all, from pictures of `size` (PictureFormat::pixels), which `next` hands
/// out until it has no more. False when there is no ffmpeg. Throws Error(input_output) with ffmpeg's words when it fails.
bool write_video(const std::filesystem::path& file, const std::array<int, 2>& size, int frames_per_second,
                 const std::function<std::optional<std::string>()>& next);

}  // namespace rouleau::report
