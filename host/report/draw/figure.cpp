#include "figure.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>

#include "base/error.hpp"

namespace rouleau::report {

namespace {

struct Destroy {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;
using Context = std::unique_ptr<cairo_t, Destroy>;

using Colour = std::array<double, 3>;
/// As on the report's page; told apart without seeing red and green.
constexpr std::array<Colour, 6> cell_colours{{{0.000, 0.447, 0.698},
                                              {0.835, 0.369, 0.000},
                                              {0.722, 0.302, 1.000},
                                              {0.035, 0.035, 0.698},
                                              {0.698, 0.510, 0.384},
                                              {0.298, 0.165, 0.165}}};
constexpr Colour flow_colour{0.48, 0.55, 0.64};

/// Sizes in pixels, for a panel of this width.
struct Measures {
  Measures(int pixels, const PanelBox& box)
      : width(pixels),
        scale(width / box.size[0]),
        height(std::round(box.size[1] * scale)),
        font(std::max(11.0, width / 32)),
        margin(std::max(6.0, width / 60)),
        caption(1.9 * font),
        line(std::max(1.5, width / 280)) {}
  double width, scale, height, font, margin, caption, line;
};

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(Cause::input_output, std::string("the picture cannot be drawn: ") + cairo_status_to_string(status));
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void set_colour(cairo_t* context, const Colour& colour, double alpha = 1) {
  cairo_set_source_rgba(context, colour[0], colour[1], colour[2], alpha);
}

/// Whole boxes by which a cell is moved to lie in the box, and its neighbours where it may reach over a border.
std::vector<double> images(double middle, double length, bool periodic) {
  if (!periodic) return {0};
  const double home = -length * std::floor(middle / length);
  return {home - length, home, home + length};
}

void draw_cell(cairo_t* context, const observe::OutlineSnapshot& outlines, std::size_t cell, const PanelBox& box,
               const Measures& measures) {
  const auto begin = static_cast<std::size_t>(outlines.first[cell]),
             end = static_cast<std::size_t>(outlines.first[cell + 1]);
  if (begin == end) return;
  const auto middle = [&](const std::vector<double>& v) {
    return std::accumulate(v.begin() + long(begin), v.begin() + long(end), 0.0) / double(end - begin);
  };
  const double x = middle(outlines.x), y = middle(outlines.y);
  if (!std::isfinite(x) || !std::isfinite(y)) return;  // the last output of a diverged run
  const Colour& colour = cell_colours[cell % cell_colours.size()];
  for (const double dx : images(x, box.size[0], true)) {
    for (const double dy : images(y, box.size[1], box.periodic_y)) {
      cairo_new_path(context);
      for (std::size_t i = begin; i < end; ++i)
        cairo_line_to(context, (outlines.x[i] + dx) * measures.scale,
                      measures.height - (outlines.y[i] + dy) * measures.scale);
      cairo_close_path(context);
      set_colour(context, colour, 0.2);
      cairo_fill_preserve(context);
      set_colour(context, colour);
      cairo_set_line_width(context, measures.line);
      cairo_stroke(context);
    }
  }
}

void draw_line(cairo_t* context, double x0, double y0, double x1, double y1, double width) {
  cairo_set_line_width(context, width);
  cairo_move_to(context, x0, y0);
  cairo_line_to(context, x1, y1);
  cairo_stroke(context);
}

void draw_border(cairo_t* context, const PanelBox& box, const Measures& m) {
  const std::array<double, 2> dashes{4 * m.line, 3 * m.line};
  set_colour(context, {0.6, 0.6, 0.6});
  cairo_set_dash(context, dashes.data(), 2, 0);
  draw_line(context, 0, 0, 0, m.height, m.line / 2);
  draw_line(context, m.width, 0, m.width, m.height, m.line / 2);
  if (!box.periodic_y) {
    cairo_set_dash(context, nullptr, 0, 0);
    set_colour(context, {0, 0, 0});
  }
  const double width = box.periodic_y ? m.line / 2 : 2 * m.line;
  draw_line(context, 0, 0, m.width, 0, width);
  draw_line(context, 0, m.height, m.width, m.height, width);
  cairo_set_dash(context, nullptr, 0, 0);
}

void draw_flow(cairo_t* context, const Panel& panel, const PanelBox& box, const Measures& m) {
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(context, 0.6 * m.line);
  for (const FlowLine& line : panel.flow) {
    set_colour(context, flow_colour, 0.8 * line.strength);
    for (const double dx : images(line.points.front()[0], box.size[0], true)) {
      for (const auto& [x, y] : line.points) cairo_line_to(context, (x + dx) * m.scale, m.height - y * m.scale);
      cairo_stroke(context);
    }
  }
  cairo_set_line_cap(context, CAIRO_LINE_CAP_BUTT);
}

/// Arrow heads outside of each wall that moves.
void draw_walls(cairo_t* context, const WallMotion& walls, const Measures& m) {
  const double apart = m.width / 14, size = 0.45 * m.margin;
  set_colour(context, {0, 0, 0});
  for (std::size_t wall = 0; wall < 2; ++wall) {
    if (walls.speed[wall] == 0) continue;
    const double ahead = walls.speed[wall] > 0 ? size : -size,
                 y = wall == 0 ? m.height + 0.55 * m.margin : -0.55 * m.margin;
    const double begin = std::fmod(walls.gone[wall] * m.scale, apart);
    for (double x = begin - apart; x < m.width; x += apart) {
      if (x < size || x > m.width - size) continue;
      cairo_move_to(context, x - ahead, y - 0.6 * size);
      cairo_line_to(context, x + ahead, y);
      cairo_line_to(context, x - ahead, y + 0.6 * size);
      cairo_close_path(context);
      cairo_fill(context);
    }
  }
}

/// A bar of a round length, at most a quarter of the box.
void draw_scale(cairo_t* context, const PanelBox& box, const Measures& m) {
  constexpr double micro = 1e-6;
  double length = 0.1 * micro;
  for (const double candidate : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0})
    if (candidate * micro <= box.size[0] / 4) length = candidate * micro;
  std::ostringstream words;
  words << std::round(length / micro * 10) / 10 << " µm";
  set_colour(context, {0, 0, 0});
  const double y = m.height - 1.2 * m.margin;
  draw_line(context, m.margin, y, m.margin + length * m.scale, y, 1.5 * m.line);
  cairo_set_font_size(context, 0.85 * m.font);
  cairo_move_to(context, m.margin, y - 0.5 * m.font);
  cairo_show_text(context, words.str().c_str());
}

}  // namespace

std::array<int, 2> picture_size(const PanelBox& box, std::size_t panels, std::size_t columns, int width) {
  const Measures m(width, box);
  const auto shown = std::min(columns, std::max<std::size_t>(1, panels));
  const std::size_t rows = std::max<std::size_t>(1, (panels + columns - 1) / columns);
  const auto even = [](double length) { return 2 * static_cast<int>(std::ceil(length / 2)); };
  return {even((m.width + 2 * m.margin) * double(shown)), even((m.caption + m.height + 2 * m.margin) * double(rows))};
}

std::string draw_panels(const PanelBox& box, const std::vector<Panel>& panels, std::size_t columns, int width,
                        PictureFormat format) {
  const Measures m(width, box);
  const auto [wide, high] = picture_size(box, panels.size(), columns, width);
  const double across = m.width + 2 * m.margin, down = m.caption + m.height + 2 * m.margin;
  std::string picture;
  const Surface surface(format == PictureFormat::svg ? cairo_svg_surface_create_for_stream(append, &picture, wide, high)
                        : format == PictureFormat::pdf
                            ? cairo_pdf_surface_create_for_stream(append, &picture, wide, high)
                            : cairo_image_surface_create(CAIRO_FORMAT_RGB24, wide, high));
  check(cairo_surface_status(surface.get()));
  // A picture is the same whenever it is drawn.
  if (format == PictureFormat::pdf)
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "1970-01-01T00:00:00Z");
  const Context context(cairo_create(surface.get()));
  cairo_t* c = context.get();
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
  cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const std::size_t row = k / columns, column = k % columns;
    cairo_save(c);
    cairo_translate(c, double(column) * across + m.margin, double(row) * down + m.margin);
    set_colour(c, {0, 0, 0});
    cairo_set_font_size(c, m.font);
    cairo_move_to(c, 0, m.font);
    cairo_show_text(c, panels[k].caption.c_str());
    cairo_translate(c, 0, m.caption);
    cairo_save(c);
    cairo_rectangle(c, 0, 0, m.width, m.height);
    cairo_clip(c);
    draw_flow(c, panels[k], box, m);
    const auto& outlines = panels[k].outlines;
    for (std::size_t cell = 0; cell + 1 < outlines.first.size(); ++cell) draw_cell(c, outlines, cell, box, m);
    cairo_restore(c);
    draw_border(c, box, m);
    draw_walls(c, panels[k].walls, m);
    if (k == 0) draw_scale(c, box, m);
    cairo_restore(c);
  }
  check(cairo_status(c));
  if (format == PictureFormat::png) {
    check(cairo_surface_write_to_png_stream(surface.get(), append, &picture));
  } else if (format == PictureFormat::pixels) {
    cairo_surface_flush(surface.get());
    const auto* data = reinterpret_cast<const char*>(cairo_image_surface_get_data(surface.get()));
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < high; ++y) picture.append(data + long(y) * stride, std::size_t(4 * wide));
  } else {
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  return picture;
}

Drawing::~Drawing() {
  cairo_debug_reset_static_data();
  FcFini();
}

}  // namespace rouleau::report
