#include "output/file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "output/run_directory.hpp"

namespace rouleau::host {

namespace {

std::string remedy(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space there, or write to another disk with --out";
    case EFBIG:
      return "raise the file size limit (ulimit -f), or write fewer outputs";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a directory you may write to with --out";
    case ENOENT:
    case ENOTDIR:
      return "check that every part of the path before the last is a directory";
    case EMFILE:
    case ENFILE:
      return "close other files, or raise the limit (ulimit -n)";
    default:
      return "check the disk, or write to another one with --out";
  }
}

/// A file descriptor that closes itself; close() reports what the destructor cannot.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  bool close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void fail_file(const std::filesystem::path& file, const std::string& what, int error) {
  throw Error(ExitCode::input_output, Place{file.string(), "", 0, 0},
              what + ": " + std::generic_category().message(error) + "\n  " + remedy(error));
}

std::string read_text(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.is_open() || stream.bad()) {
    const int error = errno;
    throw Error(ExitCode::input_output, Place{file.string(), "", 0, 0},
                "cannot be read: " + std::generic_category().message(error != 0 ? error : EIO));
  }
  return text;
}

void write_file(const std::filesystem::path& file, const std::string& content) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  // A rename would replace a device or a socket by a plain file.
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    fail_file(file, "is no regular file and cannot be replaced", EEXIST);

  const auto partial = folder / ("." + file.filename().string() + "." + std::to_string(::getpid()) + ".partial");
  Descriptor output(::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (output.number() < 0) fail_file(file, "cannot be created", errno);
  if (!write_all(output.number(), content) || ::fsync(output.number()) != 0 || !output.close() ||
      ::rename(partial.c_str(), file.c_str()) != 0) {
    const int error = errno;
    ::unlink(partial.c_str());
    fail_file(file, "cannot be written", error);
  }
  // The new name itself lives in the folder. Some file systems cannot sync a folder (EINVAL); the file is whole all the
  // same.
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0 && ::fsync(directory.number()) != 0 && errno != EINVAL && errno != EROFS)
    fail_file(folder, "cannot be synchronised with the disk", errno);
}

AppendFile::AppendFile(std::filesystem::path file, Access access) : file_(std::move(file)) {
  const int flags = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (access == Access::shared ? O_TRUNC : 0);
  Descriptor output(::open(file_.c_str(), flags, 0666));
  if (output.number() < 0) fail_file(file_, "cannot be created", errno);
  // File systems without locks answer with another error; then two runs in one directory are the user's affair.
  if (access == Access::exclusive && ::flock(output.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error(ExitCode::bad_input, Place{file_.string(), "", 0, 0},
                "another run is writing into this directory; wait for it, or choose another one with --out");
  const int number = ::fcntl(output.number(), F_DUPFD_CLOEXEC, 0);  // shares the lock
  if (number < 0) fail_file(file_, "cannot be created", errno);
  stream_.reset(::fdopen(number, "a"));
  if (!stream_) {
    const int error = errno;
    ::close(number);
    fail_file(file_, "cannot be created", error);
  }
}

void AppendFile::clear() {
  if (std::fflush(stream_.get()) != 0 || ::ftruncate(::fileno(stream_.get()), 0) != 0)
    fail_file(file_, "cannot be emptied", errno);
}

void AppendFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_.get()) != text.size())
    fail_file(file_, "cannot be written", errno);
}

void AppendFile::flush() {
  if (std::fflush(stream_.get()) != 0) fail_file(file_, "cannot be written", errno);
}

void AppendFile::close() {
  flush();
  // A pipe or device cannot be synchronised (EINVAL), and need not be.
  if (::fsync(::fileno(stream_.get())) != 0 && errno != EINVAL && errno != EROFS)
    fail_file(file_, "cannot be written", errno);
  if (std::fclose(stream_.release()) != 0) fail_file(file_, "cannot be written", errno);
}

}  // namespace rouleau::host
