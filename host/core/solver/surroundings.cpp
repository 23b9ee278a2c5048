#include "surroundings.hpp"

#include <algorithm>
#include <map>

namespace rouleau::core {

template <int D>
Surroundings<D>::Surroundings(Cells& cells, const CellExchange<D>& exchange)
    : cells_(cells), seen_(&cells), exchange_(&exchange), boxes_(exchange.boxes_of_all(cells)) {}

template <int D>
Surroundings<D>::~Surroundings() {
  if (exchange_ == nullptr) return;
  exchange_->ghosts().set_parts(*seen_);
  std::vector<Range> nodes;
  for (const int c : shown_) nodes.push_back({cells_.cells[c].first, cells_.cells[c].end()});
  seen_->forget_places(nodes);
}

template <int D>
bool Surroundings<D>::show(double reach, const std::vector<char>& open) {
  const Ranks<D> ranks = this->ranks();
  const auto is_set = [](char of_cell) { return of_cell != 0; };
  if (open.empty() ? cells_.cell_count() == 0 : !any(ranks, std::any_of(open.begin(), open.end(), is_set)))
    return false;
  if (exchange_ == nullptr) return true;
  const GhostCells<D>& ghosts = exchange_->ghosts();
  std::vector<char> is_open = open;  // of all cells
  if (!open.empty()) {
    std::vector<int> mine;
    for (int c = 0; c < cells_.cell_count(); ++c)
      if (ghosts.owns(c) && open[c] != 0) mine.push_back(c);
    for (const std::vector<int>& of_rank : all_of(ranks, std::move(mine)))
      for (const int c : of_rank) is_open[c] = 1;
  }
  // Both owners of a pair come to the same answer. Whoever looks rounds in another way.
  const double room = reach * (1 + 1e-9) + 1e-6;
  const Domain<D> domain = ranks.blocks->domain(0);
  const CellGrid<D> grid(boxes_, room, domain);
  const auto opens = [&](int c) { return is_open.empty() || is_open[c] != 0; };
  std::map<int, typename CellExchange<D>::Sight> sights;
  std::vector<int> around;
  for (int c = 0; c < cells_.cell_count(); ++c) {
    if (!ghosts.owns(c)) continue;
    grid.find(c, around);
    for (const int other : around) {
      if (ghosts.owns(other)) continue;
      if (distance_along_axes(boxes_[std::min(c, other)], boxes_[std::max(c, other)], domain) > room) continue;
      auto& sight = sights[ghosts.owner(other)];
      if (opens(other)) sight.mine.push_back(c);
      if (opens(c)) sight.theirs.push_back(other);
    }
  }
  for (auto& [rank, sight] : sights) {
    for (std::vector<int>* list : {&sight.mine, &sight.theirs}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    for (const int c : sight.theirs) {
      if (cells_.knows(c)) continue;
      shown_.push_back(c);
      seen_->part[c].known = true;
    }
  }
  std::sort(shown_.begin(), shown_.end());
  seen_->known.clear();
  for (int c = 0; c < cells_.cell_count(); ++c)
    if (cells_.knows(c)) seen_->known.push_back(c);
  exchange_->show_places(*seen_, sights);
  return true;
}

template class Surroundings<2>;
template class Surroundings<3>;

}  // namespace rouleau::core
