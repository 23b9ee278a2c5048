#include "packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "center_grid.hpp"
#include "core/geometry/formulas.hpp"
#include "core/geometry/parts.hpp"
#include "extent.hpp"
#include "rigid_outline.hpp"
#include "rigid_surface.hpp"
#include "scene/lattice.hpp"
#include "walls.hpp"

namespace rouleau::shape {

namespace {

constexpr int tries_at_a_size = 30;
constexpr double shrinking = 0.9, fastest_growth = 0.1, smallest_scale = 0.01;
constexpr int fewest_sweeps = 50;
/// A packing has come to a standstill when so many sweeps let the cells grow by less than this part of what they lack.
constexpr int patience = 1000, most_sweeps = 20000;
constexpr double least_progress = 0.05;

/// Draws of a place that lies in the fluid between walls of any shape.
constexpr int most_draws = 10000;

/// In a tube a region is a piece of it.
double region_content(const scene::RandomPacking& packing, const scene::Domain& domain) {
  const scene::Vector size = packing.upper - packing.lower;
  if (domain.tube_radius) return domain.content() * size.x() / domain.size.x();
  if (!domain.has_shapes()) return size.product();
  if (size.product() >= domain.size.product()) return domain.content();
  return scene::in_dimension(domain.dimension(), [&]<int D>(std::integral_constant<int, D>) {
    const core::Vec<D> middle = (packing.lower + packing.upper).in<D>() / 2, half = size.in<D>() / 2;
    return core::content_of<D>(*domain.region<D>(), middle, half, content_halvings);
  });
}

/// The inside of a tube through the middle of a box; there are tubes in three dimensions alone.
core::RegionPointer<2> inside_tube(const std::array<Axis, 2>& /*box*/, double /*radius*/) { return {}; }
core::RegionPointer<3> inside_tube(const std::array<Axis, 3>& box, double radius) {
  const core::Vec<2> axis(0.5 * box[1].upper, 0.5 * box[2].upper);
  return core::extruded(core::ball_region<2>(axis, radius), 0, -INFINITY, INFINITY);
}

/// Where the cells of one packing may be, and how near to others.
template <int D>
struct Territory {
  std::array<Axis, D> axes;  ///< nodes stay between lower and upper unless periodic
  double gap;                ///< to walls, obstacles and cells of the same packing; allowances included
  double from_walls;         ///< likewise, of nodes to walls of a tube or of any shape: what lies between them, too
};

/// Solid: RigidOutline or RigidSurface.
template <class Solid>
class Packer {
  static constexpr int D = Solid::dimension;
  using Body = RigidBody<Solid>;

 public:
  Packer(const scene::Domain& domain, const std::vector<scene::CellType>& types,
         const std::vector<scene::RandomPacking>& packings, std::vector<scene::CellPlacement>& cells, double unit)
      : domain_(domain), packings_(packings), cells_(cells), unit_(unit), numbers_(make_numbers(packings)) {
    for (int k = 0; k < D; ++k) box_[k] = {0, domain.size[k] / unit, domain.periodic[k]};
    if (domain.is_open()) {
      const double kept = scene::kept_from_openings * domain.size.x() / domain.nodes[0] / unit;
      box_[domain.open_axis] = {kept, domain.size[domain.open_axis] / unit - kept, false};
    }
    double least_gap = packings.front().gap;
    for (const scene::RandomPacking& packing : packings) least_gap = std::min(least_gap, packing.gap);
    for (const scene::CellPlacement& cell : cells) {
      const auto [solid, is_new] = solids_.try_emplace(cell.type, types[cell.type], unit, least_gap / unit);
      if (!is_new) continue;
      allowance_ = std::max(allowance_, solid->second.allowance());
      largest_ = std::max(largest_, solid->second.radius());
    }
    if (domain.has_shapes()) {
      region_ = core::magnified<D>(domain.region<D>(), 1 / unit, core::Vec<D>::Zero());
      find_pieces();
    }
    if (domain.tube_radius) region_ = inside_tube(box_, *domain.tube_radius / unit);
    double gap = 0;
    for (const scene::RandomPacking& packing : packings) {
      territories_.push_back(territory(packing));
      gap = std::max(gap, territories_.back().gap);
    }
    grid_.emplace(box_, 2 * largest_ + gap);
    owner_.assign(cells.size(), obstacle);
    for (std::size_t k = 0; k < packings.size(); ++k)
      for (int i = 0; i < packings[k].count; ++i) owner_[packings[k].first + i] = static_cast<int>(k);
    bodies_.resize(cells.size());
  }

  std::optional<PackingShortfall> pack(const PackingWatch& watch) {
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (owner_[i] == obstacle) set_obstacle(i);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (owner_[i] != obstacle && !insert(i)) return shortfall(i);
    if (const auto stuck = grow(watch)) return shortfall(*stuck);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (owner_[i] == obstacle) continue;
      for (int k = 0; k < D; ++k) cells_[i].center[k] = bodies_[i].center[k] * unit_;
      Solid::put(bodies_[i].orientation, cells_[i]);
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

  /// As the lattice has them.
  void find_pieces() {
    std::array<int, D> nodes;
    std::array<bool, D> periodic;
    std::copy_n(domain_.nodes.begin(), D, nodes.begin());
    std::copy_n(domain_.periodic.begin(), D, periodic.begin());
    const double spacing = domain_.size.x() / domain_.nodes[0];
    const auto region = core::magnified<D>(domain_.region<D>(), 1 / spacing, core::Vec<D>::Constant(-0.5));
    for (const core::Vec<D>& node : core::pieces_outside<D>(*region, {nodes, periodic})) {
      Place<D>& piece = pieces_.emplace_back();
      for (int k = 0; k < D; ++k) piece[k] = (node[k] + 0.5) * spacing / unit_;
    }
  }

  [[nodiscard]] Territory<D> territory(const scene::RandomPacking& packing) const {
    const double gap = packing.gap / unit_ + allowance_;
    const auto axis = [&](double lower, double upper, const Axis& box) {
      const bool whole = lower <= 0 && upper / unit_ >= box.upper;
      if (whole && box.periodic) return box;
      // A wall is kept from; the border of a region in the fluid is not.
      Axis own{lower / unit_, upper / unit_, false};
      if (!box.periodic) own = {std::max(own.lower, gap), std::min(own.upper, box.upper - gap), false};
      return own;
    };
    Territory<D> own{{}, gap, gap};
    for (const auto& [type, solid] : solids_)
      own.from_walls = std::max(own.from_walls, gap + solid.between_samples(packing.gap / unit_));
    for (int k = 0; k < D; ++k) own.axes[k] = axis(packing.lower[k], packing.upper[k], box_[k]);
    return own;
  }

  void set_obstacle(std::size_t i) {
    const scene::CellPlacement& cell = cells_[i];
    Body& body = bodies_[i];
    body = {&solids_.at(cell.type), {}, Solid::of(cell), 1};
    for (int k = 0; k < D; ++k) body.center[k] = box_[k].wrapped(cell.center[k] / unit_);
    grid_->add(i, body.center);
  }

  void draw_center(Body& body, const Territory<D>& own) {
    for (int draw = 0; draw < most_draws; ++draw) {
      for (int k = 0; k < D; ++k) body.center[k] = own.axes[k].lower + own.axes[k].length() * numbers_.below_one();
      if (!domain_.has_shapes() || from_walls(body.center) > 0) return;
    }
  }

  /// Draws places for a new cell, smaller and smaller, until one is free.
  bool insert(std::size_t i) {
    const Territory<D>& own = territories_[owner_[i]];
    Body body{&solids_.at(cells_[i].type), {}, {}, 1};
    for (; body.scale > smallest_scale; body.scale *= shrinking) {
      for (int trial = 0; trial < tries_at_a_size; ++trial) {
        draw_center(body, own);
        body.orientation = Solid::drawn(numbers_);
        if (!is_free(i, body)) continue;
        bodies_[i] = body;
        grid_->add(i, body.center);
        return true;
      }
    }
    return false;
  }

  /// Moves and lets grow until every cell has its size; else a cell that has not.
  std::optional<std::size_t> grow(const PackingWatch& watch) {
    int sweeps = 0;
    double last = grown();
    while (smallest() < 1) {
      sweep();
      if (watch) watch(grown() / wanted());
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
      Body& body = bodies_[i];
      if (body.scale < 1) {
        Body larger = body;
        larger.scale = std::min(1.0, body.scale * (1 + fastest_growth * numbers_.below_one()));
        if (is_free(i, larger)) body.scale = larger.scale;
      }
    }
    // About two of five moves ought to succeed.
    stride_ = std::clamp(5 * moved > 2 * tried ? 1.05 * stride_ : stride_ / 1.05, 1e-4 * largest_, 2 * largest_);
  }

  bool move(std::size_t i) {
    const Territory<D>& own = territories_[owner_[i]];
    Body body = bodies_[i];
    for (int k = 0; k < D; ++k) body.center[k] = own.axes[k].wrapped(body.center[k] + numbers_.either_side(stride_));
    const double most = std::min(0.5, stride_ / largest_ / (2 * std::numbers::pi));
    body.orientation = Solid::turned(body.orientation, most, numbers_);
    if (!is_free(i, body)) return false;
    grid_->remove(i, bodies_[i].center);
    bodies_[i] = body;
    grid_->add(i, body.center);
    return true;
  }

  [[nodiscard]] bool is_free(std::size_t i, const Body& body) const {
    const Territory<D>& own = territories_[owner_[i]];
    if (!within(body, own)) return false;
    if (!images_keep_apart(body, body, true, own.gap)) return false;
    return grid_->all_near(body.center, [&](std::size_t j) {
      if (j == i) return true;
      double gap = own.gap;
      if (owner_[j] != obstacle) gap = std::max(gap, territories_[owner_[j]].gap);
      return images_keep_apart(body, bodies_[j], false, gap);
    });
  }

  [[nodiscard]] bool images_keep_apart(const Body& a, const Body& b, bool itself, double gap) const {
    const double reach = a.radius() + b.radius() + gap;
    std::array<int, D> first{}, last{};
    for (int k = 0; k < D; ++k) {
      if (!box_[k].periodic) continue;
      const double distance = b.center[k] - a.center[k];
      first[k] = static_cast<int>(std::ceil((-reach - distance) / box_[k].length()));
      last[k] = static_cast<int>(std::floor((reach - distance) / box_[k].length()));
      if (first[k] > last[k]) return true;
    }
    for (std::array<int, D> image = first;;) {
      Place<D> shift;
      for (int k = 0; k < D; ++k) shift[k] = image[k] * box_[k].length();
      if (!(itself && image == std::array<int, D>{}) && !keep_apart(a, b, shift, gap)) return false;
      int k = 0;
      while (k < D && image[k] == last[k]) {
        image[k] = first[k];
        ++k;
      }
      if (k == D) return true;
      ++image[k];
    }
  }

  [[nodiscard]] bool within(const Body& body, const Territory<D>& own) const {
    const double radius = body.radius();
    bool surely = true;
    for (int k = 0; k < D; ++k) {
      const Axis& axis = own.axes[k];
      surely =
          surely && (axis.periodic || (body.center[k] - radius >= axis.lower && body.center[k] + radius <= axis.upper));
    }
    const auto place_of = [&](const auto& node) {
      Place<D> place = rotated(body.orientation, node);
      for (int k = 0; k < D; ++k) place[k] = body.center[k] + body.scale * place[k];
      return place;
    };
    const auto in_box = [&](const auto& node) {
      const Place<D> place = place_of(node);
      for (int k = 0; k < D; ++k) {
        if (!own.axes[k].periodic && !(place[k] >= own.axes[k].lower && place[k] <= own.axes[k].upper)) return false;
      }
      return true;
    };
    if (!surely && !std::all_of(body.solid->nodes().begin(), body.solid->nodes().end(), in_box)) return false;
    if (!region_ || from_walls(body.center) >= radius + own.from_walls) return true;
    return body.solid->all_samples([&](const auto& sample, double reach) {
      return from_walls(place_of(sample)) >= own.from_walls + body.scale * reach;
    }) && std::none_of(pieces_.begin(), pieces_.end(), [&](Place<D> piece) {
             for (int k = 0; k < D; ++k) {
               piece[k] -= body.center[k];
               if (box_[k].periodic) piece[k] -= box_[k].length() * std::round(piece[k] / box_[k].length());
             }
             return encloses(body, piece);
           });
  }

  /// Distance to the walls of a tube or of any shape, or less.
  [[nodiscard]] double from_walls(const Place<D>& place) const {
    return region_->distance(core::Vec<D>(place.data())).value;
  }

  [[nodiscard]] std::size_t smallest_cell() const {
    std::size_t least = bodies_.size();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (owner_[i] != obstacle && (least == bodies_.size() || bodies_[i].scale < bodies_[least].scale)) least = i;
    return least;
  }
  [[nodiscard]] double smallest() const { return bodies_[smallest_cell()].scale; }
  /// What a cell encloses as it is.
  [[nodiscard]] static double grown(const Body& body) {
    double content = body.solid->content();
    for (int k = 0; k < D; ++k) content = body.scale * content;
    return content;
  }
  /// What all cells enclose as they are, and as they shall.
  [[nodiscard]] double grown() const {
    double content = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (owner_[i] != obstacle) content += grown(bodies_[i]);
    return content;
  }
  [[nodiscard]] double wanted() const {
    double content = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (owner_[i] != obstacle) content += bodies_[i].solid->content();
    return content;
  }

  [[nodiscard]] PackingShortfall shortfall(std::size_t cell) const {
    const auto index = static_cast<std::size_t>(owner_[cell]);
    double content = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (owner_[i] == owner_[cell] && bodies_[i].solid != nullptr) content += grown(bodies_[i]);
    return {index, content * std::pow(unit_, D) / region_content(packings_[index], domain_)};
  }

  const scene::Domain& domain_;
  const std::vector<scene::RandomPacking>& packings_;
  std::vector<scene::CellPlacement>& cells_;
  double unit_;  ///< m; all lengths below are multiples of it
  RandomNumbers numbers_;
  std::array<Axis, D> box_;
  std::map<int, Solid> solids_;  ///< by type, of those that have cells
  double allowance_ = 0, largest_ = 0;
  core::RegionPointer<D> region_;          ///< of a tube, or between walls of any shape; null: there are no such walls
  std::vector<Place<D>> pieces_;           ///< a place in each piece of walls of any shape
  std::vector<Territory<D>> territories_;  ///< by packing
  std::optional<CenterGrid<D>> grid_;
  std::vector<int> owner_;  ///< of each cell: its packing, or `obstacle`
  std::vector<Body> bodies_;
  double stride_ = 0.3;  ///< largest move along each axis
};

}  // namespace

double cells_for(double hematocrit, const scene::CellType& type, const scene::RandomPacking& packing,
                 const scene::Domain& domain) {
  return std::round(hematocrit * region_content(packing, domain) / enclosed_by(type));
}

double hematocrit_of(const scene::RandomPacking& packing, const scene::CellType& type, const scene::Domain& domain) {
  return packing.count * enclosed_by(type) / region_content(packing, domain);
}

std::optional<PackingShortfall> pack(const scene::Domain& domain, const std::vector<scene::CellType>& types,
                                     const std::vector<scene::RandomPacking>& packings,
                                     std::vector<scene::CellPlacement>& cells, const PackingWatch& watch) {
  if (packings.empty()) return std::nullopt;
  // Of the types that have cells: one that has none may be so large that rounding would deform the others.
  double unit = 0;
  for (const scene::CellPlacement& cell : cells) unit = std::max(unit, shape_radius(types[cell.type].shape));
  if (domain.dimension() == 3) return Packer<RigidSurface>(domain, types, packings, cells, unit).pack(watch);
  return Packer<RigidOutline>(domain, types, packings, cells, unit).pack(watch);
}

}  // namespace rouleau::shape
