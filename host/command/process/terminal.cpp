#include "terminal.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <streambuf>
#include <string_view>

#include "base/text.hpp"

namespace rouleau::command {

namespace {

/// Keeps text until it is flushed, and makes it printable then.
class PrintableBuffer : public std::streambuf {
 public:
  explicit PrintableBuffer(int descriptor) : descriptor_(descriptor) {}
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Our own marks, which steer a terminal; everything before them must have been flushed.
  [[nodiscard]] bool mark(const std::string& text) { return write_all(text) == 0; }

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
    return write_all(text);
  }

 private:
  [[nodiscard]] int write_all(const std::string& text) const {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = ::write(descriptor_, text.data() + at, text.size() - at);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return -1;
      at += static_cast<std::size_t>(written);
    }
    return 0;
  }

  int descriptor_;
  std::string pending_;
};

/// Takes everything, and keeps nothing.
class SilentBuffer : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
};

// Never destroyed: the streams are flushed once more when the program ends.
PrintableBuffer* standard_output = nullptr;

bool plain_text_wanted() {
  const char *no_color = std::getenv("NO_COLOR"), *term = std::getenv("TERM");
  return (no_color != nullptr && *no_color != '\0') || (term != nullptr && std::string_view(term) == "dumb");
}

/// Null where it is no terminal, or colours are not wanted.
PrintableBuffer* colour_terminal(const std::ostream& stream) {
  auto* const buffer = dynamic_cast<PrintableBuffer*>(stream.rdbuf());
  return buffer != nullptr && ::isatty(buffer->descriptor()) == 1 && !plain_text_wanted() ? buffer : nullptr;
}

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

Coloured::Coloured(std::ostream& stream, Colour colour)
    : stream_(stream.flush()), shown_(colour_terminal(stream) != nullptr) {
  if (shown_) shown_ = colour_terminal(stream)->mark("\x1b[" + std::to_string(static_cast<int>(colour)) + "m");
}

Coloured::~Coloured() {
  if (!shown_) return;
  stream_.flush();
  static_cast<void>(colour_terminal(stream_)->mark("\x1b[0m"));
}

std::size_t text_width(std::size_t without) {
  constexpr long least = 40, most = 100;
  const char* columns = std::getenv("COLUMNS");
  long width = columns != nullptr ? std::strtol(columns, nullptr, 10) : 0;
  winsize size{};
  const int output = standard_output != nullptr ? standard_output->descriptor() : STDOUT_FILENO;
  if (width <= 0 && ::ioctl(output, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width <= 0 ? without : static_cast<std::size_t>(std::clamp(width, least, most));
}

void silence_terminal() {
  static auto& nobody = *new SilentBuffer;
  std::cout.rdbuf(&nobody);
  std::cerr.rdbuf(&nobody);
}

void give_terminal_back() {
  std::cout.flush();
  if (standard_output != nullptr) dup2(standard_output->descriptor(), STDOUT_FILENO);
}

}  // namespace rouleau::command
