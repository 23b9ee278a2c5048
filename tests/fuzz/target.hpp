// What fuzz targets share: the function they consist of, files in memory, and what may come out of the host.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "json/json.hpp"

/// A target: everything that the bytes of a file can set off in one part of the host. It returns for good bytes and for
/// bad ones; it ends the process where the host does not keep what it promises.
void fuzz_target(std::string_view bytes);

namespace rouleau::fuzz {

/// What a target's bytes are meant to be, for the mutator.
struct Form {
  const nlohmann::json* schema = nullptr;  ///< null: no JSON
  std::vector<std::string> words;          ///< worth trying as keys and texts, beyond those of the schema
};

/// A file that lies in memory and yet has a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::runtime_error("no file can be made in memory");
    while (!content.empty()) {
      const auto written = ::write(descriptor_, content.data(), content.size());
      if (written <= 0) throw std::runtime_error("a file in memory cannot be written");
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Ends the process, so that libFuzzer keeps the input.
[[noreturn]] inline void broken_promise(const char* promise, const std::string& found) {
  std::fprintf(stderr, "%s:\n%s\n", promise, found.c_str());
  std::abort();
}

/// What is printed must not steer a terminal.
inline void require_printable(const std::string& text) {
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f)
      broken_promise("a message with control characters", text);
  }
}

/// Runs `work`, which may end well or with the host's own error. Any other exception is a fault and is let through.
template <class Work>
void may_refuse(Work work) {
  try {
    work();
  } catch (const rouleau::Error& error) {
    const std::string message = error.what();
    if (message.empty()) broken_promise("an error without words", message);
    require_printable(message);
    if (error.cause() == rouleau::Cause::bad_input && error.place().file.empty()) {
      broken_promise("bad input, but no place", message);
    }
  }
}

}  // namespace rouleau::fuzz

/// Every target says what its bytes are meant to be.
rouleau::fuzz::Form fuzz_form();
