#include "frame_segments.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "base/error.hpp"
#include "checksum.hpp"
#include "file.hpp"

namespace rouleau::files {

namespace {

// Lines of fixed length, so that they are found from the file's end: one for each segment, and the last.
constexpr std::string_view segment_word = "segment ", last_word = "frames.h5 ", count_word = " made of ";
constexpr std::size_t checksum_length = 16, count_length = 8;
constexpr std::size_t segment_line = segment_word.size() + checksum_length + 1;
constexpr std::size_t last_line = last_word.size() + checksum_length + count_word.size() + count_length + 1;

/// The last line behind its checksum, which is of all bytes before the line. A wrong count gives other checksums than
/// the checkpoint's, and is so found.
std::string count_text(std::size_t count) {
  std::string digits = std::to_string(count);
  if (digits.size() > count_length) throw std::length_error("too many segments of frames");
  digits.insert(0, count_length - digits.size(), '0');
  return std::string(count_word) + digits + "\n";
}

std::string text_at(std::ifstream& stream, std::uintmax_t offset, std::size_t length) {
  std::string text(length, '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  stream.read(text.data(), static_cast<std::streamsize>(length));
  return stream ? text : "";
}

/// Checksums of the segments that a file says it was made of; nothing when it says nothing, or has been changed.
std::vector<std::uint64_t> said_segments(const std::filesystem::path& file, std::uintmax_t bytes) try {
  if (bytes < last_line) return {};
  std::ifstream stream(file, std::ios::binary);
  const std::string last = text_at(stream, bytes - last_line, last_line);
  if (!last.starts_with(last_word)) return {};
  std::size_t count = 0;
  const char* const digits = last.data() + last.size() - count_length - 1;
  if (std::from_chars(digits, digits + count_length, count).ptr != digits + count_length) return {};
  if (last.substr(last_word.size() + checksum_length) != count_text(count)) return {};
  if (count > (bytes - last_line) / segment_line) return {};
  if (checksum_from_text(last.substr(last_word.size(), checksum_length)) !=
      checksum_of(file, 0, bytes - last_line).value())
    return {};
  std::vector<std::uint64_t> segments;
  const std::uintmax_t first = bytes - last_line - count * segment_line;
  const std::string lines = text_at(stream, first, count * segment_line);
  for (std::size_t i = 0; i < count; ++i)
    segments.push_back(checksum_from_text(lines.substr(i * segment_line + segment_word.size(), checksum_length)));
  return segments;
} catch (const std::invalid_argument&) {
  return {};
}

/// A file that says nothing may be a single segment that was renamed.
std::vector<std::uint64_t> segments_in(const std::filesystem::path& file) {
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  if (missing) return {};
  auto segments = said_segments(file, bytes);
  if (segments.empty()) segments.push_back(checksum_of(file).value());
  return segments;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
  throw Error(Cause::input_output, Place{file.string()}, problem,
              {"put back the file as the run left it, or begin anew, here or in another directory",
               {Way::anew, Way::elsewhere}});
}

void verify(const std::filesystem::path& frames, std::size_t number, const FrameSegment& segment) {
  const auto file = frames.parent_path() / segment_name(number);
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  if (missing) {
    if (std::filesystem::exists(frames))
      refuse(frames,
             "does not hold the frames that the checkpoint counts on: it is from another run, or has been "
             "changed since (XXH3 " +
                 checksum_text(checksum_of(frames).value()) + "), and " + segment_name(number) +
                 ", which held them before, is gone");
    refuse(frames, "is missing, and so is " + segment_name(number) +
                       ", into which a run writes them first: the checkpoint counts on " +
                       std::to_string(segment.frames) + " frames");
  }
  if (bytes != segment.bytes)
    refuse(file, "has " + std::to_string(bytes) + " bytes and had " + std::to_string(segment.bytes) +
                     " when the checkpoint was written");
  if (const auto now = checksum_of(file).value(); now != segment.checksum)
    refuse(file, "has been changed since the checkpoint was written: its checksum (XXH3) is " + checksum_text(now) +
                     " and was " + checksum_text(segment.checksum));
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

FramesFound find_frames(const std::filesystem::path& frames, const FramesSaved& saved) {
  const auto merged = segments_in(frames);
  FramesFound found;
  while (found.merged < std::min(merged.size(), saved.segments.size()) &&
         merged[found.merged] == saved.segments[found.merged].checksum)
    ++found.merged;
  found.more = merged.size() > found.merged;
  for (std::size_t i = found.merged; i < saved.segments.size(); ++i) verify(frames, i + 1, saved.segments[i]);
  return found;
}

void remove_segments(const std::filesystem::path& frames, std::size_t first, std::size_t last) {
  const auto folder = frames.has_parent_path() ? frames.parent_path() : ".";
  const std::string partial = "." + frames.filename().string() + ".";
  std::vector<std::filesystem::path> superfluous;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const auto number = segment_number(name);
    if (number ? *number < first || *number > last : name.starts_with(partial) && name.ends_with(".partial"))
      superfluous.push_back(entry.path());
  }
  if (error) fail_file(folder, "cannot be listed", error.value());
  for (const auto& file : superfluous) {
    std::filesystem::remove(file, error);
    if (error) fail_file(file, "cannot be removed", error.value());
  }
  if (!superfluous.empty()) synchronise(folder);
}

void append_checksums(const std::filesystem::path& file, const std::vector<FrameSegment>& segments) {
  std::string lines;
  for (const auto& segment : segments) lines += std::string(segment_word) + checksum_text(segment.checksum) + "\n";
  const auto append = [&](const std::string& text) {
    errno = 0;
    std::ofstream stream(file, std::ios::binary | std::ios::app);
    stream << text;
    stream.close();
    if (!stream) fail_file(file, "cannot be written", errno != 0 ? errno : EIO);
  };
  append(lines);
  append(std::string(last_word) + checksum_text(checksum_of(file).value()) + count_text(segments.size()));
}

}  // namespace rouleau::files
