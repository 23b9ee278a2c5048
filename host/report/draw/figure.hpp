// Pictures of cells in the layout of the paper's figures: panels in rows, each a box with a caption above it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "flow_lines.hpp"
#include "observe/snapshot.hpp"

namespace rouleau::report {

/// The domain as a panel shows it.
struct PanelBox {
  std::array<double, 2> size;  ///< m
  bool periodic_y;             ///< otherwise walls below and above
};

/// How the walls move: a picture shows arrows along them.
struct WallMotion {
  std::array<double, 2> speed{};  ///< of the lower and the upper wall along x, m/s; 0: no arrows
  std::array<double, 2> gone{};   ///< how far they have moved, m: the arrows go with them
};

struct Panel {
  std::string caption;
  observe::OutlineSnapshot outlines;
  std::vector<FlowLine> flow = {};
  WallMotion walls = {};
};

/// `pixels`: four bytes each, blue, green, red and nothing, row by row from above.
enum class PictureFormat { png, svg, pdf, pixels };

/// Picture of panels in rows of `columns`, each box `width` pixels wide: outlines coloured by cell, with the images of what
/// crosses the periodic borders, walls as thick lines, the flow under them, and a bar for the scale in the first panel. The
/// picture's sides are even numbers of pixels, as video wants them; of SVG and PDF a pixel is a point. Throws Error(input_output) when there is no memory for it.
std::string draw_panels(const PanelBox& box, const std::vector<Panel>& panels, std::size_t columns, int width,
                        PictureFormat format = PictureFormat::png);

/// Width and height of such a picture in pixels.
std::array<int, 2> picture_size(const PanelBox& box, std::size_t panels, std::size_t columns, int width);

/// Gives back at its end what cairo and fontconfig keep for the next picture, which leak checkers take for lost.
/// Nothing may be drawn after it.
struct Drawing {
  Drawing() = default;
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
};

}  // namespace rouleau::report
