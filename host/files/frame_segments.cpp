#include "frame_segments.hpp"

#include <charconv>
#include <system_error>

#include "base/error.hpp"
#include "file.hpp"

namespace rouleau::files {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
  throw Error(Cause::input_output, Place{file.string()}, problem,
              {"put back the file as the run left it, or begin anew, here or in another directory",
               {Way::anew, Way::elsewhere}});
}

/// Where the segment with this number is: the only one of a run that ended is frames.h5.
std::filesystem::path place_of(std::size_t number, const std::filesystem::path& frames) {
  auto file = frames.parent_path() / segment_name(number);
  std::error_code ignored;
  const bool renamed = number == 1 && !std::filesystem::exists(file, ignored);
  return renamed && std::filesystem::exists(frames, ignored) ? frames : file;
}

void require(const std::filesystem::path& file, const FrameSegment& segment) {
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  if (missing) refuse(file, "is missing: the checkpoint counts on " + std::to_string(segment.frames) + " frames in it");
  if (bytes != segment.bytes)
    refuse(file, "has " + std::to_string(bytes) + " bytes and had " + std::to_string(segment.bytes) +
                     " when the checkpoint was written");
  if (const auto now = checksum_of(file).value(); now != segment.checksum)
    refuse(file, "is from another run or has been changed since the checkpoint was written: its checksum (XXH3) is " +
                     checksum_text(now) + " and was " + checksum_text(segment.checksum));
}

}  // namespace

std::size_t FramesSaved::frames() const {
  std::size_t sum = 0;
  for (const auto& segment : segments) sum += segment.frames;
  return sum;
}

void to_json(nlohmann::json& json, const FramesSaved& saved) {
  auto segments = nlohmann::json::array();
  for (const auto& segment : saved.segments)
    segments.push_back(
        {{"frames", segment.frames}, {"bytes", segment.bytes}, {"checksum", checksum_text(segment.checksum)}});
  json = {{"segments", segments}};
}

void from_json(const nlohmann::json& json, FramesSaved& saved) {
  saved.segments.clear();
  for (const auto& segment : json.at("segments"))
    saved.segments.push_back({segment.at("frames").get<std::size_t>(), segment.at("bytes").get<std::uintmax_t>(),
                              checksum_from_text(segment.at("checksum").get<std::string>())});
}

std::string segment_name(std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
  return "frames-" + digits + ".h5";
}

std::optional<std::size_t> segment_number(const std::string& name) {
  constexpr std::string_view before = "frames-", after = ".h5";
  if (!name.starts_with(before) || !name.ends_with(after) || name.size() <= before.size() + after.size()) return {};
  std::size_t number = 0;
  std::from_chars(name.data() + before.size(), name.data() + name.size() - after.size(), number);
  return segment_name(number) == name ? std::optional(number) : std::nullopt;
}

void require_segments(const std::filesystem::path& frames, const FramesSaved& saved) {
  for (std::size_t i = 0; i < saved.segments.size(); ++i) require(place_of(i + 1, frames), saved.segments[i]);
}

void take_up_segments(const std::filesystem::path& frames, const FramesSaved& saved) {
  const auto folder = frames.has_parent_path() ? frames.parent_path() : ".";
  if (!saved.segments.empty() && place_of(1, frames) == frames) move_into_place(frames, folder / segment_name(1));
  const std::string partial = "." + frames.filename().string() + ".";
  std::vector<std::filesystem::path> superfluous;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const auto number = segment_number(name);
    const bool half_written = name.starts_with(partial) && name.ends_with(".partial");
    if (number ? *number > saved.segments.size() : half_written || name == frames.filename())
      superfluous.push_back(entry.path());
  }
  if (error) fail_file(folder, "cannot be listed", error.value());
  for (const auto& file : superfluous) {
    std::filesystem::remove(file, error);
    if (error) fail_file(file, "cannot be removed", error.value());
  }
  if (!superfluous.empty()) synchronise(folder);
}

}  // namespace rouleau::files
