#include "wall_borders.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/text.hpp"
#include "core/geometry/border.hpp"
#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "formats/image_file.hpp"
#include "formats/mesh_file.hpp"
#include "surface.hpp"

namespace rouleau::shape {

namespace {

using core::Vec;

constexpr double rounding = 1e-6;  // of a period, as core joins borders

template <int D>
std::string in_um(const Vec<D>& place, double unit) {
  std::string text;
  for (int k = 0; k < D; ++k) text += (k > 0 ? ", " : "") + number((place[k] + 0.5) * unit * 1e6, 5) + " um";
  return '(' + text + ')';
}

std::string axis_name(int axis) { return {scene::axis_names[axis]}; }

template <int D>
core::RegionPointer<D> everything() {
  const Vec<D> endless = Vec<D>::Constant(std::numeric_limits<double>::infinity());
  return core::box_region<D>(-endless, endless);
}

/// With its images; facets that are lost where nearby corners become one go.
template <int D>
core::Border<D> imaged(core::Border<D> border, const core::Domain<D>& domain) {
  border = core::with_images(std::move(border), domain);
  std::erase_if(border.facets, [](auto facet) {
    std::sort(facet.begin(), facet.end());
    return std::adjacent_find(facet.begin(), facet.end()) != facet.end();
  });
  return border;
}

/// Of a border that ends at an opening, with a lid there or open: it goes on as its own mirror image.
template <int D>
core::Border<D> opened(core::Border<D> border, const core::Domain<D>& domain) {
  const int axis = domain.open_axis;
  if (axis < 0) return border;
  const core::Border<D> own = border;
  const std::vector<Vec<D>> open = core::open_sides(own);
  border.facets.clear();
  const double size = domain.size[axis], off = rounding * size;
  std::vector<bool> is_end(own.facets.size());
  for (const double plane : {-0.5, size - 0.5}) {
    const auto at_plane = [&](int corner) { return std::abs(own.corners[corner][axis] - plane) <= off; };
    std::vector<bool> here(own.facets.size());
    for (std::size_t i = 0; i < own.facets.size(); ++i)
      here[i] = std::ranges::all_of(own.facets[i], at_plane), is_end[i] = is_end[i] || here[i];
    if (std::ranges::none_of(here, [](bool is) { return is; }) &&
        std::ranges::none_of(open, [&](const Vec<D>& side) { return std::abs(side[axis] - plane) <= off; }))
      continue;
    std::vector<int> image;
    for (int i = 0; i < static_cast<int>(own.corners.size()); ++i) {
      image.push_back(at_plane(i) ? i : static_cast<int>(border.corners.size()));
      Vec<D> corner = own.corners[i];
      corner[axis] = 2 * plane - corner[axis];
      if (!at_plane(i)) border.corners.push_back(corner);
    }
    for (std::size_t i = 0; i < own.facets.size(); ++i) {
      if (here[i]) continue;
      auto facet = own.facets[i];
      for (int& corner : facet) corner = image[corner];
      std::swap(facet[0], facet[1]);
      border.facets.push_back(facet);
    }
  }
  for (std::size_t i = 0; i < own.facets.size(); ++i)
    if (!is_end[i]) border.facets.push_back(own.facets[i]);
  return border;
}

/// Whether a border goes through the domain along a periodic axis, from end to end.
template <int D>
bool passes(const core::Border<D>& border, const core::Domain<D>& domain, int axis) {
  const double period = domain.period(axis);
  if (period == 0 || border.corners.empty()) return false;
  const auto [least, most] =
      std::ranges::minmax(border.corners, {}, [axis](const Vec<D>& corner) { return corner[axis]; });
  return least[axis] <= -0.5 + rounding * period && most[axis] >= period - 0.5 - rounding * period;
}

/// What it encloses, with a sign; of what goes through a domain between its ends, for an axis that it does not pass.
template <int D>
double enclosed(const core::Border<D>& border, int axis) {
  double sum = 0;
  const double from = border.corners.empty() ? 0 : border.corners.front()[axis];
  for (const auto& facet : border.facets) {
    double middle = 0;
    for (const int corner : facet) middle += (border.corners[corner][axis] - from) / D;
    sum += middle * border.normal(facet)[axis];
  }
  return sum;
}

/// Of sides that are not joined only those in the domain are at fault: images end beyond it, mirrored ones too.
template <int D>
std::vector<Vec<D>> faulty_sides(const core::Border<D>& border, const core::Domain<D>& domain) {
  std::vector<Vec<D>> open = core::open_sides(border);
  std::erase_if(open, [&](const Vec<D>& side) {
    for (int k = 0; k < D; ++k) {
      const double size = domain.size[k], off = rounding * size;
      const bool goes_on = domain.periodic[k] || k == domain.open_axis;
      if (goes_on && (side[k] < -0.5 - off || side[k] > size - 0.5 + off)) return true;
    }
    return false;
  });
  return open;
}

template <int D>
void require_closed(const scene::SceneFields& fields, const std::string& pointer, const core::Border<D>& border,
                    const core::Domain<D>& domain, double unit) {
  const std::vector<Vec<D>> open = faulty_sides(border, domain);
  if (open.empty()) return;
  std::string words;
  constexpr std::size_t shown = 3;
  for (std::size_t i = 0; i < std::min(shown, open.size()); ++i) words += (i > 0 ? ", " : "") + in_um<D>(open[i], unit);
  if (open.size() > shown) words += " and elsewhere";
  for (int k = 0; k < D; ++k) {
    const double period = domain.period(k), off = 2 * rounding * period;
    const auto at_end = [&](const Vec<D>& side) { return side[k] <= -0.5 + off || side[k] >= period - 0.5 - off; };
    if (period == 0 || !std::ranges::all_of(open, at_end)) continue;
    fields.refuse(pointer, "what leaves the domain along " + axis_name(k) +
                               ", which is periodic, does not fit its image one period away: borders end at " + words +
                               "\nlet it begin at 0 um and end at " + number(period * unit * 1e6) +
                               " um with the same section, or stay inside");
  }
  fields.refuse(pointer,
                "the border is not closed: " + std::to_string(open.size()) +
                    (D > 2 ? " edges do not join two triangles that run the same way round" : " ends are open") +
                    ", at " + words +
                    "\nclose it; along a periodic axis, or one with openings, let it end at both ends of the domain");
}

/// Of outlines that is looked for where they are read (scene/scene_walls.cpp).
std::optional<Vec<2>> overlap(const core::Border<2>&, int) { return {}; }

/// A place that a surface encloses more than once, or inside out; none: it neither crosses itself nor has parts that
/// overlap, where they are wider than 1/256 of it. Counted along an axis at whose ends it is closed, on lines at
/// irrational places. In each plane of lines a side is cut alike for both of its triangles, so that none is missed.
std::optional<Vec<3>> overlap(const core::Border<3>& border, int axis) {
  constexpr int lines = 256;
  constexpr double offset[2] = {0.6180339887498949, 0.4142135623730951};
  struct Crossing {
    int line;
    double height;
    int enters;                                         ///< -1: leaves
    auto operator<=>(const Crossing&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Eigen::AlignedBox3d box;
  for (const Vec<3>& corner : border.corners) box.extend(corner);
  if (!(box.sizes().minCoeff() > 0)) return {};
  const Vec<3> step = box.sizes() / lines;
  const auto line_behind = [&](int along, double place, double off) {  // the first one
    return std::clamp(static_cast<int>(std::ceil((place - box.min()[along]) / step[along] - off)), 0, lines);
  };
  std::vector<Crossing> crossings;
  for (const auto& facet : border.facets) {
    const auto [least, most] =
        std::minmax({border.corners[facet[0]][u], border.corners[facet[1]][u], border.corners[facet[2]][u]});
    for (int i = line_behind(u, least, offset[0]); i < line_behind(u, most, offset[0]); ++i) {
      const double plane = box.min()[u] + (i + offset[0]) * step[u];
      Vec<3> cut[2] = {box.min(), box.min()};  // by sides that go down along u, and up
      for (int k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(facet[k], facet[(k + 1) % 3]);
        const Vec<3>&from = border.corners[a], &to = border.corners[b];
        const bool up = (from[u] <= plane) == (a == facet[k]);
        if ((from[u] <= plane) != (to[u] <= plane))
          cut[up ? 1 : 0] = from + (plane - from[u]) / (to[u] - from[u]) * (to - from);
      }
      const bool faces_up = cut[1][v] < cut[0][v];
      const Vec<3>&lower = cut[faces_up ? 1 : 0], &upper = cut[faces_up ? 0 : 1];
      for (int j = line_behind(v, lower[v], offset[1]); j < line_behind(v, upper[v], offset[1]); ++j) {
        const double share = (box.min()[v] + (j + offset[1]) * step[v] - lower[v]) / (upper[v] - lower[v]);
        crossings.push_back({i * lines + j, lower[axis] + share * (upper[axis] - lower[axis]), faces_up ? -1 : 1});
      }
    }
  }
  std::ranges::sort(crossings);
  crossings.push_back({-1, 0, 0});
  const double touching = rounding * box.sizes().maxCoeff();
  std::optional<Vec<3>> found;
  int inside = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    const Crossing &here = crossings[i], &next = crossings[i + 1];
    inside += here.enters;
    if (next.line != here.line) {
      if (found && inside == 0) return found;  // on other lines it is open: they pass by its ends
      found.reset(), inside = 0;
    } else if (!found && next.height - here.height > touching && (inside < 0 || inside > 1)) {
      Vec<3>& place = found.emplace();
      const int i_u = here.line / lines, i_v = here.line % lines;
      place[u] = box.min()[u] + (i_u + offset[0]) * step[u];
      place[v] = box.min()[v] + (i_v + offset[1]) * step[v];
      place[axis] = (here.height + next.height) / 2;
    }
  }
  return {};
}

void weld_nearby(core::TriangleSurface& surface, const std::filesystem::path& file) {
  try {
    weld(surface, weld_reach(surface));
  } catch (const std::invalid_argument& error) {
    throw Error(Cause::bad_input, rouleau::Place{file.string()}, error.what());
  }
}

/// Grey values of a stack, the first axis the fastest, and how many along each axis.
template <int D>
struct Samples {
  std::array<int, D> size;
  std::vector<double> values;  ///< positive: belongs to the shape
};

template <int D>
Samples<D> samples_of(const scene::SceneFields& fields, const std::string& pointer,
                      const scene::WallShape::Image& image) {
  constexpr std::size_t most = 50'000'000;
  Samples<D> samples{};
  for (std::size_t i = 0; i < image.files.size(); ++i) {
    const GreyPicture picture = read_png(image.files[i]);
    std::array<int, D> size;
    size.back() = static_cast<int>(image.files.size());
    std::copy_n(picture.size.begin(), 2, size.begin());
    if (i > 0 && size != samples.size)
      fields.refuse(pointer + "/file/" + std::to_string(i),
                    "this picture has another size than the first one\ngive pictures of one size");
    samples.size = size;
    if (picture.light.size() > most || picture.light.size() * image.files.size() > most)
      fields.refuse(
          pointer + "/file",
          "the pictures have more than 5 10^7 pixels together\nmake them smaller; the lattice is as coarse anyway");
    for (const double light : picture.light) samples.values.push_back(image.light ? light - 0.5 : 0.5 - light);
  }
  return samples;
}

/// What lies beyond the samples at an end: nothing of the shape, the samples from the other end, or those of this one.
enum class Beyond { nothing, samples, end };

/// Samples around: `before` and `after` along an axis.
template <int D>
Samples<D> padded(const Samples<D>& samples, int axis, int before, int after, std::array<Beyond, 2> beyond) {
  Samples<D> made{samples.size, {}};
  const int count = samples.size[axis];
  made.size[axis] += before + after;
  std::size_t stride = 1, whole = 1;
  for (int k = 0; k < D; ++k) {
    if (k < axis) stride *= samples.size[k];
    whole *= made.size[k];
  }
  made.values.resize(whole);
  for (std::size_t i = 0; i < whole; ++i) {
    const std::size_t below = i % stride, rest = i / stride;
    const int there = static_cast<int>(rest % made.size[axis]) - before;
    const std::size_t above = rest / made.size[axis];
    const Beyond which = beyond[there < 0 ? 0 : 1];
    const int from = which == Beyond::samples ? ((there % count) + count) % count : std::clamp(there, 0, count - 1);
    const double value = samples.values[below + stride * (from + above * count)];
    made.values[i] = from == there || which != Beyond::nothing ? value : -std::abs(value);
  }
  return made;
}

}  // namespace

void require_reach(const scene::SceneFields& fields, const std::string& pointer, int axis, double period, double from,
                   double to, double unit) {
  if (from >= -0.5 - period * (1 + rounding) && to <= 2 * period - 0.5 + period * rounding) return;
  const auto um = [&](double place) { return number((place + 0.5) * unit * 1e6) + " um"; };
  fields.refuse(pointer, "it reaches from " + um(from) + " to " + um(to) + " along " + axis_name(axis) +
                             ", where the domain is periodic and " + um(period - 0.5) +
                             " long\nlet it end within one period of the domain, at 0 um and the domain's "
                             "end if it goes through");
}

core::Border<3> mesh_border(const scene::WallShape::Mesh& mesh) {
  core::TriangleSurface surface = read_triangles(mesh.file);
  core::Border<3> border{surface.nodes, surface.triangles};
  if (!core::open_sides(border).empty()) {
    weld_nearby(surface, mesh.file);
    border = {surface.nodes, surface.triangles};
  }
  for (std::size_t i = 0; i < border.facets.size(); ++i) {
    if (!(border.normal(border.facets[i]).norm() > 0))
      throw Error(Cause::bad_input, rouleau::Place{mesh.file.string()},
                  "triangle " + std::to_string(i) + " has no area", {"leave it out, and join what it joined"});
  }
  const Eigen::Matrix3d rotation = rotation_of(mesh.axis, mesh.angle);
  for (Vec<3>& corner : border.corners) corner = rotation * (mesh.unit * corner) + mesh.at.in<3>();
  return border;
}

template <int D>
core::RegionPointer<D> closed_region(const scene::SceneFields& fields, const std::string& pointer,
                                     core::Border<D> border, const core::Domain<D>& domain, double unit) {
  if (border.facets.empty()) fields.refuse(pointer, "there are no triangles of any size\ngive a surface of triangles");
  int held = 0;  // an axis along which it does not go through, if there is one
  for (int k = 0; k < D; ++k) {
    const auto [least, most] = std::ranges::minmax(border.corners, {}, [k](const Vec<D>& corner) { return corner[k]; });
    if (domain.period(k) > 0) require_reach(fields, pointer, k, domain.period(k), least[k], most[k], unit);
    if (held == domain.open_axis || passes(border, domain, held)) held = k;
    if (domain.period(k) > 0 && !passes(border, domain, k) && most[k] - least[k] > domain.period(k))
      fields.refuse(pointer,
                    "it is longer than the domain along " + axis_name(k) +
                        ", which is periodic, and would lie over its own image\nlet it begin at 0 um and end at " +
                        number(domain.period(k) * unit * 1e6) + " um, or make it shorter");
  }
  const std::optional<Vec<D>> overlapping = passes(border, domain, held) ? std::nullopt : overlap(border, held);
  border = imaged(opened(std::move(border), domain), domain);
  if (border.facets.empty()) return everything<D>();
  require_closed(fields, pointer, border, domain, unit);
  if (!(enclosed(border, held) > 0))
    fields.refuse(pointer, "the surface is inside out: its triangles run clockwise seen from outside\nturn them over");
  if (overlapping)
    fields.refuse(pointer, "the surface crosses itself, or parts of it overlap or are inside out, at " +
                               in_um<D>(*overlapping, unit) +
                               "\njoin its parts to one surface, or give each a file and take their \"union\"");
  try {
    return std::make_shared<core::FacetedRegion<D>>(std::move(border));
  } catch (const std::invalid_argument& error) {
    fields.refuse(pointer, error.what());
  }
}

template <int D>
core::RegionPointer<D> picture_region(const scene::SceneFields& fields, const std::string& pointer,
                                      const scene::WallShape::Image& image, const core::Domain<D>& domain,
                                      double unit) {
  Samples<D> samples = samples_of<D>(fields, pointer, image);
  if (std::ranges::none_of(samples.values, [](double value) { return value > 0; }))
    fields.refuse(pointer, "nothing in the picture is " + std::string(image.light ? "lighter" : "darker") +
                               " than half grey\ntake another picture, or \"fluid\": " +
                               (image.light ? "\"dark\"" : "\"light\""));
  core::Domain<D> around = domain;
  Vec<D> step, first;
  for (int k = 0; k < D; ++k) {
    step[k] = (k < 2 ? image.pixel : image.spacing) / unit;
    const double at = image.at[k] / unit - 0.5, length = samples.size[k] * step[k], period = domain.period(k);
    const bool wraps = period > 0 && std::abs(length - period) <= rounding * period;
    int before = 1, after = 1;
    std::array<Beyond, 2> beyond{};
    if (wraps) beyond = {Beyond::samples, Beyond::samples};
    if (const double size = domain.size[k]; k == domain.open_axis) {  // at openings it goes on, too
      const int half = static_cast<int>(std::ceil(size / 2 / step[k])) + 1;
      if (at <= -0.5 + rounding * size) before = half, beyond[0] = Beyond::end;
      if (at + length >= size - 0.5 - rounding * size) after = half, beyond[1] = Beyond::end;
    }
    if (wraps) {  // half a period around the domain: the nearest border is no farther
      around.periodic[k] = false;
      before = std::max(1, static_cast<int>(std::ceil((at + 0.5 + period / 2) / step[k])) + 1);
      after = std::max(1, static_cast<int>(std::ceil((period / 2 - at - 0.5) / step[k])) + 1);
    }
    if (period > 0) require_reach(fields, pointer, k, period, at, at + length, unit);
    if (period > 0 && !wraps && length > period - step[k])
      fields.refuse(pointer, std::to_string(samples.size[k]) + (k < 2 ? " pixels" : " pictures") + " along " +
                                 axis_name(k) + " make " + number(length * unit * 1e6) +
                                 " um, where the domain comes again after " + number(period * unit * 1e6) +
                                 " um\nwrite " + (k < 2 ? "\"pixel\": \"" : "\"spacing\": \"") +
                                 number(period * unit / samples.size[k] * 1e6, 12) + " um\", or cut the picture");
    samples = padded(samples, k, before, after, beyond);
    first[k] = at + (0.5 - before) * step[k];
  }
  core::Border<D> border = core::zero_border<D>(samples.values, samples.size);
  if (border.facets.empty()) return everything<D>();
  for (Vec<D>& corner : border.corners) corner = first + corner.cwiseProduct(step);
  border = imaged(std::move(border), around);
  try {
    return std::make_shared<core::FacetedRegion<D>>(std::move(border));
  } catch (const std::invalid_argument& error) {
    fields.refuse(pointer, error.what());
  }
}

template core::RegionPointer<2> closed_region(const scene::SceneFields&, const std::string&, core::Border<2>,
                                              const core::Domain<2>&, double);
template core::RegionPointer<3> closed_region(const scene::SceneFields&, const std::string&, core::Border<3>,
                                              const core::Domain<3>&, double);
template core::RegionPointer<2> picture_region(const scene::SceneFields&, const std::string&,
                                               const scene::WallShape::Image&, const core::Domain<2>&, double);
template core::RegionPointer<3> picture_region(const scene::SceneFields&, const std::string&,
                                               const scene::WallShape::Image&, const core::Domain<3>&, double);

}  // namespace rouleau::shape
