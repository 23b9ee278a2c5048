#include "aggregate_words.hpp"

#include <algorithm>
#include <functional>

namespace rouleau::observe {

std::string aggregates_in_words(std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  const auto single = std::find_if(sizes.begin(), sizes.end(), [](std::size_t size) { return size < 2; });
  const auto rouleaux = static_cast<std::size_t>(single - sizes.begin()), singles = sizes.size() - rouleaux;
  std::string alone = std::to_string(singles) + (singles == 1 ? " single cell" : " single cells");
  if (rouleaux == 0) return alone;
  const auto size = [&](std::size_t rouleau) { return std::to_string(sizes[rouleau]); };
  std::string words = rouleaux == 1 ? "a rouleau of " + size(0) : "rouleaux of " + size(0);
  if (rouleaux > 4) {
    words = std::to_string(rouleaux) + " rouleaux of " + size(rouleaux - 1) + " to " + size(0);
  } else {
    for (std::size_t i = 1; i < rouleaux; ++i) words += (i + 1 == rouleaux ? " and " : ", ") + size(i);
  }
  words += " cells";
  return singles > 0 ? words + " and " + alone : words;
}

}  // namespace rouleau::observe
