// Files that grow or are replaced, with every write checked and every failure worded for the user.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace rouleau::host {

/// Throws Error(input_output): the path, what was tried ("cannot be written"), the system's words for `error` (an
/// errno) and what the user can do about it.
[[noreturn]] void fail_file(const std::filesystem::path& file, const std::string& what, int error);

/// Whole content of a file; throws Error(input_output).
std::string read_text(const std::filesystem::path& file);

/// A text file that grows. Every member but the destructor throws Error(input_output).
class AppendFile {
 public:
  /// An exclusive file is kept locked while open; another process that has it open makes this throw Error(bad_input).
  enum class Access { shared, exclusive };

  /// Creates the file; a former content is dropped by clear(), or at once when access is shared.
  explicit AppendFile(std::filesystem::path file, Access access = Access::shared);
  void clear();
  void write(std::string_view text);
  /// Hands everything to the system, so that a crash of the program loses nothing and `tail -f` sees it.
  void flush();
  /// To the disk, and closed. Nothing may be written after it.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
  };
  std::filesystem::path file_;
  std::unique_ptr<std::FILE, Close> stream_;
};

}  // namespace rouleau::host
