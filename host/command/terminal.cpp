#include "terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <streambuf>
#include <string>

#include "base/text.hpp"

namespace rouleau::command {

namespace {

/// Keeps text until it is flushed, and makes it printable then.
class PrintableBuffer : public std::streambuf {
 public:
  explicit PrintableBuffer(int descriptor) : descriptor_(descriptor) {}
  [[nodiscard]] int descriptor() const { return descriptor_; }

 protected:
  int_type overflow(int_type c) override {
    if (c != traits_type::eof()) pending_ += traits_type::to_char_type(c);
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    pending_.append(text, static_cast<std::size_t>(count));
    return count;
  }
  int sync() override {
    const std::string text = printable_lines(pending_);
    pending_.clear();
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = ::write(descriptor_, text.data() + at, text.size() - at);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return -1;
      at += static_cast<std::size_t>(written);
    }
    return 0;
  }

 private:
  int descriptor_;
  std::string pending_;
};

// Never destroyed: the streams are flushed once more when the program ends.
PrintableBuffer* standard_output = nullptr;

}  // namespace

void take_terminal() {
  static auto& errors = *new PrintableBuffer(STDERR_FILENO);
  std::cerr.rdbuf(&errors);
  const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 10);  // beyond what a check's process expects
  if (own < 0) return;                                        // there is no standard output
  standard_output = new PrintableBuffer(own);
  std::cout.rdbuf(standard_output);
  if (fcntl(STDERR_FILENO, F_GETFD) >= 0) dup2(STDERR_FILENO, STDOUT_FILENO);
}

void give_terminal_back() {
  std::cout.flush();
  if (standard_output != nullptr) dup2(standard_output->descriptor(), STDOUT_FILENO);
}

}  // namespace rouleau::command
