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
      region_(setup.region),
      most_(static_cast<int>(plan.scene->fed)),
      origin_(0 * plan.scene->domain.size),
      spacing_(scene::lattice_spacing(*plan.scene)) {
  if (feed_ == nullptr) return;
  const core::Section section = core::section_at(domain_, setup.solid.get(), setup.walls, 0);
  const double mean = setup.openings->front().value;
  double sum = 0, nodes = 0;
  for (std::size_t row = 0; row < section.driven.size(); ++row) {
    flux_.push_back(sum += std::max(0.0, section.velocity(row, mean)));
    nodes += section.driven[row] != 0 ? 1 : 0;
  }
  // The mean is that over the nodes, and gives the flow through the true section.
  const double flow = mean * nodes * std::pow(spacing_, D) / plan.stages[stage].units.time;
  cells_per_second_ = feed_->hematocrit * flow / shape::enclosed_by(plan.scene->cell_types[feed_->type]);
}

template <int D>
int Inflow<D>::due(double time) const {
  return std::min(most_, static_cast<int>(std::lround(time * cells_per_second_)));
}

template <int D>
std::vector<core::Cells<D>> Inflow<D>::places(int cell, long step) const {
  const auto of_step = static_cast<std::uint64_t>(step);
  std::seed_seq seeds{feed_->seed, static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(of_step),
                      static_cast<std::uint32_t>(of_step >> 32)};
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
    core::Vec<D> move = way_in(core::box_of<D>(cell_there, 0), numbers);
    for (int k = 0; k < D; ++k) {
      for (double& place : cell_there.position[k]) place += move[k];
    }
    if (fits(cell_there)) found.push_back(std::move(cell_there));
  }
  return found;
}

/// From the origin, where a cell with this box lies half a spacing below it, to where it comes in.
template <int D>
core::Vec<D> Inflow<D>::way_in(const core::BoundingBox<D>& box, shape::RandomNumbers& numbers) const {
  const double room = feed_->length / spacing_ - 0.5 - lowest() - (box.most[0] - box.least[0]);
  const auto drawn = std::upper_bound(flux_.begin(), flux_.end() - 1, numbers.below_one() * flux_.back());
  const auto row = core::row_of(domain_.block, static_cast<int>(drawn - flux_.begin()));
  core::Vec<D> move;
  move[0] = lowest() - box.least[0] + numbers.below_one() * std::max(0.0, room);
  for (int k = 1; k < D; ++k) move[k] = row[k - 1] + numbers.below_one();
  return move;
}

template <int D>
bool Inflow<D>::fits(const core::Cells<D>& cell) const {
  const core::BoundingBox<D> box = core::box_of<D>(cell, 0);
  for (int k = 1; k < D; ++k) {
    if (domain_.periodic[k] && !(box.most[k] - box.least[k] + kept_apart < domain_.period(k))) return false;
  }
  if (!(box.least[0] >= lowest() && box.most[0] < highest())) return false;
  return !(core::wall_gap(cell, cell.cells[0], domain_, region_.get()) < kept_apart);
}

template <int D>
bool Inflow<D>::is_apart(const core::Cells<D>& cell, const core::Cells<D>& others, int other) const {
  const core::BoundingBox<D> box = core::box_of<D>(cell, 0), its = core::box_of<D>(others, other);
  if (core::distance_along_axes(box, its, domain_) > kept_apart) return true;
  core::Vec<D> nearest;  // the image of the other one
  for (int k = 0; k < D; ++k) {
    const double period = domain_.period(k), between = box.least[k] + box.most[k] - its.least[k] - its.most[k];
    nearest[k] = period > 0 ? period * std::round(between / 2 / period) : 0;
  }
  // Along a short period the images on both sides of it are near, too.
  int images = 1;
  for (int k = 1; k < D; ++k) images *= domain_.periodic[k] ? 3 : 1;
  for (int image = 0; image < images; ++image) {
    core::Vec<D> move = nearest;
    for (int k = 1, rest = image; k < D; ++k) {
      if (!domain_.periodic[k]) continue;
      move[k] += (rest % 3 - 1) * domain_.period(k);
      rest /= 3;
    }
    if (!is_apart(cell, others, other, move)) return false;
  }
  return true;
}

template <int D>
bool Inflow<D>::is_apart(const core::Cells<D>& cell, const core::Cells<D>& others, int other,
                         const core::Vec<D>& move) const {
  const auto node = [](const core::Cells<D>& of, int i) {
    core::Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = of.position[k][i];
    return place;
  };
  const core::BoundingBox<D> box = core::box_of<D>(cell, 0);
  const core::CellRange& range = others.cells[other];
  for (int i = range.first; i < range.end(); ++i) {
    const core::Vec<D> place = node(others, i) + move;
    bool near = true;
    for (int k = 0; k < D; ++k)
      near = near && place[k] > box.least[k] - kept_apart && place[k] < box.most[k] + kept_apart;
    for (int j = 0; near && j < cell.node_count(); ++j) {
      if ((node(cell, j) - place).squaredNorm() < kept_apart * kept_apart) return false;
    }
  }
  return !plan::encloses(cell, 0, node(others, range.first) + move) &&
         !plan::encloses(others, other, node(cell, 0) - move);
}

template class Inflow<2>;
template class Inflow<3>;

}  // namespace rouleau::run
