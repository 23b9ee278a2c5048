#include "file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"

namespace rouleau::files {

namespace {

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

std::string read_text(const std::filesystem::path& file) { return read_input(file, largest_table); }

void require_own(const std::filesystem::path& file) {
  std::error_code gone;
  const auto real = std::filesystem::canonical(file, gone);
  const auto folder = std::filesystem::canonical(file.has_parent_path() ? file.parent_path() : ".", gone);
  if (real.empty() || real.parent_path() == folder) return;  // what is not there is missed by whoever reads it
  throw Error(Cause::input_output, Place{file.string()},
              "is a link to " + in_quotes(real.string()) + ", and a run's files lie in its own directory",
              {"put a copy of that file in the link's place, if it belongs to the run"});
}

void write_file(const std::filesystem::path& file, const std::string& content, Kept kept) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  // A rename would replace a device or a socket by a plain file.
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    fail_file(file, "is no regular file and cannot be replaced", EEXIST);

  const auto partial = folder / ("." + file.filename().string() + "." + std::to_string(::getpid()) + ".partial");
  Descriptor output(::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (output.number() < 0) fail_file(file, "cannot be created", errno);
  const bool to_disk = kept == Kept::on_disk;
  if (!write_all(output.number(), content) || (to_disk && ::fsync(output.number()) != 0) || !output.close() ||
      ::rename(partial.c_str(), file.c_str()) != 0) {
    const int error = errno;
    ::unlink(partial.c_str());
    fail_file(file, "cannot be written", error);
  }
  if (to_disk) synchronise(folder);
}

void write_into(const std::filesystem::path& file, std::string_view begin) {
  Descriptor output(::open(file.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC));
  if (output.number() < 0 || !write_all(output.number(), begin) || ::fsync(output.number()) != 0 || !output.close())
    fail_file(file, "cannot be written", errno);
}

void synchronise(const std::filesystem::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0) fail_file(file, "cannot be opened", errno);
  // Some file systems cannot synchronise a folder (EINVAL); the files in it are whole all the same.
  if (::fsync(opened.number()) != 0 && errno != EINVAL && errno != EROFS)
    fail_file(file, "cannot be synchronised with the disk", errno);
}

void move_into_place(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) fail_file(to, "cannot be written", error.value());
  synchronise(to.has_parent_path() ? to.parent_path() : ".");
}

Checksum require(const std::filesystem::path& file, const FileMark& mark) {
  const std::string lost = ", and a run cannot go on from there";
  const Remedy remedy{"bring back the file as it was, or begin anew", {Way::anew}};
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) fail_reading(file, error.value());
  if (size < mark.bytes)
    throw Error(Cause::input_output, Place{file.string()},
                "is shorter than when the checkpoint was written, " + std::to_string(size) + " bytes instead of " +
                    std::to_string(mark.bytes) + lost,
                remedy);
  Checksum checksum = checksum_of(file, 0, mark.bytes);
  if (checksum.value() != mark.checksum)
    throw Error(Cause::input_output, Place{file.string()},
                "was changed since the checkpoint was written (the checksum of its first " +
                    std::to_string(mark.bytes) + " bytes differs)" + lost,
                remedy);
  return checksum;
}

AppendFile::AppendFile(std::filesystem::path file, Kept kept) : file_(std::move(file)), kept_(kept) {
  const int number = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (number < 0) fail_file(file_, "cannot be created", errno);
  ::fcntl(number, F_SETFL, O_APPEND);  // only to open it is not waited for
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
  checksum_ = {};
  bytes_ = 0;
}

void AppendFile::go_back(const FileMark& mark) {
  flush();
  checksum_ = require(file_, mark);
  bytes_ = mark.bytes;
  if (::ftruncate(::fileno(stream_.get()), static_cast<off_t>(mark.bytes)) != 0)
    fail_file(file_, "cannot be shortened", errno);
}

void AppendFile::end_line() {
  flush();
  const std::string text = read_text(file_);
  const std::size_t end = text.rfind('\n');
  const auto kept = static_cast<off_t>(end == std::string::npos ? 0 : end + 1);
  if (::ftruncate(::fileno(stream_.get()), kept) != 0) fail_file(file_, "cannot be shortened", errno);
}

void AppendFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_.get()) != text.size())
    fail_file(file_, "cannot be written", errno);
  checksum_.update(text);
  bytes_ += text.size();
}

void AppendFile::flush() {
  if (std::fflush(stream_.get()) != 0) fail_file(file_, "cannot be written", errno);
}

void AppendFile::synchronise() {
  flush();
  if (kept_ == Kept::for_now) return;
  // A pipe or device cannot be synchronised (EINVAL), and need not be.
  if (::fsync(::fileno(stream_.get())) != 0 && errno != EINVAL && errno != EROFS)
    fail_file(file_, "cannot be written", errno);
}

FileMark AppendFile::mark() {
  synchronise();
  return {bytes_, checksum_.value()};
}

void AppendFile::close() {
  synchronise();
  if (std::fclose(stream_.release()) != 0) fail_file(file_, "cannot be written", errno);
}

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

Checksum::Checksum() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}

void Checksum::Free::operator()(XXH3_state_s* state) const noexcept { XXH3_freeState(state); }

void Checksum::update(std::string_view bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }

std::uint64_t Checksum::value() const { return XXH3_64bits_digest(state_.get()); }

Checksum checksum_of(const std::filesystem::path& file, std::uintmax_t first, std::uintmax_t end) {
  const InputFile input(file);
  Checksum checksum;
  std::vector<char> buffer(std::size_t{1} << 18);
  for (std::uintmax_t at = first; at < end;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uintmax_t>(buffer.size(), end - at));
    const std::size_t read = input.read(buffer.data(), wanted, at);
    checksum.update({buffer.data(), read});
    at += read;
    if (read < wanted) break;
  }
  return checksum;
}

std::string checksum_text(std::uint64_t checksum) {
  std::string digits(16, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, checksum >>= 4)
    *digit = "0123456789abcdef"[checksum & 15];
  return digits;
}

std::uint64_t checksum_from_text(const std::string& text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value, 16);
  if (text.size() != 16 || error != std::errc{} || rest != end)
    throw std::invalid_argument("\"" + text + "\" is no checksum of sixteen hexadecimal digits");
  return value;
}

}  // namespace rouleau::files
