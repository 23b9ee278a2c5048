// What a word was meant to be: common words for what goes by another name here, or the nearest name (text.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rouleau {

struct Synonym {
  std::string_view word, ours;  ///< in lower case, and as we call it
};

/// All that are known; a word may have several meanings, the likelier first.
const std::vector<Synonym>& synonyms();

/// The candidate that is ours for a word, whatever its case; empty where there is none.
std::string synonym(std::string_view word, const std::vector<std::string>& candidates);

/// The candidate that a word was most likely meant to be: ours for it, or else the nearest in spelling; empty where
/// there is none.
std::string likely(std::string_view word, const std::vector<std::string>& candidates);

/// `; did you mean "tau"?`, or nothing when no candidate is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace rouleau
