// Whether a file is still the one that it was.
#pragma once

#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <filesystem>

namespace rouleau {

/// What whoever replaces a file or writes to it changes: device, number, length, times of its content and of its entry.
/// All zero: there is no such file.
using FileStamp = std::array<std::int64_t, 7>;

inline FileStamp stamp_of(const std::filesystem::path& file) {
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0) return {};
  const auto number = [](auto value) { return static_cast<std::int64_t>(value); };
  return {number(s.st_dev),          number(s.st_ino),         number(s.st_size),        number(s.st_mtim.tv_sec),
          number(s.st_mtim.tv_nsec), number(s.st_ctim.tv_sec), number(s.st_ctim.tv_nsec)};
}

}  // namespace rouleau
