// Checksums that tell whether a file is still what was written: XXH3 with 64 bits, against accidents, not attackers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace rouleau::files {

/// XXH3 with 64 bits (xxhash.com) of bytes that come piece by piece.
class Checksum {
 public:
  Checksum();
  void update(std::string_view bytes);
  [[nodiscard]] std::uint64_t value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const noexcept;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Of the bytes [first, end) of a file, or to where it ends if that is before `end`. Throws Error(input_output).
Checksum checksum_of(const std::filesystem::path& file, std::uintmax_t first = 0,
                     std::uintmax_t end = std::numeric_limits<std::uintmax_t>::max());

/// Sixteen hexadecimal digits, as `xxh64sum -H3` prints them.
std::string checksum_text(std::uint64_t checksum);
/// Throws std::invalid_argument for anything but sixteen hexadecimal digits.
std::uint64_t checksum_from_text(const std::string& text);

}  // namespace rouleau::files
