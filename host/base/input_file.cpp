#include "input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "error.hpp"
#include "file_fault.hpp"

namespace rouleau {

namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a pipe";
  return S_ISSOCK(mode) ? "a socket" : "a device";
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

}  // namespace rouleau
