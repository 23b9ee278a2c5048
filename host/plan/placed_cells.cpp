#include "placed_cells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/contact/cell_grid.hpp"
#include "core/contact/crossing.hpp"
#include "core/membrane/geometry.hpp"
#include "estimate.hpp"
#include "scene/cell_table.hpp"
#include "shape/crowding.hpp"
#include "shape/extent.hpp"
#include "shape/outline.hpp"
#include "shape/surface.hpp"

namespace rouleau::plan {
namespace {

core::RestShape rest_shape(const scene::CellType& type, double spacing) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& node : shape::make_outline(type.shape, type.segments).nodes) {
    x.push_back(node.x() / spacing);
    y.push_back(node.y() / spacing);
  }
  const auto* circle = std::get_if<scene::Circle>(&type.shape);
  return core::make_rest_shape(std::move(x), std::move(y), circle != nullptr ? circle->prestretch : 1.0);
}

core::RestSurface rest_surface(const scene::CellType& type, double spacing) {
  shape::TriangleSurface surface = shape::make_surface(type);
  for (core::Vec<3>& node : surface.nodes) node /= spacing;
  const auto* sphere = std::get_if<scene::Sphere>(&type.shape);
  return shape::rest_surface(surface, sphere != nullptr ? sphere->prestretch : 1.0);
}

/// The cell types of a scene on a lattice of this spacing, and no cell yet.
template <int D>
Cells<D> without_cells(const scene::Scene& scene, double spacing) {
  Cells<D> cells;
  for (const scene::CellType& type : scene.cell_types) {
    if constexpr (D == 2) cells.types.push_back(std::make_shared<const core::RestShape>(rest_shape(type, spacing)));
    if constexpr (D == 3) cells.types.push_back(std::make_shared<const core::RestSurface>(rest_surface(type, spacing)));
  }
  return cells;
}

// Lattice nodes are centres of unit squares and cubes, so the first lies half a spacing from the domain's edges.
void add_placed(core::Membranes& membranes, const scene::CellPlacement& cell, double spacing) {
  core::add_cell(membranes, cell.type, cell.center.x() / spacing - 0.5, cell.center.y() / spacing - 0.5, cell.angle);
}
void add_placed(core::Surfaces& surfaces, const scene::CellPlacement& cell, double spacing) {
  const core::Vec<3> center = (cell.center.in<3>() / spacing).array() - 0.5;
  core::add_cell(surfaces, cell.type, center, shape::rotation_of(cell));
}

/// Room for the scene's cells, and none of them yet.
template <int D>
Cells<D> room_for_cells(const scene::Scene& scene, double spacing) {
  Cells<D> cells = without_cells<D>(scene, spacing);
  cells.reserve(scene.cells.size(), static_cast<std::size_t>(membrane_nodes(scene)), D);
  return cells;
}

/// Unchecked.
template <int D>
Cells<D> all_cells(const scene::Scene& scene, double spacing) {
  require_memory(membrane_memory(scene), "placing the cells");
  Cells<D> cells = room_for_cells<D>(scene, spacing);
  for (const scene::CellPlacement& cell : scene.cells) add_placed(cells, cell, spacing);
  return cells;
}

/// Refuses outlines that stick through walls, are longer than a period, or cross themselves or each other.
class OutlineChecker {
 public:
  /// `cells`: which of the scene's cells the membranes are; empty: all of them.
  OutlineChecker(const scene::Scene& scene, const core::Membranes& membranes, double spacing,
                 std::span<const int> cells = {})
      : scene_(scene), membranes_(membranes), spacing_(spacing), cells_(cells), domain_(scene::lattice_domain(scene)) {}

  void check() const {
    for (std::size_t i = 0; i < membranes_.cells.size(); ++i) check_fits(i);
    if (const auto crossing = core::find_crossing(membranes_, domain_)) report(*crossing);
  }

 private:
  [[noreturn]] void refuse(std::size_t cell, const std::string& problem) const {
    const std::string& pointer = placement(cell).pointer;
    const Place place = scene_.document ? scene_.place(pointer) : Place{"", pointer};
    throw Error(Cause::bad_input, place, problem);
  }
  [[nodiscard]] std::string micrometres(double spacings) const {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g um", spacings * spacing_ * 1e6);
    return text;
  }
  [[nodiscard]] int number_of(std::size_t cell) const { return cells_.empty() ? static_cast<int>(cell) : cells_[cell]; }
  [[nodiscard]] const scene::CellPlacement& placement(std::size_t cell) const { return scene_.cells[number_of(cell)]; }
  [[nodiscard]] std::string name(std::size_t cell) const {
    return "cell " + std::to_string(number_of(cell)) + " (" + scene::origin_of(placement(cell)) + ")";
  }

  void check_fits(std::size_t cell) const {
    const core::BoundingBox<2> extent = core::box_of<2>(membranes_, membranes_.cells[cell]);
    const auto who = [&] { return name(cell); };
    const double width = extent.most[0] - extent.least[0], height = extent.most[1] - extent.least[1];
    if (!(width < domain_.period(0))) {
      refuse(cell, who() + " is " + micrometres(width) + " wide, more than the periodic length of the domain, " +
                       micrometres(domain_.period(0)) + "; make the domain longer.");
    }
    if (domain_.periodic[1]) {
      if (!(height < domain_.period(1))) {
        refuse(cell, who() + " is " + micrometres(height) + " high, more than the periodic height of the domain, " +
                         micrometres(domain_.period(1)) + "; make the domain higher.");
      }
      return;
    }
    const double below = -0.5 - extent.least[1], above = extent.most[1] - (scene_.domain.nodes[1] - 0.5);
    if (!(below < 0)) stick_out(cell, "lower", below);
    if (!(above < 0)) stick_out(cell, "upper", above);
  }
  [[noreturn]] void stick_out(std::size_t cell, const char* wall, double amount) const {
    refuse(cell, name(cell) + " sticks through the " + wall + " wall by " + micrometres(amount) +
                     "; move it away from the wall.");
  }

  [[noreturn]] void report(const core::Crossing& crossing) const {
    const auto cell = static_cast<std::size_t>(crossing.cell);
    const bool own = crossing.cell == crossing.other;
    if (own && crossing.shift == core::ImageShift{})
      refuse(cell, name(crossing.cell) + " crosses itself; change its shape.");
    const double depth = overlap(crossing);
    const std::string amount = depth > 0 ? "overlap by " + micrometres(depth) : "cross";
    if (own) {
      refuse(cell, name(crossing.cell) + " and its own periodic image " + amount + "; make the domain longer.");
    }
    const bool image = !(crossing.shift == core::ImageShift{});
    refuse(cell, name(crossing.cell) + " and " + (image ? "a periodic image of " : "") + name(crossing.other) + " " +
                     amount + "; move them apart.");
  }
  /// Largest depth of a node of one cell inside the other.
  [[nodiscard]] double overlap(const core::Crossing& crossing) const {
    const core::CellRange& a = membranes_.cells[crossing.cell];
    const core::CellRange& b = membranes_.cells[crossing.other];
    const Eigen::Vector2d move(crossing.shift.x * domain_.period(0), crossing.shift.y * domain_.period(1));
    double depth = 0;
    for (int i = a.first; i < a.end(); ++i) depth = std::max(depth, core::depth_inside(membranes_, b, node(i) - move));
    for (int i = b.first; i < b.end(); ++i) depth = std::max(depth, core::depth_inside(membranes_, a, node(i) + move));
    return depth;
  }
  [[nodiscard]] Eigen::Vector2d node(int i) const { return {membranes_.position[0][i], membranes_.position[1][i]}; }

  const scene::Scene& scene_;
  const core::Membranes& membranes_;
  double spacing_;
  std::span<const int> cells_;
  core::Domain<2> domain_;
};

/// Refuses surfaces that stick through walls, are longer than a period, or overlap.
class SurfaceChecker {
 public:
  SurfaceChecker(const scene::Scene& scene, const core::Surfaces& surfaces, double spacing)
      : scene_(scene), surfaces_(surfaces), spacing_(spacing), domain_(scene::lattice_domain<3>(scene)) {
    for (int c = 0; c < surfaces.cell_count(); ++c) {
      Eigen::AlignedBox3d& box = boxes_.emplace_back();
      for (int i = 0; i < surfaces.cells[c].count; ++i) box.extend(surfaces.nodes(c)[i]);
    }
  }

  void check() const {
    for (int c = 0; c < surfaces_.cell_count(); ++c) check_fits(c);
    std::vector<core::BoundingBox<3>> boxes;
    boxes.reserve(surfaces_.cells.size());
    for (const Eigen::AlignedBox3d& box : boxes_)
      boxes.push_back({{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}});
    const core::CellGrid<3> grid(boxes, 0, domain_);
    std::vector<int> near;
    for (int c = 0; c < surfaces_.cell_count(); ++c) {
      grid.find(c, near);
      std::sort(near.begin(), near.end());
      for (const int other : near) {
        if (other < c) check_apart(c, other);
      }
    }
  }

 private:
  static constexpr std::array axes{"x", "y", "z"};

  [[noreturn]] void refuse(int cell, const std::string& problem) const {
    throw Error(Cause::bad_input, scene_.place(scene_.cells[cell].pointer), problem);
  }
  [[nodiscard]] std::string name(int cell) const {
    return "cell " + std::to_string(cell) + " (" + scene::origin_of(scene_.cells[cell]) + ")";
  }
  [[nodiscard]] std::string micrometres(double spacings) const { return number(spacings * spacing_ * 1e6, 3) + " um"; }

  void check_fits(int cell) const {
    for (int k = 0; k < 3; ++k) {
      const double length = boxes_[cell].sizes()[k];
      if (domain_.periodic[k]) {
        if (length < domain_.period(k)) continue;
        refuse(cell, name(cell) + " is " + micrometres(length) + " long along " + axes[k] +
                         ", more than the periodic length of the domain, " + micrometres(domain_.period(k)) +
                         "; make the domain longer.");
      }
      const double beyond = std::max(-0.5 - boxes_[cell].min()[k], boxes_[cell].max()[k] - (domain_.size[k] - 0.5));
      if (beyond < 0) continue;
      refuse(cell, name(cell) + " sticks through a wall across " + axes[k] + " by " + micrometres(beyond) +
                       "; move it away from the wall.");
    }
    if (!scene_.domain.tube_radius) return;
    const double beyond = core::farthest_from_axis(surfaces_, cell, domain_) - *scene_.domain.tube_radius / spacing_;
    if (beyond < 0) return;
    refuse(cell, name(cell) + " sticks through the wall of the tube by " + micrometres(beyond) +
                     "; move it towards the axis, or make the tube wider.");
  }

  /// Of all images of the other cell the one that is nearest lies nearest along each axis.
  void check_apart(int cell, int other) const {
    core::Vec<3> shift = core::Vec<3>::Zero();
    for (int k = 0; k < 3; ++k) {
      if (!domain_.periodic[k]) continue;
      const double apart = boxes_[cell].center()[k] - boxes_[other].center()[k];
      shift[k] = std::round(apart / domain_.period(k)) * domain_.period(k);
    }
    const Eigen::AlignedBox3d moved(boxes_[other].min() + shift, boxes_[other].max() + shift);
    if (!boxes_[cell].intersects(moved)) return;
    if (!holds_node_of(cell, other, shift) && !holds_node_of(other, cell, -shift)) return;
    refuse(cell, name(cell) + " and " + (shift.isZero() ? "" : "a periodic image of ") + name(other) +
                     " overlap; move them apart.");
  }
  /// Whether a node of `other`, moved by `shift`, lies inside `cell`.
  [[nodiscard]] bool holds_node_of(int cell, int other, const core::Vec<3>& shift) const {
    for (int i = 0; i < surfaces_.cells[other].count; ++i) {
      const core::Vec<3> place = surfaces_.nodes(other)[i] + shift;
      if (boxes_[cell].contains(place) && core::encloses(surfaces_.type_of(cell).mesh, surfaces_.nodes(cell), place))
        return true;
    }
    return false;
  }

  const scene::Scene& scene_;
  const core::Surfaces& surfaces_;
  double spacing_;
  core::Domain<3> domain_;
  std::vector<Eigen::AlignedBox3d> boxes_;
};

/// Cells that cover more than the whole domain overlap, and that is known before any of them is placed.
void require_room(const scene::Scene& scene) {
  std::vector<double> enclosed;
  for (const scene::CellType& type : scene.cell_types) enclosed.push_back(shape::enclosed_by(type));
  double covered = 0;
  for (const scene::CellPlacement& cell : scene.cells) covered += enclosed[cell.type];
  const double there = scene.domain.content();
  if (covered <= there) return;
  const auto measured = [&words = scene.domain.words()](double content) {
    return number(content * words.content_in_unit) + " " + words.content_unit;
  };
  throw Error(Cause::bad_input, scene.place("/cells"),
              "the " + std::to_string(scene.cells.size()) + " cells cover " + measured(covered) +
                  " and so overlap: the domain has " + measured(there),
              {"take fewer cells, or a larger domain"});
}

/// Of many cells that lie on top of each other two are found before memory is asked for all of them.
void require_distance(const scene::Scene& scene) {
  constexpr std::size_t many = 10'000;
  if (scene.cells.size() < many) return;
  const auto pair = shape::find_crowded_pair(scene);
  if (!pair) return;
  const auto name = [&](int cell) {
    return "cell " + std::to_string(cell) + " (" + scene::origin_of(scene.cells[cell]) + ")";
  };
  throw Error(Cause::bad_input, scene.place(scene.cells[pair->cell].pointer),
              name(pair->cell) + " and " + name(pair->other) + " overlap: their centres are " +
                  number(pair->distance * 1e6, 3) + " um apart; move them apart.");
}

/// Places many cells strip by strip, so that memory need not hold all of them: each strip has so many, and those that
/// reach into it from above.
void try_in_strips(const scene::Scene& scene, double spacing, std::size_t of_strip) {
  require_room(scene);
  require_distance(scene);
  const core::Domain<2> domain = scene::lattice_domain(scene);
  const core::Membranes none = without_cells<2>(scene, spacing);
  double reach = 0;  // of any outline from its centre, spacings
  for (const auto& shape : none.types) {
    for (std::size_t i = 0; i < shape->x.size(); ++i) reach = std::max(reach, std::hypot(shape->x[i], shape->y[i]));
  }
  const double period = domain.period(1);
  std::vector<double> height;
  for (const scene::CellPlacement& cell : scene.cells) {
    const double y = cell.center.y() / spacing;
    height.push_back(period > 0 ? y - std::floor(y / period) * period : y);
  }
  std::vector<int> order(scene.cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(height[a], a) < std::pair(height[b], b); });
  for (std::size_t first = 0; first < order.size(); first += of_strip) {
    const std::size_t end = std::min(first + of_strip, order.size());
    const double top = height[order[end - 1]] + 2 * reach;
    std::vector<int> cells(order.begin() + static_cast<std::ptrdiff_t>(first),
                           order.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t i = end; i < order.size() && height[order[i]] <= top; ++i) cells.push_back(order[i]);
    for (std::size_t i = 0; period > 0 && i < first && height[order[i]] + period <= top; ++i) cells.push_back(order[i]);
    std::sort(cells.begin(), cells.end());
    core::Membranes membranes = none;
    for (const int c : cells) add_placed(membranes, scene.cells[c], spacing);
    OutlineChecker(scene, membranes, spacing, cells).check();
  }
}

}  // namespace

core::Membranes make_membranes(const scene::Scene& scene, double spacing) {
  require_room(scene);
  require_distance(scene);
  core::Membranes membranes = all_cells<2>(scene, spacing);
  OutlineChecker(scene, membranes, spacing).check();
  return membranes;
}

core::Surfaces make_surfaces(const scene::Scene& scene, double spacing) {
  require_room(scene);
  core::Surfaces surfaces = all_cells<3>(scene, spacing);
  SurfaceChecker(scene, surfaces, spacing).check();
  return surfaces;
}

template <int D>
void for_each_cell(const scene::Scene& scene, double spacing,
                   const std::function<void(std::size_t, const Cells<D>&)>& function) {
  Cells<D> cell = without_cells<D>(scene, spacing);
  for (std::size_t c = 0; c < scene.cells.size(); ++c) {
    add_placed(cell, scene.cells[c], spacing);
    function(c, cell);
    cell.remove_cells();
  }
}
template void for_each_cell<2>(const scene::Scene&, double,
                               const std::function<void(std::size_t, const core::Membranes&)>&);
template void for_each_cell<3>(const scene::Scene&, double,
                               const std::function<void(std::size_t, const core::Surfaces&)>&);

template <int D>
Cells<D> make_known_cells(const scene::Scene& scene, const std::function<bool(int)>& known) {
  constexpr int at_once = 1 << 16;  // nodes whose memory is given back together
  const double spacing = scene::lattice_spacing(scene);
  Cells<D> cells = room_for_cells<D>(scene, spacing);
  std::vector<Range> unknown;
  int nodes = 0;
  for (std::size_t c = 0; c < scene.cells.size(); ++c) {
    add_placed(cells, scene.cells[c], spacing);
    if (known(static_cast<int>(c))) continue;
    const core::CellRange& cell = cells.cells.back();
    if (unknown.empty() || unknown.back().end != cell.first) unknown.push_back({cell.first, cell.first});
    unknown.back().end = cell.end();
    if ((nodes += cell.count) < at_once) continue;
    cells.forget(unknown);
    unknown.clear(), nodes = 0;
  }
  return cells;
}
template core::Membranes make_known_cells<2>(const scene::Scene&, const std::function<bool(int)>&);
template core::Surfaces make_known_cells<3>(const scene::Scene&, const std::function<bool(int)>&);

void try_cells(const scene::Scene& scene, std::size_t of_strip) {
  if (scene.domain.dimension() == 3) {
    make_cells<3>(scene);
  } else if (scene.cells.size() > of_strip) {
    try_in_strips(scene, scene::lattice_spacing(scene), of_strip);
  } else {
    make_cells<2>(scene);
  }
}

}  // namespace rouleau::plan
