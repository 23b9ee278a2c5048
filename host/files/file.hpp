// Files that grow or are replaced, with every write checked and every failure worded for the user; their locks and
// checksums.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "base/input_file.hpp"

struct XXH3_state_s;

namespace rouleau::files {

/// XXH3 with 64 bits (xxhash.com) of bytes that come piece by piece.
class Checksum {
 public:
  Checksum();
  void update(std::string_view bytes);
  [[nodiscard]] std::uint64_t value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const noexcept;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Of the bytes [first, end) of a file, or to where it ends if that is before `end`. Throws Error(input_output).
Checksum checksum_of(const std::filesystem::path& file, std::uintmax_t first = 0,
                     std::uintmax_t end = std::numeric_limits<std::uintmax_t>::max());

/// Sixteen hexadecimal digits, as `xxh64sum -H3` prints them.
std::string checksum_text(std::uint64_t checksum);
/// Throws std::invalid_argument for anything but sixteen hexadecimal digits.
std::uint64_t checksum_from_text(const std::string& text);

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

/// An exclusive lock on a file or directory, held until it is destroyed or the process ends, however that ends.
class FileLock {
 public:
  /// Nothing is locked yet. The file is made if it is not there. Throws Error(input_output).
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// False when another process has it. True, without a lock, on file systems that know none.
  [[nodiscard]] bool take();
  /// Waits for it; `waiting` is called once if it does. False when `interrupted` was set meanwhile.
  [[nodiscard]] bool wait(const std::function<void()>& waiting, const std::atomic<bool>* interrupted);
  void release();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// The file that every study on this machine locks while it takes times: $ROULEAU_TIMING_LOCK, or
/// rouleau-timing.lock in $XDG_RUNTIME_DIR, or in /tmp.
std::filesystem::path timing_lock_file();

}  // namespace rouleau::files
