#include "checksum.hpp"

#include <xxhash.h>

#include <algorithm>
#include <charconv>
#include <new>
#include <stdexcept>
#include <vector>

#include "base/input_file.hpp"

namespace rouleau::files {

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
