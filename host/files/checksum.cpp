#include "checksum.hpp"

#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <vector>

#include "file.hpp"

namespace rouleau::files {

Checksum::Checksum() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}

void Checksum::Free::operator()(XXH3_state_s* state) const noexcept { XXH3_freeState(state); }

void Checksum::update(std::string_view bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }

std::uint64_t Checksum::value() const { return XXH3_64bits_digest(state_.get()); }

Checksum checksum_of(const std::filesystem::path& file, std::uintmax_t first, std::uintmax_t end) {
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  const auto fail = [&] { fail_reading(file, errno != 0 ? errno : EIO); };
  if (!stream || ::fseeko(stream.get(), static_cast<off_t>(first), SEEK_SET) != 0) fail();
  Checksum checksum;
  std::vector<char> buffer(std::size_t{1} << 18);
  for (std::uintmax_t at = first; at < end;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uintmax_t>(buffer.size(), end - at));
    const std::size_t read = std::fread(buffer.data(), 1, wanted, stream.get());
    checksum.update({buffer.data(), read});
    at += read;
    if (read == wanted) continue;
    if (std::ferror(stream.get()) != 0) fail();
    break;
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
