#include "input_file.hpp"

#include <fcntl.h>
#include <sha2.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "error.hpp"
#include "synonyms.hpp"

namespace rouleau {

namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a pipe";
  return S_ISSOCK(mode) ? "a socket" : "a device";
}

Remedy remedy(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return {"free some space there, or write to another disk", {Way::elsewhere}};
    case EFBIG:
      return {"raise the file size limit (ulimit -f), or write fewer outputs"};
    case EACCES:
    case EPERM:
    case EROFS:
      return {"choose a directory you may write to", {Way::elsewhere}};
    case ENOENT:
    case ENOTDIR:
      return {"check that every part of the path before the last is a directory"};
    case ELOOP:
      return {"it is a link, and what it leads to is not this run's to change: remove the link"};
    case ENXIO:
      return {"it is a pipe that nobody reads: remove it"};
    case EMFILE:
    case ENFILE:
      return {"close other files, or raise the limit (ulimit -n)"};
    default:
      return {"check the disk, or write to another one", {Way::elsewhere}};
  }
}

/// Of a file that is not there: the name of what lies where the path goes wrong and is called nearly so.
std::string meant(const std::filesystem::path& file) {
  constexpr std::size_t looked_at = 10000;
  std::error_code ignored;
  std::filesystem::path at = std::filesystem::absolute(file, ignored);
  while (at.has_relative_path() && !std::filesystem::exists(at.parent_path(), ignored)) at = at.parent_path();
  std::vector<std::string> names;
  std::filesystem::directory_iterator entry(at.parent_path(), ignored);
  for (; entry != std::filesystem::directory_iterator() && names.size() < looked_at; entry.increment(ignored))
    names.push_back(entry->path().filename().string());
  std::sort(names.begin(), names.end());
  return did_you_mean(at.filename().string(), names);
}

}  // namespace

InputFile::InputFile(std::filesystem::path file, std::uintmax_t largest) : file_(std::move(file)), largest_(largest) {
  struct stat about {};
  // Opening a device may do something, and a socket cannot be opened: looked at first, and again what was opened.
  if (::stat(file_.c_str(), &about) != 0) fail_reading(file_, errno);
  descriptor_ = S_ISREG(about.st_mode) ? ::open(file_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC) : -1;
  if (S_ISREG(about.st_mode) && (descriptor_ < 0 || ::fstat(descriptor_, &about) != 0)) {
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    fail_reading(file_, error);
  }
  const bool regular = S_ISREG(about.st_mode), fits = static_cast<std::uintmax_t>(about.st_size) <= largest_;
  if (regular && fits) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  if (regular) refuse_size();
  throw Error(Cause::input_output, Place{file_.string()},
              std::string("this file cannot be read: it is ") + kind_of(about.st_mode),
              {"give a plain file" +
               std::string(S_ISFIFO(about.st_mode) ? "; what comes through a pipe must be written to one first" : "")});
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::refuse_size() const {
  throw Error(Cause::bad_input, Place{file_.string()},
              "this file has more than " + std::to_string(largest_ >> 20U) +
                  " MiB, which is the most that is read of a file of this kind");
}

std::size_t InputFile::read(char* to, std::size_t count, std::uintmax_t from) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t part = ::pread(descriptor_, to + done, count - done, static_cast<off_t>(from + done));
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) fail_reading(file_, errno);
    if (part == 0) break;
    done += static_cast<std::size_t>(part);
  }
  return done;
}

std::string InputFile::text() const {
  std::string text;
  std::array<char, std::size_t{1} << 16U> piece{};
  for (std::size_t part = piece.size(); part == piece.size();) {
    part = read(piece.data(), piece.size(), text.size());
    text.append(piece.data(), part);
    if (text.size() > largest_) refuse_size();
  }
  return text;
}

std::string read_input(const std::filesystem::path& file, std::uintmax_t largest) {
  return InputFile(file, largest).text();
}

void fail_file(const std::filesystem::path& file, const std::string& what, int error) {
  throw Error(Cause::input_output, Place{file.string()}, what + ": " + std::generic_category().message(error),
              remedy(error));
}

void fail_reading(const std::filesystem::path& file, int error) {
  throw Error(
      Cause::input_output, Place{file.string()},
      "this file cannot be read: " + std::generic_category().message(error) + (error == ENOENT ? meant(file) : ""),
      {error == ENOENT   ? "bring the file back, or check the path"
       : error == EACCES ? "see to it that you may read it (ls -l)"
                         : ""});
}

std::string sha256(const std::filesystem::path& file) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  static_cast<void>(InputFile(file));
  errno = 0;
  if (SHA256File(file.c_str(), digest) == nullptr)
    throw Error(Cause::input_output, Place{file.string()}, std::string("cannot be read: ") + std::strerror(errno));
  return digest;
}

std::string sha256_of(std::string_view text) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digest);
}

}  // namespace rouleau
