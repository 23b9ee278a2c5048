#include "image_file.hpp"

#include <png.h>

#include <memory>

#include "base/error.hpp"
#include "base/input_file.hpp"

namespace rouleau::shape {

GreyPicture read_png(const std::filesystem::path& file) {
  constexpr std::size_t most_pixels = 100'000'000;
  const std::string bytes = read_input(file, largest_input);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&image, png_image_free);
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::bad_input, {.file = file.string()}, problem,
                {"give a PNG picture, light where fluid is or dark"});
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    refuse("is no PNG picture: " + std::string(image.message));
  if (std::size_t{image.width} * image.height > most_pixels)
    refuse("has " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels, more than 10^8");
  image.format = PNG_FORMAT_GRAY;
  GreyPicture picture{{static_cast<int>(image.width), static_cast<int>(image.height)}, {}};
  std::vector<png_byte> grey(PNG_IMAGE_SIZE(image));
  const png_color white{255, 255, 255};
  const int lowest_first = -static_cast<int>(image.width);
  if (png_image_finish_read(&image, &white, grey.data(), lowest_first, nullptr) == 0)
    refuse("is damaged: " + std::string(image.message));
  picture.light.reserve(grey.size());
  for (const png_byte value : grey) picture.light.push_back(value / 255.0);
  return picture;
}

}  // namespace rouleau::shape
