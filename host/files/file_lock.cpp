#include "file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "file.hpp"

namespace rouleau::files {

FileLock::FileLock(const std::filesystem::path& file) : file_(file) {
  // In a folder that all may write to only its owner may open a file for making it; locking needs no right to write.
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0 && errno == ENOENT)
    descriptor_ = open(file.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor_ < 0) fail_file(file, "cannot be opened to be locked", errno);
}

FileLock::~FileLock() { close(descriptor_); }

bool FileLock::take() {
  while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno == ENOLCK || errno == ENOTSUP || errno == EINVAL) return true;  // a file system that knows no locks
    if (errno != EINTR) fail_file(file_, "cannot be locked", errno);
  }
  return true;
}

bool FileLock::wait(const std::function<void()>& waiting, const std::atomic<bool>* interrupted) {
  if (take()) return true;
  waiting();
  while (!take()) {
    if (interrupted != nullptr && *interrupted) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

void FileLock::release() { flock(descriptor_, LOCK_UN); }

std::filesystem::path timing_lock_file() {
  if (const char* chosen = secure_getenv("ROULEAU_TIMING_LOCK"); chosen != nullptr && *chosen != '\0') return chosen;
  const char* runtime = secure_getenv("XDG_RUNTIME_DIR");
  const std::filesystem::path folder = runtime != nullptr && std::filesystem::is_directory(runtime) ? runtime : "/tmp";
  return folder / "rouleau-timing.lock";
}

}  // namespace rouleau::files
