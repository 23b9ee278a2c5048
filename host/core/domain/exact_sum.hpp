// Sums that come out the same in whatever order, and from however many parts, they are formed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rouleau::core {

/// Each term is rounded to a multiple of 2^-80; the multiples are added as integers of 128 bits. So blocks, ranks and
/// threads may each sum what they have. Terms below 2^46 in size; with any other the sum is not a number.
class ExactSum {
 public:
  void add(double term) {
    const double high = high_part(term);
    const double low = low_part(term - high);
    if (std::abs(term) < small) {
      units_ += in_units(high, low);
    } else if (std::abs(term) < 0x1p46) {
      units_ += static_cast<Integer>(term * 0x1p41) << 39;  // such a number is a multiple of 2^-41
    } else {
      valid_ = false;
    }
  }
  void add(const ExactSum& other) {
    units_ += other.units_;
    valid_ = valid_ && other.valid_;
  }
  /// All of `count` terms, as add() would one by one.
  void add(const double* terms, std::size_t count);

  /// The sum, rounded once.
  [[nodiscard]] double value() const { return valid_ ? static_cast<double>(units_) * 0x1p-80 : std::nan(""); }

  /// What a term is split into: a multiple of 2^-40, and what is left of it as a multiple of 2^-80, for terms below
  /// `small`. Up to small / size of such parts have an exact sum as doubles.
  static constexpr double small = 0x1p11;
  template <class S>
  [[gnu::always_inline]] static S high_part(const S& term) {
    return (term + 0x1.8p12) - 0x1.8p12;
  }
  template <class S>
  [[gnu::always_inline]] static S low_part(const S& rest) {
    return (rest + 0x1.8p-28) - 0x1.8p-28;
  }
  /// Adds exact sums of parts.
  void add_parts(double high, double low) {
    if (std::abs(high) < small && std::abs(low) < small) {
      units_ += in_units(high, low);
    } else {
      valid_ = false;
    }
  }

 private:
  __extension__ using Integer = __int128;
  static Integer in_units(double high, double low) {
    return static_cast<Integer>(static_cast<std::int64_t>(high * 0x1p40)) * (std::int64_t{1} << 40) +
           static_cast<std::int64_t>(low * 0x1p80);
  }
  Integer units_ = 0;
  bool valid_ = true;
};

inline void ExactSum::add(const double* terms, std::size_t count) {
  constexpr int lanes = 8;
  using Lanes __attribute__((vector_size(lanes * sizeof(double)))) = double;
  constexpr std::size_t stretch = 1024;  // of which, with terms below 1, every partial sum is exact
  std::size_t i = 0;
  while (count - i >= lanes) {
    const std::size_t end = i + std::min(stretch, (count - i) / lanes * lanes);
    Lanes high{}, low{};
    bool below_one = true;
    for (std::size_t k = i; k < end; k += lanes) {
      Lanes term;
      __builtin_memcpy(&term, terms + k, sizeof term);
      const Lanes part = high_part(term);
      high += part;
      low += low_part(Lanes(term - part));
      for (int l = 0; l < lanes; ++l) below_one &= std::abs(term[l]) < 1;
    }
    if (below_one) {
      for (int l = 0; l < lanes; ++l) add_parts(high[l], low[l]);
    } else {
      for (std::size_t k = i; k < end; ++k) add(terms[k]);
    }
    i = end;
  }
  for (; i < count; ++i) add(terms[i]);
}

}  // namespace rouleau::core
