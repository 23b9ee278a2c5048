#include "report/draw/figure.hpp"

#include <cairo.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

using namespace rouleau::observe;
using namespace rouleau::report;

namespace {

const Drawing drawing;  // ends after all tests

using Image = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

Image decoded(const std::string& png) {
  struct Source {
    const std::string& bytes;
    std::size_t at = 0;
  } source{png};
  const auto read = [](void* closure, unsigned char* data, unsigned int length) {
    auto& from = *static_cast<Source*>(closure);
    if (from.at + length > from.bytes.size()) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, from.bytes.data() + from.at, length);
    from.at += length;
    return CAIRO_STATUS_SUCCESS;
  };
  return {cairo_image_surface_create_from_png_stream(read, &source), cairo_surface_destroy};
}

/// A round cell of 2 um at (x, y), um.
OutlineSnapshot disc(double x, double y) {
  OutlineSnapshot outlines;
  outlines.first = {0, 64};
  for (int i = 0; i < 64; ++i) {
    const double angle = 2 * std::numbers::pi * i / 64;
    outlines.x.push_back((x + 2 * std::cos(angle)) * 1e-6);
    outlines.y.push_back((y + 2 * std::sin(angle)) * 1e-6);
  }
  return outlines;
}

/// Share of pixels in the left or right half that are coloured (not grey), of the rows from `top` down.
double coloured(const std::string& png, bool right) {
  const Image image = decoded(png);
  const int width = cairo_image_surface_get_width(image.get()), height = cairo_image_surface_get_height(image.get());
  const unsigned char* data = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  long count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = right ? width / 2 : 0; x < (right ? width : width / 2); ++x) {
      const unsigned char* pixel = data + y * stride + 4 * x;
      count += std::abs(pixel[0] - pixel[2]) > 20 ? 1 : 0;
    }
  return double(count) / (double(width) / 2 * height);
}

}  // namespace

TEST_CASE("a panel shows a cell where it is, and what crosses a periodic border on both sides") {
  const PanelBox box{{20e-6, 10e-6}, false};
  const auto left = draw_panels(box, {{"left", disc(5, 5)}}, 1, 400);
  CHECK(coloured(left, false) > 0.05);
  CHECK(coloured(left, true) == 0);
  const auto border = draw_panels(box, {{"border", disc(20, 5)}}, 1, 400);
  CHECK(coloured(border, false) == Approx(coloured(border, true)).epsilon(0.1));
  // Whole boxes away is the same place.
  CHECK(draw_panels(box, {{"left", disc(-35, 5)}}, 1, 400) == left);
}

TEST_CASE("cells do not come back through walls") {
  const auto outside = disc(5, 15);
  CHECK(coloured(draw_panels({{20e-6, 10e-6}, false}, {{"", outside}}, 1, 400), false) == 0);
  CHECK(coloured(draw_panels({{20e-6, 10e-6}, true}, {{"", outside}}, 1, 400), false) > 0.05);
}

TEST_CASE("pictures have even sides, and panels stand in rows") {
  for (const int width : {301, 420, 960}) {
    const PanelBox box{{50.176e-6, 25.088e-6}, false};
    const Image one = decoded(draw_panels(box, {{"", disc(5, 5)}}, 1, width));
    const int across = cairo_image_surface_get_width(one.get()), down = cairo_image_surface_get_height(one.get());
    CHECK(across % 2 == 0);
    CHECK(down % 2 == 0);
    const Image five = decoded(draw_panels(box, std::vector<Panel>(5, {"", disc(5, 5)}), 3, width));
    CHECK(std::abs(cairo_image_surface_get_width(five.get()) - 3 * across) <= 6);
    CHECK(std::abs(cairo_image_surface_get_height(five.get()) - 2 * down) <= 4);
  }
}

TEST_CASE("an output that is not finite leaves its cell out") {
  auto outlines = disc(5, 5);
  outlines.x[3] = std::nan("");
  CHECK(coloured(draw_panels({{20e-6, 10e-6}, false}, {{"", outlines}}, 1, 400), false) == 0);
}

TEST_CASE("a picture is drawn as SVG, as PDF that is the same every time, and as pixels that are those of the PNG") {
  const PanelBox box{{20e-6, 10e-6}, false};
  const std::vector<Panel> panels{{"cell", disc(5, 5)}};
  for (const auto format : {PictureFormat::pdf, PictureFormat::pixels})
    CHECK(draw_panels(box, panels, 1, 400, format) == draw_panels(box, panels, 1, 400, format));
  CHECK(draw_panels(box, panels, 1, 400, PictureFormat::pdf).starts_with("%PDF-"));
  CHECK(draw_panels(box, panels, 1, 400, PictureFormat::svg).find("<svg") != std::string::npos);
  const Image image = decoded(draw_panels(box, panels, 1, 400));
  const auto [width, height] = picture_size(box, 1, 1, 400);
  REQUIRE(cairo_image_surface_get_width(image.get()) == width);
  REQUIRE(cairo_image_surface_get_height(image.get()) == height);
  const std::string pixels = draw_panels(box, panels, 1, 400, PictureFormat::pixels);
  REQUIRE(pixels.size() == std::size_t(4 * width * height));
  const unsigned char* data = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  long different = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      different += std::memcmp(data + y * stride + 4 * x, pixels.data() + 4L * (y * width + x), 3) != 0 ? 1 : 0;
  CHECK(different == 0);
}
