// Sums that come out the same in whatever order, and from however many parts, they are formed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rouleau::core {

/// Each term is rounded to a multiple of 2^-120; the multiples are added as integers, those of 2^-80 and what is left
/// apart. So blocks, ranks and threads may each sum what they have. Terms below 2^46 in size; with any other the sum is
/// not a number.
class ExactSum {
 public:
  void add(double term) {
    if (std::abs(term) < small) {
      const double high = high_part(term), low = low_part(term - high);
      add_parts(high, low, least_part((term - high) - low));
    } else if (std::abs(term) < 0x1p46) {
      units_ += static_cast<Integer>(term * 0x1p41) << 39;  // such a number is a multiple of 2^-41
    } else {
      valid_ = false;
    }
  }
  void add(const ExactSum& other) {
    units_ += other.units_;
    least_ += other.least_;
    valid_ = valid_ && other.valid_;
  }
  /// All of `count` terms, as add() would one by one.
  /// Inlined, for a caller's width of vector registers.
  [[gnu::always_inline]] void add(const double* terms, std::size_t count);

  [[nodiscard]] double value() const {
    return valid_ ? static_cast<double>(units_) * 0x1p-80 + static_cast<double>(least_) * 0x1p-120 : std::nan("");
  }

  /// What a term is split into: a multiple of 2^-40, of what is left a multiple of 2^-80, and of the rest one of
  /// 2^-120, for terms below `small`. Up to small / size of such parts have an exact sum as doubles.
  static constexpr double small = 0x1p11;
  template <class S>
  [[gnu::always_inline]] static S high_part(const S& term) {
    return (term + 0x1.8p12) - 0x1.8p12;
  }
  template <class S>
  [[gnu::always_inline]] static S low_part(const S& rest) {
    return (rest + 0x1.8p-28) - 0x1.8p-28;
  }
  template <class S>
  [[gnu::always_inline]] static S least_part(const S& rest) {
    return (rest + 0x1.8p-68) - 0x1.8p-68;
  }
  /// Adds exact sums of parts.
  void add_parts(double high, double low, double least = 0) {
    if (std::abs(high) < small && std::abs(low) < small) {
      units_ += in_units(high, low);
      least_ += static_cast<std::int64_t>(least * 0x1p120);
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
  Integer units_ = 0, least_ = 0;  // of 2^-80, of 2^-120
  bool valid_ = true;
};

inline void ExactSum::add(const double* terms, std::size_t count) {
  constexpr int lanes = 8;
  using Lanes __attribute__((vector_size(lanes * sizeof(double)))) = double;
  constexpr std::size_t stretch = 1024;  // of which, with terms below 1, every partial sum is exact
  std::size_t i = 0;
  while (count - i >= lanes) {
    const std::size_t end = i + std::min(stretch, (count - i) / lanes * lanes);
    Lanes high{}, low{}, least{};
    Lanes largest{};
    for (std::size_t k = i; k < end; k += lanes) {
      Lanes term;
      __builtin_memcpy(&term, terms + k, sizeof term);
      const Lanes high_of = high_part(term), rest = term - high_of, low_of = low_part(rest);
      high += high_of;
      low += low_of;
      least += least_part(Lanes(rest - low_of));
      const Lanes size = term < 0 ? -term : term;
      largest = size > largest ? size : largest;
    }
    bool below_one = true;
    for (int l = 0; l < lanes; ++l) below_one = below_one && largest[l] < 1;
    if (below_one) {
      for (int l = 0; l < lanes; ++l) add_parts(high[l], low[l], least[l]);
    } else {
      for (std::size_t k = i; k < end; ++k) add(terms[k]);
    }
    i = end;
  }
  for (; i < count; ++i) add(terms[i]);
}

}  // namespace rouleau::core
