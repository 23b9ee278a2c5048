#include "packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>

#include "center_grid.hpp"
#include "outline.hpp"
#include "rigid_outline.hpp"

namespace rouleau::shape {

namespace {

constexpr std::uint32_t whole_turn = 1U << 20;
constexpr int tries_at_a_size = 30;
constexpr double shrinking = 0.9, fastest_growth = 0.1, smallest_scale = 0.01;
constexpr int fewest_sweeps = 50;
/// A packing has come to a standstill when so many sweeps let the cells grow by less than this part of what they lack.
constexpr int patience = 1000, most_sweeps = 20000;
constexpr double least_progress = 0.05;

/// Uniform numbers with the same bits everywhere: std::uniform_real_distribution is each library's own.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::seed_seq& seeds) : engine_(seeds) {}
  double below_one() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double either_side(double most) { return most * (2 * below_one() - 1); }
  std::uint32_t angle() { return static_cast<std::uint32_t>(engine_() >> 44); }

 private:
  std::mt19937_64 engine_;
};

double region_area(const scene::RandomPacking& packing) {
  return (packing.upper.x() - packing.lower.x()) * (packing.upper.y() - packing.lower.y());
}

double cell_area(const scene::CellType& type) { return area_of(make_outline(type.shape, type.segments)); }

/// Where the cells of one packing may be, and how near to others.
struct Territory {
  Axis x, y;   ///< outlines stay between lower and upper unless periodic
  double gap;  ///< to walls, obstacles and cells of the same packing; allowances included
};

class Packer {
 public:
  Packer(const scene::Domain& domain, const std::vector<scene::CellType>& types,
         const std::vector<scene::RandomPacking>& packings, std::vector<scene::CellPlacement>& cells, double unit)
      : packings_(packings), cells_(cells), unit_(unit), numbers_(make_numbers(packings)) {
    box_x_ = {0, domain.size.x() / unit, true};
    box_y_ = {0, domain.size.y() / unit, domain.periodic_y};
    for (const scene::CellPlacement& cell : cells) {
      const scene::CellType& type = types[cell.type];
      const auto [outline, is_new] = outlines_.try_emplace(cell.type, type.shape, type.segments, unit);
      if (!is_new) continue;
      allowance_ = std::max(allowance_, outline->second.allowance());
      largest_ = std::max(largest_, outline->second.radius());
    }
    double gap = 0;
    for (const scene::RandomPacking& packing : packings) {
      territories_.push_back(territory(packing));
      gap = std::max(gap, territories_.back().gap);
    }
    grid_.emplace(box_x_, box_y_, 2 * largest_ + gap);
    owner_.assign(cells.size(), obstacle);
    for (std::size_t k = 0; k < packings.size(); ++k) {
      for (int i = 0; i < packings[k].count; ++i) owner_[packings[k].first + i] = static_cast<int>(k);
    }
    bodies_.resize(cells.size());
    angle_.assign(cells.size(), 0);
  }

  std::optional<PackingShortfall> pack() {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (owner_[i] == obstacle) set_obstacle(i);
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (owner_[i] != obstacle && !insert(i)) return shortfall(i);
    }
    if (const auto stuck = grow()) return shortfall(*stuck);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (owner_[i] == obstacle) continue;
      cells_[i].center = {bodies_[i].center.x * unit_, bodies_[i].center.y * unit_};
      cells_[i].angle = angle_[i] * (2 * std::numbers::pi / whole_turn);
    }
    return std::nullopt;
  }

 private:
  static constexpr int obstacle = -1;

  static RandomNumbers make_numbers(const std::vector<scene::RandomPacking>& packings) {
    std::vector<std::uint32_t> seeds;
    seeds.reserve(packings.size());
    for (const scene::RandomPacking& packing : packings) seeds.push_back(packing.seed);
    std::seed_seq sequence(seeds.begin(), seeds.end());
    return RandomNumbers(sequence);
  }

  [[nodiscard]] Territory territory(const scene::RandomPacking& packing) const {
    const double gap = packing.gap / unit_ + allowance_;
    const auto axis = [&](double lower, double upper, const Axis& box) {
      const bool whole = lower <= 0 && upper / unit_ >= box.upper;
      if (whole && box.periodic) return box;
      // A wall is kept from; the border of a region in the fluid is not.
      Axis own{lower / unit_, upper / unit_, false};
      if (!box.periodic) own = {std::max(own.lower, gap), std::min(own.upper, box.upper - gap), false};
      return own;
    };
    return {axis(packing.lower.x(), packing.upper.x(), box_x_), axis(packing.lower.y(), packing.upper.y(), box_y_),
            gap};
  }

  void set_obstacle(std::size_t i) {
    const scene::CellPlacement& cell = cells_[i];
    bodies_[i] = {&outlines_.at(cell.type),
                  {box_x_.wrapped(cell.center.x() / unit_), box_y_.wrapped(cell.center.y() / unit_)},
                  direction_of(cell.angle),
                  1};
    grid_->add(i, bodies_[i].center);
  }

  /// Draws places for a new cell, smaller and smaller, until one is free.
  bool insert(std::size_t i) {
    const Territory& own = territories_[owner_[i]];
    RigidBody body{&outlines_.at(cells_[i].type), {}, {}, 1};
    for (; body.scale > smallest_scale; body.scale *= shrinking) {
      for (int trial = 0; trial < tries_at_a_size; ++trial) {
        body.center = {own.x.lower + own.x.length() * numbers_.below_one(),
                       own.y.lower + own.y.length() * numbers_.below_one()};
        angle_[i] = numbers_.angle();
        body.direction = direction_of(angle_[i] * (2 * std::numbers::pi / whole_turn));
        if (!is_free(i, body)) continue;
        bodies_[i] = body;
        grid_->add(i, body.center);
        return true;
      }
    }
    return false;
  }

  /// Moves and lets grow until every cell has its size; else a cell that has not.
  std::optional<std::size_t> grow() {
    int sweeps = 0;
    double last = grown();
    while (smallest() < 1) {
      sweep();
      if (++sweeps % patience != 0) continue;
      const double now = grown();
      if (now - last < least_progress * (wanted() - last) || sweeps >= most_sweeps) return smallest_cell();
      last = now;
    }
    for (int left = std::max(sweeps, fewest_sweeps); sweeps > 0 && left > 0; --left) sweep();
    return std::nullopt;
  }

  void sweep() {
    int moved = 0, tried = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (owner_[i] == obstacle) continue;
      ++tried;
      if (move(i)) ++moved;
      RigidBody& body = bodies_[i];
      if (body.scale < 1) {
        RigidBody larger = body;
        larger.scale = std::min(1.0, body.scale * (1 + fastest_growth * numbers_.below_one()));
        if (is_free(i, larger)) body.scale = larger.scale;
      }
    }
    // About two of five moves ought to succeed.
    stride_ = std::clamp(5 * moved > 2 * tried ? 1.05 * stride_ : stride_ / 1.05, 1e-4 * largest_, 2 * largest_);
  }

  bool move(std::size_t i) {
    const Territory& own = territories_[owner_[i]];
    RigidBody body = bodies_[i];
    body.center = {own.x.wrapped(body.center.x + numbers_.either_side(stride_)),
                   own.y.wrapped(body.center.y + numbers_.either_side(stride_))};
    const double turn = numbers_.either_side(std::min(0.5, stride_ / largest_ / (2 * std::numbers::pi)));
    const auto angle =
        static_cast<std::uint32_t>(angle_[i] + static_cast<std::int64_t>(turn * whole_turn)) % whole_turn;
    body.direction = direction_of(angle * (2 * std::numbers::pi / whole_turn));
    if (!is_free(i, body)) return false;
    grid_->remove(i, bodies_[i].center);
    bodies_[i] = body;
    angle_[i] = angle;
    grid_->add(i, body.center);
    return true;
  }

  [[nodiscard]] bool is_free(std::size_t i, const RigidBody& body) const {
    const Territory& own = territories_[owner_[i]];
    if (!within(body, own)) return false;
    if (!images_keep_apart(body, body, true, own.gap)) return false;
    return grid_->all_near(body.center, [&](std::size_t j) {
      if (j == i) return true;
      double gap = own.gap;
      if (owner_[j] != obstacle) gap = std::max(gap, territories_[owner_[j]].gap);
      return images_keep_apart(body, bodies_[j], false, gap);
    });
  }

  [[nodiscard]] bool images_keep_apart(const RigidBody& a, const RigidBody& b, bool itself, double gap) const {
    const double reach = a.radius() + b.radius() + gap;
    const auto images = [&](double distance, const Axis& axis) -> std::array<int, 2> {
      if (!axis.periodic) return {0, 0};
      return {static_cast<int>(std::ceil((-reach - distance) / axis.length())),
              static_cast<int>(std::floor((reach - distance) / axis.length()))};
    };
    const auto [x_first, x_last] = images(b.center.x - a.center.x, box_x_);
    const auto [y_first, y_last] = images(b.center.y - a.center.y, box_y_);
    for (int y = y_first; y <= y_last; ++y) {
      for (int x = x_first; x <= x_last; ++x) {
        if (itself && x == 0 && y == 0) continue;
        if (!keep_apart(a, b, {x * box_x_.length(), y * box_y_.length()}, gap)) return false;
      }
    }
    return true;
  }

  static bool within(const RigidBody& body, const Territory& own) {
    const double radius = body.radius();
    const auto surely = [&](double center, const Axis& axis) {
      return axis.periodic || (center - radius >= axis.lower && center + radius <= axis.upper);
    };
    const auto between = [](double value, const Axis& axis) {
      return axis.periodic || (value >= axis.lower && value <= axis.upper);
    };
    if (surely(body.center.x, own.x) && surely(body.center.y, own.y)) return true;
    return std::all_of(body.outline->nodes().begin(), body.outline->nodes().end(), [&](Pair node) {
      const double c = body.direction.x, s = body.direction.y;
      return between(body.center.x + body.scale * (c * node.x - s * node.y), own.x) &&
             between(body.center.y + body.scale * (s * node.x + c * node.y), own.y);
    });
  }

  [[nodiscard]] std::size_t smallest_cell() const {
    std::size_t least = bodies_.size();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (owner_[i] != obstacle && (least == bodies_.size() || bodies_[i].scale < bodies_[least].scale)) least = i;
    }
    return least;
  }
  [[nodiscard]] double smallest() const { return bodies_[smallest_cell()].scale; }
  /// Area of the cells as they are, and as they shall be.
  [[nodiscard]] double grown() const {
    double area = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (owner_[i] != obstacle) area += bodies_[i].scale * bodies_[i].scale * bodies_[i].outline->area();
    }
    return area;
  }
  [[nodiscard]] double wanted() const {
    double area = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (owner_[i] != obstacle) area += bodies_[i].outline->area();
    }
    return area;
  }

  [[nodiscard]] PackingShortfall shortfall(std::size_t cell) const {
    const auto index = static_cast<std::size_t>(owner_[cell]);
    double area = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (owner_[i] != owner_[cell] || bodies_[i].outline == nullptr) continue;
      area += bodies_[i].scale * bodies_[i].scale * bodies_[i].outline->area();
    }
    return {index, area * unit_ * unit_ / region_area(packings_[index])};
  }

  const std::vector<scene::RandomPacking>& packings_;
  std::vector<scene::CellPlacement>& cells_;
  double unit_;  ///< m; all lengths below are multiples of it
  RandomNumbers numbers_;
  Axis box_x_, box_y_;
  std::map<int, RigidOutline> outlines_;  ///< by type, of those that have cells
  double allowance_ = 0, largest_ = 0;
  std::vector<Territory> territories_;  ///< by packing
  std::optional<CenterGrid> grid_;
  std::vector<int> owner_;  ///< of each cell: its packing, or `obstacle`
  std::vector<RigidBody> bodies_;
  std::vector<std::uint32_t> angle_;  ///< in parts of a whole turn
  double stride_ = 0.3;               ///< largest move along each axis
};

}  // namespace

double cells_for(double hematocrit, const scene::CellType& type, const scene::RandomPacking& packing) {
  return std::round(hematocrit * region_area(packing) / cell_area(type));
}

double hematocrit_of(const scene::RandomPacking& packing, const scene::CellType& type) {
  return packing.count * cell_area(type) / region_area(packing);
}

std::optional<PackingShortfall> pack(const scene::Domain& domain, const std::vector<scene::CellType>& types,
                                     const std::vector<scene::RandomPacking>& packings,
                                     std::vector<scene::CellPlacement>& cells) {
  if (packings.empty()) return std::nullopt;
  // Of the types that have cells: one that has none may be so large that rounding would deform the others.
  double unit = 0;
  for (const scene::CellPlacement& cell : cells) {
    unit = std::max(unit, shape_radius(types[cell.type].shape));
  }
  return Packer(domain, types, packings, cells, unit).pack();
}

}  // namespace rouleau::shape
