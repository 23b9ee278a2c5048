#include "sha256.hpp"

#include <sha2.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "error.hpp"
#include "input_file.hpp"

namespace rouleau {

std::string sha256(const std::filesystem::path& file) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  static_cast<void>(InputFile(file));
  errno = 0;
  if (SHA256File(file.c_str(), digest) == nullptr) {
    throw Error(Cause::input_output, Place{file.string()}, std::string("cannot be read: ") + std::strerror(errno));
  }
  return digest;
}

std::string sha256_of(std::string_view text) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digest);
}

}  // namespace rouleau
