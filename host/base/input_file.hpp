// Files that the program reads: their bytes, whether they are still what they were, and why one cannot be read.
#pragma once

#include <sys/stat.h>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace rouleau {

/// Throws Error(input_output): the path, what was tried ("cannot be written"), the system's words for `error` (an
/// errno) and what the user can do about it.
[[noreturn]] void fail_file(const std::filesystem::path& file, const std::string& what, int error);

/// The same for a file that cannot be read.
[[noreturn]] void fail_reading(const std::filesystem::path& file, int error);

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

/// SHA-256 of a file, lower-case hexadecimal. Throws Error(input_output).
std::string sha256(const std::filesystem::path& file);
/// SHA-256 of a text, in the same form.
std::string sha256_of(std::string_view text);

inline constexpr std::uintmax_t any_size = std::numeric_limits<std::uintmax_t>::max();

/// The most that is read of a mesh or a table of cells in text, bytes.
inline constexpr std::uintmax_t largest_input = std::uintmax_t{256} << 20U;
/// Of any file that a scene names.
inline constexpr std::uintmax_t largest_named = std::uintmax_t{4} << 30U;

/// An open regular file. A pipe, a device or a folder is refused at once: nothing waits for whoever writes into a pipe,
/// and nothing is read of what has no end. Links are followed.
class InputFile {
 public:
  /// Throws Error(input_output) for what cannot be opened or is no regular file, Error(bad_input) for one of more than
  /// `largest` bytes.
  explicit InputFile(std::filesystem::path file, std::uintmax_t largest = any_size);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Up to `count` bytes from byte `from` on; fewer only at the end. Throws Error(input_output).
  std::size_t read(char* to, std::size_t count, std::uintmax_t from) const;
  /// All of it. Throws as the constructor does: a file may have grown since.
  [[nodiscard]] std::string text() const;

 private:
  [[noreturn]] void refuse_size() const;

  std::filesystem::path file_;
  std::uintmax_t largest_;
  int descriptor_;
};

/// Whole content of a regular file; throws what InputFile does.
std::string read_input(const std::filesystem::path& file, std::uintmax_t largest);

}  // namespace rouleau
