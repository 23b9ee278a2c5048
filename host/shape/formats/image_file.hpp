// Pictures that walls are drawn in.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace rouleau::shape {

/// How light a picture is, from 0 (black) to 1 (white); what is transparent is white.
struct GreyPicture {
  std::array<int, 2> size{};  ///< pixels across and up
  std::vector<double> light;  ///< row after row, the lowest first
};

/// A PNG file of any kind. Throws what InputFile does, and Error(bad_input) for what is no picture, is damaged, or has
/// more than 10^8 pixels.
GreyPicture read_png(const std::filesystem::path& file);

}  // namespace rouleau::shape
