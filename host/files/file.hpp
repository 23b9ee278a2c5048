// Files that grow or are replaced, with every write checked and every failure worded for the user.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/file_fault.hpp"
#include "checksum.hpp"

namespace rouleau::files {

/// The most that is read of a table or a log, bytes.
inline constexpr std::uintmax_t largest_table = std::uintmax_t{2} << 30U;

/// Whole content of a file; throws what InputFile does.
std::string read_text(const std::filesystem::path& file);

/// Throws Error(input_output) for a link that leads out of the file's folder: whoever gives a run away could show with
/// it what its reader keeps elsewhere.
void require_own(const std::filesystem::path& file);

/// Whether a file must be on the disk when it is closed, whatever happens to the machine, or is soon made again.
enum class Kept { on_disk, for_now };

/// Writes a file whole or not at all: temporary file in the same folder, fsync, rename. Throws Error(input_output).
void write_file(const std::filesystem::path& file, const std::string& content, Kept kept = Kept::on_disk);

/// Overwrites the beginning of a file that is there already, and brings all of it to the disk. Throws
/// Error(input_output).
void write_into(const std::filesystem::path& file, std::string_view begin);

/// A file's content, or a folder's entries, to the disk. Throws Error(input_output).
void synchronise(const std::filesystem::path& file);
/// Gives a whole and synchronised file its name at last. Throws Error(input_output).
void move_into_place(const std::filesystem::path& from, const std::filesystem::path& to);

/// How much of a growing file there was at some moment.
struct FileMark {
  std::uintmax_t bytes = 0;
  std::uint64_t checksum = 0;
};

/// The checksum of what a file held at the mark. Throws Error(input_output) where it does not begin with that any more.
Checksum require(const std::filesystem::path& file, const FileMark& mark);

/// A text file that grows. Every member but the destructor throws Error(input_output).
class AppendFile {
 public:
  /// Creates the file, or opens it: then clear() or go_back() says what becomes of its content. No link is followed.
  explicit AppendFile(std::filesystem::path file, Kept kept = Kept::on_disk);
  void clear();
  /// Drops what was written after the mark. Throws Error(input_output) where what came before is not what it was.
  void go_back(const FileMark& mark);
  /// Keeps the content but for a last line that has no end.
  void end_line();
  void write(std::string_view text);
  /// Hands everything to the system, so that a crash of the program loses nothing and `tail -f` sees it.
  void flush();
  /// To the disk, if it is kept there.
  void synchronise();
  /// How much there is, which is on the disk when this returns.
  FileMark mark();
  /// Synchronised, and closed. Nothing may be written after it.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
  };
  std::filesystem::path file_;
  Kept kept_;
  std::unique_ptr<std::FILE, Close> stream_;
  Checksum checksum_;  ///< of what clear() or go_back() left, and all that was written since
  std::uintmax_t bytes_ = 0;
};

}  // namespace rouleau::files
