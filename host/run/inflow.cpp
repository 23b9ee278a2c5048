#include "inflow.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/contact/wall_gap.hpp"
#include "core/fluid/openings/section.hpp"
#include "plan/placed_cells.hpp"
#include "shape/extent.hpp"

namespace rouleau::run {
namespace {

constexpr double kept_apart = 2;  // spacings, from other cells and from walls
constexpr int places_at_once = 32;

}  // namespace

template <int D>
Inflow<D>::Inflow(const plan::Plan& plan, int stage, const core::BasicSolverSetup<D>& setup)
    : feed_(plan.scene->domain.feed()),
      none_(plan::without_cells<D>(*plan.scene, scene::lattice_spacing(*plan.scene))),
      domain_(scene::lattice_domain<D>(*plan.scene)),
      axis_(domain_.open_axis),
      region_(setup.region),
      most_(static_cast<int>(plan.scene->fed)),
      origin_(0 * plan.scene->domain.size),
      spacing_(scene::lattice_spacing(*plan.scene)) {
  if (feed_ == nullptr) return;
  const core::Section section = core::section_at(domain_, setup.solid.get(), setup.walls, 0);
  const core::Opening& inlet = setup.openings->front();
  const bool by_velocity = inlet.kind == core::Opening::Kind::velocity;
  const double mean = by_velocity ? inlet.value : section.mean_driven + section.mean_dragged;
  double sum = 0, nodes = 0;
  for (std::size_t node = 0; node < section.driven.size(); ++node) {
    flux_.push_back(sum += std::max(0.0, section.velocity(node, mean)));
    nodes += section.driven[node] != 0 ? 1 : 0;
  }
  cells_per_content_ = feed_->hematocrit / shape::enclosed_by(plan.scene->cell_types[feed_->type]);
  // The mean is that over the nodes, and gives the flow through the true section.
  const double flow = mean * nodes * std::pow(spacing_, D) / plan.stages[stage].units.time;
  if (by_velocity) cells_per_second_ = cells_per_content_ * flow;
}

template <int D>
double Inflow<D>::expected(double time, double come_in) const {
  return measures() ? come_in * cells_per_content_ : time * cells_per_second_;
}

template <int D>
int Inflow<D>::due(double time, double come_in) const {
  return static_cast<int>(std::lround(std::clamp(expected(time, come_in), 0.0, static_cast<double>(most_))));
}

template <int D>
std::vector<core::Cells<D>> Inflow<D>::places(int cell, double time, double come_in) const {
  constexpr double draws = 32;  // while one cell comes in
  const double waited = std::max(0.0, expected(time, come_in) - (cell + 0.5));
  std::seed_seq seeds{feed_->seed, static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(waited * draws)};
  shape::RandomNumbers numbers(seeds);
  std::vector<core::Cells<D>> found;
  for (int i = 0; i < places_at_once; ++i) {
    scene::CellPlacement placement{feed_->type, origin_, shape::radians(numbers.angle()), feed_->pointer};
    if constexpr (D == 3) {
      const double along = numbers.either_side(1), around = shape::radians(numbers.angle());
      const double across = std::sqrt(1 - along * along);
      placement.axis = Eigen::Vector3d(across * std::cos(around), along, across * std::sin(around));
    }
    core::Cells<D> cell_there = none_;
    plan::add_placed(cell_there, placement, spacing_);
    move(cell_there, way_in(core::box_of<D>(cell_there, 0), numbers));
    if (fits(cell_there)) found.push_back(std::move(cell_there));
  }
  return found;
}

/// From the origin, where a cell with this box lies half a spacing below it, to where it comes in.
template <int D>
core::Vec<D> Inflow<D>::way_in(const core::BoundingBox<D>& box, shape::RandomNumbers& numbers) const {
  const double room = feed_->length / spacing_ - 0.5 - lowest() - (box.most[axis_] - box.least[axis_]);
  core::Vec<D> by;
  by[axis_] = lowest() - box.least[axis_] + numbers.below_one() * std::max(0.0, room);
  // Along one axis after another, the last first: nodes [first, first + count) lie at what has been drawn so far.
  std::size_t first = 0, count = flux_.size();
  for (int k = D - 1; k >= 0; --k) {
    if (k == axis_) continue;
    const std::size_t nodes = count / static_cast<std::size_t>(domain_.size[k]);  // at each place along it
    const auto up_to = [&](std::size_t place) {
      const std::size_t end = first + place * nodes;
      return end == 0 ? 0 : flux_[end - 1];
    };
    const double wanted = up_to(0) + numbers.below_one() * (up_to(count / nodes) - up_to(0));
    std::size_t place = 0;
    while (place + 1 < count / nodes && !(wanted < up_to(place + 1))) ++place;
    const double within = up_to(place + 1) - up_to(place);
    by[k] = static_cast<double>(place) + (within > 0 ? (wanted - up_to(place)) / within : 0);
    first += place * nodes, count = nodes;
  }
  return by;
}

template <int D>
void Inflow<D>::move(core::Cells<D>& cell, const core::Vec<D>& by) {
  for (int k = 0; k < D; ++k)
    for (double& place : cell.position[k]) place += by[k];
}

template <int D>
double Inflow<D>::draw_back(core::Cells<D>& cell) const {
  const core::BoundingBox<D> box = core::box_of<D>(cell, 0);
  core::Vec<D> back = core::Vec<D>::Zero();
  back[axis_] = lowest() - box.least[axis_];
  move(cell, back);
  return std::max(0.0, feed_->length / spacing_ - 0.5 - (box.most[axis_] + back[axis_]));
}

template <int D>
bool Inflow<D>::fits(const core::Cells<D>& cell) const {
  const core::BoundingBox<D> box = core::box_of<D>(cell, 0);
  for (int k = 0; k < D; ++k)
    if (domain_.periodic[k] && !(box.most[k] - box.least[k] + kept_apart < domain_.period(k))) return false;
  if (!(box.least[axis_] >= lowest() && box.most[axis_] < highest())) return false;
  return !(core::wall_gap(cell, cell.cells[0], domain_, region_.get()) < kept_apart);
}

template <int D>
double Inflow<D>::way(const core::Cells<D>& cell, const core::Cells<D>& others, int other, double most) const {
  core::BoundingBox<D> box = core::box_of<D>(cell, 0), its = core::box_of<D>(others, other);
  box.most[axis_] += most;
  if (core::distance_along_axes(box, its, domain_) > kept_apart) return most;
  core::Vec<D> nearest;  // the image of the other one
  for (int k = 0; k < D; ++k) {
    const double period = domain_.period(k), between = box.least[k] + box.most[k] - its.least[k] - its.most[k];
    nearest[k] = period > 0 ? period * std::round(between / 2 / period) : 0;
  }
  // Along a short period the images on both sides of it are near, too.
  int images = 1;
  for (int k = 0; k < D; ++k) images *= domain_.periodic[k] ? 3 : 1;
  for (int image = 0; image < images && most >= 0; ++image) {
    core::Vec<D> move = nearest;
    for (int k = 0, rest = image; k < D; ++k) {
      if (!domain_.periodic[k]) continue;
      move[k] += (rest % 3 - 1) * domain_.period(k);
      rest /= 3;
    }
    most = way_beside(cell, others, other, move, most);
  }
  return most;
}

template <int D>
double Inflow<D>::way_beside(const core::Cells<D>& cell, const core::Cells<D>& others, int other,
                             const core::Vec<D>& move, double most) const {
  const auto node = [](const core::Cells<D>& of, int i) {
    core::Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = of.position[k][i];
    return place;
  };
  core::BoundingBox<D> box = core::box_of<D>(cell, 0);
  box.most[axis_] += most;
  const core::CellRange& range = others.cells[other];
  for (int i = range.first; i < range.end(); ++i) {
    const core::Vec<D> place = node(others, i) + move;
    bool near = true;
    for (int k = 0; k < D; ++k)
      near = near && place[k] > box.least[k] - kept_apart && place[k] < box.most[k] + kept_apart;
    for (int j = 0; near && j < cell.node_count(); ++j) {
      core::Vec<D> apart = place - node(cell, j);
      const double ahead = apart[axis_];
      apart[axis_] = 0;
      const double beside = kept_apart * kept_apart - apart.squaredNorm();
      if (ahead * ahead < beside) return -1;
      if (beside > 0 && ahead > 0) most = std::min(most, ahead - std::sqrt(beside));
    }
  }
  const bool apart = !plan::encloses(cell, 0, node(others, range.first) + move) &&
                     !plan::encloses(others, other, node(cell, 0) - move);
  return apart ? most : -1;
}

template class Inflow<2>;
template class Inflow<3>;

}  // namespace rouleau::run
