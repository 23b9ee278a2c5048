// Pictures for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

namespace rouleau::test {

inline void put_number(std::string& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 255U);
}

inline void put_chunk(std::string& to, const std::string& name, const std::string& data) {
  put_number(to, static_cast<std::uint32_t>(data.size()));
  std::uint32_t crc = ~0U;
  for (const char byte : name + data) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  to += name + data;
  put_number(to, ~crc);
}

/// Grey values, 255 light, as an uncompressed PNG file; row 0 is the lowest.
inline std::string png(int width, int height, const std::function<double(double x, double y)>& light) {
  std::string rows;
  for (int j = height - 1; j >= 0; --j) {
    rows += '\0';
    for (int i = 0; i < width; ++i)
      rows += static_cast<char>(std::lround(255 * std::clamp(light(i + 0.5, j + 0.5), 0.0, 1.0)));
  }
  std::uint32_t a = 1, b = 0;
  for (const char byte : rows) a = (a + static_cast<unsigned char>(byte)) % 65521, b = (b + a) % 65521;
  std::string packed = "\x78\x01";
  for (std::size_t at = 0; at < rows.size(); at += 65535) {
    const auto length = static_cast<std::uint32_t>(std::min<std::size_t>(65535, rows.size() - at));
    packed += at + length == rows.size() ? '\1' : '\0';
    for (const std::uint32_t word : {length, ~length})
      packed += static_cast<char>(word & 255U), packed += static_cast<char>(word >> 8U & 255U);
    packed += rows.substr(at, length);
  }
  put_number(packed, b << 16U | a);
  std::string head, file = "\x89PNG\r\n\x1a\n";
  put_number(head, static_cast<std::uint32_t>(width));
  put_number(head, static_cast<std::uint32_t>(height));
  head += std::string("\x08\0\0\0\0", 5);
  put_chunk(file, "IHDR", head);
  put_chunk(file, "IDAT", packed);
  put_chunk(file, "IEND", "");
  return file;
}

}  // namespace rouleau::test
