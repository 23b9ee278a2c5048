#include "node_mask.hpp"

namespace rouleau::core {

NodeMask::NodeMask(const Domain<1>& along_x, int rows)
    : along_x_(along_x),
      nx_(along_x.block.size(0)),
      ny_(rows),
      first_(along_x.block.begin[0] % nodes_per_bit),
      words_(bit_of(nx_ - 1) / bits_per_word + 1),
      bits_(static_cast<std::size_t>(words_) * ny_, 0),
      spans_(static_cast<std::size_t>(ny_), {MaskSpan{0, nx_, false}}) {}

bool NodeMask::add_marks(int y, int begin, int end) {
  if (y < 0 || y >= ny_ || begin >= end) return false;
  std::uint64_t* row = bits_.data() + static_cast<std::size_t>(words_) * y;
  const int size = along_x_.size[0];
  if (!along_x_.periodic[0]) begin = std::clamp(begin, 0, size), end = std::clamp(end, begin, size);
  const int first = end - begin < size ? along_x_.wrapped(0, begin) : 0, last = first + std::min(end - begin, size);
  if (first < last) mark_nodes(row, first, std::min(last, size));
  if (last > size) mark_nodes(row, 0, last - size);
  return true;
}

void NodeMask::mark_nodes(std::uint64_t* row, int begin, int end) {
  const int before = (along_x_.block.begin[0] - first_) / nodes_per_bit;  // bits of the lattice before those kept here
  const int first = std::max(begin / nodes_per_bit - before, 0);
  const int last = std::min((end - 1) / nodes_per_bit - before, bit_of(nx_ - 1));
  for (int bit = first; bit <= last; ++bit) row[bit / bits_per_word] |= std::uint64_t{1} << (bit % bits_per_word);
}

void NodeMask::list_spans(int y) {
  const std::uint64_t* row = bits_.data() + static_cast<std::size_t>(words_) * y;
  std::vector<MaskSpan>& spans = spans_[y];
  spans.clear();
  for (int x = 0; x < nx_;) {
    const int bit = bit_of(x);
    const bool on = (row[bit / bits_per_word] >> (bit % bits_per_word) & 1) != 0;
    const int end = std::min(nx_, next_change(row, bit, on) * nodes_per_bit - first_);
    spans.push_back({x, end, on});
    x = end;
  }
  if (!fluid_.empty()) leave_solid_out(y);
}

void NodeMask::leave_solid_out(int y) {
  std::vector<MaskSpan>& spans = spans_[y];
  const std::vector<MaskSpan> all = spans;
  spans.clear();
  for (const Run& run : fluid_[y]) {
    for (const MaskSpan& span : all) {
      const int begin = std::max(run.begin, span.begin), end = std::min(run.end, span.end);
      if (begin < end) spans.push_back({begin, end, span.active});
    }
  }
  if (spans.empty()) spans.push_back({0, 0, false});
}

}  // namespace rouleau::core
