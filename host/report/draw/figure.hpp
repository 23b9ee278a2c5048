// Pictures of cells in the layout of the paper's figures: panels in rows, each a box with a caption above it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "observe/snapshot.hpp"

namespace rouleau::report {

/// The domain as a panel shows it.
struct PanelBox {
  std::array<double, 2> size;  ///< m
  bool periodic_y;             ///< otherwise walls below and above
};

struct Panel {
  std::string caption;
  observe::OutlineSnapshot outlines;
};

/// PNG of panels in rows of `columns`, each box `width` pixels wide: outlines coloured by cell, with the images of what
/// crosses the periodic borders, walls as thick lines, and a bar for the scale in the first panel. The picture's sides
/// are even numbers of pixels, as video wants them. Throws Error(input_output) when there is no memory for it.
std::string draw_panels(const PanelBox& box, const std::vector<Panel>& panels, std::size_t columns, int width);

/// Gives back at its end what cairo and fontconfig keep for the next picture, which leak checkers take for lost.
/// Nothing may be drawn after it.
struct Drawing {
  Drawing() = default;
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
};

}  // namespace rouleau::report
