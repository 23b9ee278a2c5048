// Locks between processes: one timed run at a time on a machine, one study at a time in a directory.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

namespace rouleau::files {

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
