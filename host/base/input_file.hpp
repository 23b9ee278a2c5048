// The one door for files that are read: regular ones alone, of a size that is said.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace rouleau {

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
