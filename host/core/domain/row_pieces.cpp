#include "row_pieces.hpp"

namespace rouleau::core {

template <int D>
void RowPieces<D>::add_runs(const Row& row) {
  std::vector<Run> near;
  Box<D> beside{};
  beside.end[0] = 1;
  for (int k = 1; k < D; ++k) {
    beside.begin[k] = std::max(row[k - 1] - 1, 0);
    beside.end[k] = std::min(row[k - 1] + 2, block_.size(k));
  }
  for (int j = 0; j < row_count(beside); ++j) {
    int i = 0;
    const Row from_first = row_of(beside, j);
    for (int k = D - 1; k > 0; --k) i = i * block_.size(k) + beside.begin[k] + from_first[k - 1];
    for (std::size_t n = first_piece(i); n < first_piece(i + 1); ++n)
      near.push_back({pieces_[n].begin - 1, pieces_[n].end + 1, 0});
  }
  std::sort(near.begin(), near.end(), [](const Run& a, const Run& b) { return a.begin < b.begin; });
  const std::size_t first = runs_.size();
  for (const Run& run : near)
    if (runs_.size() > first && run.begin <= runs_.back().end)
      runs_.back().end = std::max(runs_.back().end, run.end);
    else
      runs_.push_back(run);
  for (std::size_t n = first; n < runs_.size(); ++n) {
    runs_[n].start = count_ - runs_[n].begin;
    count_ += runs_[n].end - runs_[n].begin;
  }
}

template <int D>
std::size_t RowPieces<D>::number_of(const Row& row) const {
  std::size_t number = 0;
  for (int k = D - 1; k > 0; --k)
    number = number * static_cast<std::size_t>(block_.size(k) + 2) + static_cast<std::size_t>(row[k - 1] + 1);
  return number;
}

template <int D>
auto RowPieces<D>::find(int x, const Row& row) const -> const Run* {
  const std::size_t number = number_of(row);
  for (std::size_t n = first_run_[number]; n < first_run_[number + 1]; ++n)
    if (x < runs_[n].end) return x < runs_[n].begin ? nullptr : &runs_[n];
  return nullptr;
}

template class RowPieces<2>;
template class RowPieces<3>;

}  // namespace rouleau::core
