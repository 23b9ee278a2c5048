#include "placed_cells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/contact/cell_grid.hpp"
#include "core/contact/crossing.hpp"
#include "core/contact/wall_gap.hpp"
#include "core/geometry/parts.hpp"
#include "core/membrane/geometry.hpp"
#include "estimate.hpp"
#include "scene/cell_rows.hpp"
#include "shape/crowding.hpp"
#include "shape/extent.hpp"
#include "shape/rest_shapes.hpp"
#include "shape/surface.hpp"

namespace rouleau::plan {

template <int D>
core::Cells<D> without_cells(const scene::Scene& scene, double spacing) {
  core::Cells<D> cells;
  for (const scene::CellType& type : scene.cell_types) shape::add_type(cells, type, spacing);
  return cells;
}
template core::Membranes without_cells<2>(const scene::Scene&, double);
template core::Surfaces without_cells<3>(const scene::Scene&, double);

// Lattice nodes are centres of unit squares and cubes, so the first lies half a spacing from the domain's edges.
void add_placed(core::Membranes& membranes, const scene::CellPlacement& cell, double spacing) {
  core::add_cell(membranes, cell.type, cell.center.x() / spacing - 0.5, cell.center.y() / spacing - 0.5, cell.angle);
}
void add_placed(core::Surfaces& surfaces, const scene::CellPlacement& cell, double spacing) {
  const core::Vec<3> center = (cell.center.in<3>() / spacing).array() - 0.5;
  core::add_cell(surfaces, cell.type, center, shape::rotation_of(cell));
}

bool encloses(const core::Membranes& membranes, int cell, const core::Vec<2>& place) {
  return core::depth_inside(membranes, membranes.cells[cell], place) > 0;
}
bool encloses(const core::Surfaces& surfaces, int cell, const core::Vec<3>& place) {
  return core::encloses(surfaces.type_of(cell).mesh, surfaces.nodes(cell), place);
}

namespace {

/// Room for the scene's cells, and none of them yet.
template <int D>
core::Cells<D> room_for_cells(const scene::Scene& scene, double spacing) {
  core::Cells<D> cells = without_cells<D>(scene, spacing);
  cells.reserve(scene.cells.size(), static_cast<std::size_t>(membrane_nodes(scene)), D);
  return cells;
}

/// Unchecked.
template <int D>
core::Cells<D> all_cells(const scene::Scene& scene, double spacing) {
  require_memory(membrane_memory(scene), "placing the cells");
  core::Cells<D> cells = room_for_cells<D>(scene, spacing);
  for (const scene::CellPlacement& cell : scene.placed()) add_placed(cells, cell, spacing);
  return cells;
}

/// Refuses cells that stick through walls, are longer than a period, or cross each other: outlines themselves, too, and
/// of surfaces those of which one holds a node of the other.
template <int D>
class PlacementChecker {
 public:
  PlacementChecker(const scene::Scene& scene, double spacing)
      : scene_(scene),
        spacing_(spacing),
        domain_(scene::lattice_domain<D>(scene)),
        region_(scene::fluid_region<D>(scene)) {
    if (scene.domain.has_shapes()) pieces_ = core::pieces_outside<D>(*region_, domain_);
  }

  /// `numbers`: which of the scene's cells these are; empty: all of them.
  void check(const core::Cells<D>& cells, std::span<const int> numbers = {}) {
    cells_ = &cells;
    numbers_ = numbers;
    boxes_ = core::boxes_of<D>(cells);
    for (int c = 0; c < cells.cell_count(); ++c) check_fits(c);
    check_apart(cells);
  }

 private:
  [[nodiscard]] const scene::CellPlacement& placement(int cell) const {
    return scene_.cells[numbers_.empty() ? cell : numbers_[cell]];
  }
  [[noreturn]] void refuse(int cell, const std::string& problem) const {
    throw Error(Cause::bad_input, scene_.place(placement(cell).pointer), name(cell) + problem);
  }
  [[nodiscard]] std::string name(int cell) const {
    return "cell " + std::to_string(numbers_.empty() ? cell : numbers_[cell]) + " (" +
           scene::origin_of(placement(cell)) + ")";
  }
  [[nodiscard]] std::string micrometres(double spacings) const { return number(spacings * spacing_ * 1e6, 3) + " um"; }

  void check_fits(int cell) const {
    const core::BoundingBox<D>& box = boxes_[cell];
    for (int k = 0; k < D; ++k) {
      const double length = box.most[k] - box.least[k];
      if (domain_.periodic[k]) {
        if (length < domain_.period(k)) continue;
        refuse(cell, " is " + micrometres(length) + " long along " + scene::axis_names[k] +
                         ", more than the periodic length of the domain, " + micrometres(domain_.period(k)) +
                         "; make the domain longer.");
      }
      const double kept = k == domain_.open_axis ? scene::kept_from_openings : 0;
      const double below = kept - 0.5 - box.least[k], above = box.most[k] - (domain_.size[k] - 0.5 - kept);
      if (below < 0 && above < 0) continue;
      const double by = below < 0 ? above : below;
      if (k == domain_.open_axis)
        refuse(cell, std::string(" is too near the ") + (below < 0 ? "outlet" : "inlet") + " by " + micrometres(by) +
                         ": cells keep " + micrometres(kept) + ", six lattice spacings, from it; move it.");
      refuse(cell, std::string(" sticks through the ") + (below < 0 ? "upper" : "lower") + " wall across " +
                       scene::axis_names[k] + " by " + micrometres(by) + "; move it away from the wall.");
    }
    if (region_) check_within_region(cell);
  }

  void check_within_region(int cell) const {
    const core::NearestToBorder<D> nearest = core::nearest_to_border(*cells_, cells_->cells[cell], *region_);
    if (!(nearest.distance > 0) && scene_.domain.tube_radius) {
      refuse(cell, " sticks through the wall of the tube by " + micrometres(-nearest.distance) +
                       "; move it towards the axis, or make the tube wider.");
    }
    if (!(nearest.distance > 0)) {
      refuse(cell, " sticks through a wall by " + micrometres(-nearest.distance) + " at " + name(nearest.node) +
                       "; move it away from the wall.");
    }
    // None of its nodes needs to be near a wall that it lies around.
    for (const core::Vec<D>& piece : pieces_) {
      core::Vec<D> place = piece;
      for (int k = 0; k < D; ++k) {
        if (!domain_.periodic[k]) continue;
        const double away = 0.5 * (boxes_[cell].least[k] + boxes_[cell].most[k]) - place[k];
        place[k] += domain_.period(k) * std::round(away / domain_.period(k));
      }
      if (encloses(*cells_, cell, place))
        refuse(cell, " lies around a piece of wall at " + name(piece) + "; move it away from the wall.");
    }
  }
  /// A place on the lattice, as scenes write it.
  [[nodiscard]] std::string name(const core::Vec<D>& place) const {
    std::string text;
    for (int k = 0; k < D; ++k) text += (k > 0 ? ", " : "") + number((place[k] + 0.5) * spacing_ * 1e6, 4);
    return "(" + text + ") um";
  }

  void check_apart(const core::Membranes& membranes) const {
    const auto crossing = core::find_crossing(membranes, domain_);
    if (!crossing) return;
    const bool own = crossing->cell == crossing->other, image = crossing->shift != core::ImageShift{};
    if (own && !image) refuse(crossing->cell, " crosses itself; change its shape.");
    const double depth = overlap(membranes, *crossing);
    const std::string amount = depth > 0 ? "overlap by " + micrometres(depth) : "cross";
    if (own) refuse(crossing->cell, " and its own periodic image " + amount + "; make the domain longer.");
    refuse(crossing->cell, std::string(" and ") + (image ? "a periodic image of " : "") + name(crossing->other) + " " +
                               amount + "; move them apart.");
  }
  /// Largest depth of a node of one cell inside the other.
  [[nodiscard]] double overlap(const core::Membranes& membranes, const core::Crossing& crossing) const {
    const core::CellRange& a = membranes.cells[crossing.cell];
    const core::CellRange& b = membranes.cells[crossing.other];
    const core::Vec<2> move = core::moved_by(crossing.shift, domain_);
    const auto node = [&](int i) { return core::Vec<2>(membranes.position[0][i], membranes.position[1][i]); };
    double depth = 0;
    for (int i = a.first; i < a.end(); ++i) depth = std::max(depth, core::depth_inside(membranes, b, node(i) - move));
    for (int i = b.first; i < b.end(); ++i) depth = std::max(depth, core::depth_inside(membranes, a, node(i) + move));
    return depth;
  }

  void check_apart(const core::Surfaces& surfaces) const {
    const core::CellGrid<D> grid(boxes_, 0, domain_);
    std::vector<int> near;
    for (int c = 0; c < surfaces.cell_count(); ++c) {
      grid.find(c, near);
      std::sort(near.begin(), near.end());
      for (const int other : near)
        if (other < c) check_apart(surfaces, c, other);
    }
  }
  /// Of all images of the other cell the one that is nearest lies nearest along each axis.
  void check_apart(const core::Surfaces& surfaces, int cell, int other) const {
    const Eigen::AlignedBox3d own = box_of(cell), of_other = box_of(other);
    core::Vec<3> shift = core::Vec<3>::Zero();
    for (int k = 0; k < D; ++k) {
      if (!domain_.periodic[k]) continue;
      const double apart = own.center()[k] - of_other.center()[k];
      shift[k] = std::round(apart / domain_.period(k)) * domain_.period(k);
    }
    if (!own.intersects(Eigen::AlignedBox3d(of_other.min() + shift, of_other.max() + shift))) return;
    if (!holds_node_of(surfaces, cell, other, shift) && !holds_node_of(surfaces, other, cell, -shift)) return;
    refuse(cell, std::string(" and ") + (shift.isZero() ? "" : "a periodic image of ") + name(other) +
                     " overlap; move them apart.");
  }
  [[nodiscard]] Eigen::AlignedBox3d box_of(int cell) const {
    return {core::Vec<3>(boxes_[cell].least.data()), core::Vec<3>(boxes_[cell].most.data())};
  }
  /// Whether a node of `other`, moved by `shift`, lies inside `cell`.
  [[nodiscard]] bool holds_node_of(const core::Surfaces& surfaces, int cell, int other,
                                   const core::Vec<3>& shift) const {
    const Eigen::AlignedBox3d box = box_of(cell);
    for (int i = 0; i < surfaces.cells[other].count; ++i) {
      const core::Vec<3> place = surfaces.nodes(other)[i] + shift;
      if (box.contains(place) && core::encloses(surfaces.type_of(cell).mesh, surfaces.nodes(cell), place)) return true;
    }
    return false;
  }

  const scene::Scene& scene_;
  double spacing_;
  core::Domain<D> domain_;
  core::RegionPointer<D> region_;     ///< of a tube, or between walls of any shape
  std::vector<core::Vec<D>> pieces_;  ///< a node in each piece of these
  // What is being checked.
  const core::Cells<D>* cells_ = nullptr;
  std::span<const int> numbers_;
  std::vector<core::BoundingBox<D>> boxes_;
};

/// Cells that cover more than the whole domain overlap, and that is known before any of them is placed.
void require_room(const scene::Scene& scene) {
  std::vector<double> enclosed;
  for (const scene::CellType& type : scene.cell_types) enclosed.push_back(shape::enclosed_by(type));
  double covered = 0;
  for (const scene::CellPlacement& cell : scene.placed()) covered += enclosed[cell.type];
  const double there = scene.domain.content();
  if (covered <= there) return;
  const auto measured = [&words = scene.domain.words()](double content) {
    return number(content * words.content_in_unit) + " " + words.content_unit;
  };
  throw Error(Cause::bad_input, scene.place("/cells"),
              "the " + std::to_string(scene.placed().size()) + " cells cover " + measured(covered) +
                  " and so overlap: the domain has " + measured(there),
              {"take fewer cells, or a larger domain"});
}

/// Of many cells that lie on top of each other two are found before memory is asked for all of them.
void require_distance(const scene::Scene& scene) {
  constexpr std::size_t many = 10'000;
  if (scene.cells.size() < many || scene.fed > 0) return;
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
  for (const auto& shape : none.types)
    for (std::size_t i = 0; i < shape->x.size(); ++i) reach = std::max(reach, std::hypot(shape->x[i], shape->y[i]));
  const double period = domain.period(1);
  std::vector<double> height;
  for (const scene::CellPlacement& cell : scene.placed()) {
    const double y = cell.center.y() / spacing;
    height.push_back(period > 0 ? y - std::floor(y / period) * period : y);
  }
  std::vector<int> order(scene.placed().size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(height[a], a) < std::pair(height[b], b); });
  PlacementChecker<2> checker(scene, spacing);
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
    checker.check(membranes, cells);
  }
}

}  // namespace

template <int D>
core::Cells<D> make_cells(const scene::Scene& scene, double spacing) {
  require_room(scene);
  require_distance(scene);
  core::Cells<D> cells = all_cells<D>(scene, spacing);
  PlacementChecker<D>(scene, spacing).check(cells);
  return cells;
}
template core::Membranes make_cells<2>(const scene::Scene&, double);
template core::Surfaces make_cells<3>(const scene::Scene&, double);

template <int D>
void for_each_cell(const scene::Scene& scene, double spacing,
                   const std::function<void(std::size_t, const core::Cells<D>&)>& function) {
  core::Cells<D> cell = without_cells<D>(scene, spacing);
  for (std::size_t c = 0; c < scene.placed().size(); ++c) {
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
core::Cells<D> make_known_cells(const scene::Scene& scene, const std::function<bool(int)>& known) {
  constexpr int at_once = 1 << 16;  // nodes whose memory is given back together
  const double spacing = scene::lattice_spacing(scene);
  core::Cells<D> cells = room_for_cells<D>(scene, spacing);
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
  if (scene.domain.dimension() == 3)
    make_cells<3>(scene);
  else if (scene.placed().size() > of_strip)
    try_in_strips(scene, scene::lattice_spacing(scene), of_strip);
  else
    make_cells<2>(scene);
}

}  // namespace rouleau::plan
